// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/finding.h"
#include "display/develop.h"
#include "film/picture.h"
#include "image/write.h"
#include "render/render.h"

namespace orrery::app {

/// What `orrery render` was asked for.
struct Job {
  std::filesystem::path scene;
  std::vector<std::string> overrides;          ///< "camera.vfov=30"
  std::vector<std::filesystem::path> outputs;  ///< the extension chooses the format
  display::Settings display;                   ///< for display formats; the working space is the scene's
  int bits = 0;                                ///< of display formats; 0: 8
  image::ExrOptions exr;
  bool reproducible = false;         ///< leave out of headers what changes between runs
  std::filesystem::path deep;        ///< EXR of samples in depth; empty: none
  std::filesystem::path statistics;  ///< empty: none
  int threads = 0;                   ///< 0: default_threads()
  std::uint64_t memory_limit = 0;    ///< bytes; 0: what is free
  std::string traversal = "auto";    ///< auto, packet or single; how rays go through the hierarchy, for comparison
  double noise = 0;                  ///< that the picture shall have, as film/display_error.h measures it; 0: not asked
  double seconds = 0;                ///< for all but writing the files; 0: as long as it takes
  std::string isa;                   ///< "avx2": no better instruction set; empty: the processor's best
  std::function<void(const render::Progress&)> on_progress;
  std::function<void(double fraction)> on_build;  ///< what is done of building the hierarchy; from any thread
  std::function<void(const base::Finding&)> on_warning;
  const std::atomic<bool>* cancel = nullptr;
};

/// Seconds by phase.
struct Phases {
  double read_s = 0, compile_s = 0, build_s = 0, render_s = 0, write_s = 0;
};

/// What came of it.
struct JobReport {
  render::Statistics render;
  Phases phases;
  film::BadValues bad_values;                                       ///< of the picture, before any display transform
  std::vector<std::pair<std::string, film::BadValues>> bad_layers;  ///< the same of each layer that has any
  image::WriteReport written;                                       ///< changed so that it fits into the files
  int width = 0, height = 0;
  std::string target_missed;  ///< "noise 0.013 instead of 0.01: time was over"; empty: as was asked
  std::size_t spheres = 0;
  std::string scene_hash;
  display::Choice display;  ///< where a display format was written
};

/// Renders a scene into files: read, check, compile, render, develop, write.
///
/// That the files can be written, and that formats, compression, display and view exist, is known before rendering
/// starts. A statistics file is written also where it was stopped or failed later.
///
/// Errors     base::Error of every kind; kStopped where `cancel` stopped it, and then no picture was written
JobReport run_job(const Job& job);

}  // namespace orrery::app
