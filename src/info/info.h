// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "compile/forward.h"
#include "compile/sphere_store.h"
#include "job/forward.h"
#include "job/resources.h"
#include "load/load_images.h"
#include "load/load_scene.h"
#include "load/read_scene.h"

namespace orrery::info {

/// A renderer feature, and whether the scene requires it.
struct Feature {
  std::string name;  ///< "thin lens"
  bool required;
  std::string note;  ///< what requires it, or what is skipped without it
};

/// A points file of a scene.
struct PointsInfo {
  std::string file;  ///< file name as in the scene, with the frame number
  std::uint64_t spheres = 0;
  std::vector<std::string> unused;  ///< vertex properties that are not used
  std::uint64_t bonds = 0;          ///< rods of bonds
};

/// A texture of a scene.
struct TextureInfo {
  std::string key;            ///< "material.earth.albedo"
  std::string type;           ///< "checker"
  std::string file;           ///< image file as in the scene, with the frame number
  int width = 0, height = 0;  ///< size of an image, texels
  std::string color_space;    ///< colour space of an image; empty: data
};

/// Properties of a scene that are known before rendering.
struct SceneInfo {
  std::string scene_hash;
  int frame = 1;
  int width = 0, height = 0, samples = 0, max_depth = 0;
  std::uint64_t spheres = 0;
  std::uint64_t rods = 0;
  compile::Bounds bounds;  ///< scene units; valid if there are spheres or rods
  double smallest_radius = 0, largest_radius = 0;
  std::vector<std::pair<std::string, std::uint64_t>> materials;  ///< number of compiled materials by type
  std::uint64_t emitters = 0;                                    ///< spheres and rods that emit; black ones do not
  std::string lights;                                            ///< emitters, background and how they are sampled
  std::string caustics;                                          ///< pairs of balls and lights, and which are sampled
  std::vector<PointsInfo> points;
  std::vector<std::string> layers, available_layers;  ///< layers requested in [output], and all that the scene supports
  std::vector<Feature> features;
  std::string precision, accelerator, isa;
  std::string traversal;  ///< see accel::Accel::traversal_name()
  job::MemoryEstimate memory;
  std::optional<load::LoadedMap> background;  ///< set for an image background
  std::string background_file;
  std::vector<TextureInfo> textures;
  std::vector<load::Setting> settings;
  std::vector<base::Diagnostic> warnings;
};

/// Loads a scene and determines its properties without rendering.
///
/// Errors     those of load::load_scene
SceneInfo scene_info(const load::SceneRequest& request);

/// The same; takes what has not changed from `prepared`, which then holds this scene.
SceneInfo scene_info(const load::SceneRequest& request, job::PreparedScene& prepared);

/// Returns warnings about visible errors of the chosen precision, estimated from the scene's ratios of distance to
/// radius.
///
/// Result     one sentence per error with its size; empty for precision exact
/// Precision  orders of magnitude, from the error terms of docs/numerics.md
std::vector<std::string> precision_advice(const compile::CompiledScene& compiled);

/// The properties as text.
std::string info_text(const SceneInfo& info);
/// The properties as JSON, schema "orrery.info/1"; bounds and radius are null without spheres and rods.
std::string info_json(const SceneInfo& info);
/// Key, value and origin of every setting, in columns.
std::string settings_text(const SceneInfo& info);

}  // namespace orrery::info
