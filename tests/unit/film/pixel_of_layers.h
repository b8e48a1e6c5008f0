// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "film/layer_planes.h"
#include "film/layers.h"
#include "film/sums.h"
#include "kernel/material.h"
#include "kernel/path_record.h"
#include "kernel/scene_view.h"
#include "support/picture_of.h"

namespace orrery::film {

/// Two spheres in front of a camera at the origin that looks along -z, and the sums of one pixel.
class PixelOfLayers : public testing::Test {
 protected:
  PixelOfLayers() {
    view_.spheres = spheres_;
    view_.object_materials = object_materials_;
    view_.materials = materials_;
    view_.sphere_count = 2;
    materials_[1].albedo[0] = 0.25;
  }

  /// A path along the view axis that hits the front of a sphere.
  static kernel::PathRecord path_to(std::uint32_t sphere, double light = 0) {
    kernel::PathRecord path;
    path.object = sphere;
    path.offset.z = 1;
    path.direction.z = -1;
    std::fill_n(path.light, 3, light);
    return path;
  }

  void add(const kernel::PathRecord& path) {
    kernel::LightEvent event{};
    std::copy_n(path.light, 3, event.value);
    event.lobe = kernel::Lobe::kDiffuseDirect;
    add(path, {event});
  }
  void add(const kernel::PathRecord& path, const std::vector<kernel::LightEvent>& events) {
    sums().layers.add(request_, view_, 0, path);
    ++sums().counts[0];
    if (request_.lights())
      for (const kernel::LightEvent& event : events) sums().layers.add(request_, 0, path, event);
    if (!kernel::is_valid_sample(path.light[0], path.light[1], path.light[2])) return;
    for (int c = 0; c < 3; ++c) beauty().rgb[c] += kernel::to_fixed_point(path.light[c]);
    ++beauty().weight;
  }
  /// The sums of the paths so far, of the layers that are requested when the first is added.
  Sums& sums() {
    if (!sums_) sums_.emplace(1, 1, request_);
    return *sums_;
  }
  kernel::PixelSum& beauty() { return sums().light[0][0]; }
  void clear() { sums_.reset(); }

  /// An image of one pixel from the paths added so far.
  Picture picture() {
    if (request_.deep) deep_ = deep_samples(sums(), 0, !request_.transparent);
    return test::picture_of(sums(), request_, view_);
  }
  static float value(const Picture& picture, const std::string& plane) {
    const Plane* found = picture.find(plane);
    EXPECT_NE(found, nullptr) << plane;
    return found != nullptr ? found->values[0] : std::numeric_limits<float>::quiet_NaN();
  }

  kernel::Sphere spheres_[2] = {{0, 0, -5, 1}, {0, 0, -9, 1}};
  std::uint32_t object_materials_[2] = {0, 1};
  kernel::Material materials_[2];
  kernel::SceneView view_;
  LayerRequest request_;
  std::optional<Sums> sums_;
  std::vector<DeepSample> deep_;
};

}  // namespace orrery::film
