// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "job/load_scene.h"
#include "job/memory.h"
#include "base/diagnostic.h"

namespace orrery::app {

/// One thing that a scene may ask of the renderer.
struct Feature {
  std::string name;  ///< "thin lens"
  bool required;
  std::string note;                  ///< what requires it, or what is not computed without it
  std::optional<double> saves = {};  ///< of the time, by leaving it out; where it was measured
};

/// A data file of a scene.
struct PointsInfo {
  std::string file;  ///< as the scene names it, with the frame's number
  std::uint64_t spheres = 0;
  std::vector<std::string> unused;  ///< properties of its vertices that nothing uses
};

/// What a scene is, before it is rendered.
struct SceneInfo {
  std::string scene_hash;
  int frame = format::kFirstFrame;
  int width = 0, height = 0, samples = 0, max_depth = 0;
  std::uint64_t spheres = 0;
  double lower[3] = {0, 0, 0}, upper[3] = {0, 0, 0};  ///< bounds, scene units; mean something where spheres > 0
  double smallest_radius = 0, largest_radius = 0;
  std::vector<std::pair<std::string, std::uint64_t>> materials;  ///< compiled materials by type
  std::vector<PointsInfo> points;
  std::vector<std::string> layers, available_layers;  ///< requested in [output], and all that the scene can have
  std::vector<Feature> features;
  std::string precision, accelerator, isa;
  std::string traversal;  ///< how rays will go through the hierarchy, as far as that is known before a render
  job::MemoryEstimate memory;
  struct Setting {
    std::string key, value, origin;
  };
  std::vector<Setting> settings;
  std::vector<base::Diagnostic> warnings;
};

/// Loads a scene and finds out what it requires; renders nothing.
///
/// Errors     as load_scene
SceneInfo scene_info(const job::SceneRequest& request);

/// Measures what is saved by leaving out what this scene does not ask for, as far as the kernel has it as a feature.
///
/// Errors     as bench_features
void measure_savings(const job::SceneRequest& request, SceneInfo& info);

/// The same as text for people.
std::string info_text(const SceneInfo& info);
/// As JSON, "orrery.info/1"; without spheres, bounds and radius are null.
std::string info_json(const SceneInfo& info);
/// Key, value and origin of each setting, in columns.
std::string settings_text(const SceneInfo& info);

}  // namespace orrery::app
