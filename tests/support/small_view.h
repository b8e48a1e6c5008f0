// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/error.h"
#include "view/viewer.h"

/// A view of one sphere.
namespace orrery::view {

inline constexpr const char* kScene = R"(
[image]
width = 64
height = 48
[render]
samples = 4
[camera]
look_from = [0, 0, 3]
look_at = [0, 0, 0]
[material.grey]
type = "lambertian"
albedo = [0.5, 0.5, 0.5]
[[sphere]]
center = [0, 0, 0]
radius = 1
material = "grey"
)";

/// The words are --set KEY=VALUE and --samples N.
inline Subject subject_of(const std::vector<std::string>& words) {
  Subject out;
  out.job.scene.file = "scene.toml";
  out.job.scene.text = std::make_shared<const std::string>(kScene);
  out.job.scene.has_file = false;
  for (std::size_t i = 0; i + 1 < words.size(); i += 2) {
    if (words[i] == "--set")
      out.job.scene.overrides.add(words[i + 1]);
    else if (words[i] == "--samples")
      out.job.scene.overrides.add_option("--samples", "render.samples", words[i + 1]);
    else
      base::refuse("unknown option " + words[i]);
  }
  return out;
}

/// Waits for the finished image of the last wish, which differs from that of number `after`.
inline Frame finished(Viewer& viewer, std::uint64_t after = 0) {
  for (;;) {
    Frame frame = viewer.frame(after, std::chrono::minutes(1));
    if (frame.number <= after) throw std::runtime_error("no image within a minute; " + viewer.state().problem);
    if (frame.is_finished) return frame;
    after = frame.number;
  }
}

}  // namespace orrery::view
