// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "film/layers.h"

namespace orrery::test {

/// Adds a matte with the ids of the spheres, each of which is its class.
inline void add_matte(film::LayerRequest& request, std::string name, std::vector<std::uint32_t> ids) {
  const auto count = static_cast<std::uint32_t>(ids.size());
  film::MatteClasses classes{{count, count}, {}};
  for (std::uint32_t i = 0; i < count; ++i) {
    classes.of_sphere.set(i, i);
    classes.first_sphere.push_back(i);
  }
  request.matte_classes = std::make_shared<film::MatteClasses>(std::move(classes));
  request.mattes.push_back({std::move(name), std::move(ids)});
}

/// Adds a matte in which the id of the first 100 spheres is `first` + index.
inline void add_matte_of_spheres(film::LayerRequest& request, std::uint32_t first) {
  std::vector<std::uint32_t> ids;
  for (std::uint32_t i = 0; i < 100; ++i) ids.push_back(first + i);
  add_matte(request, "CryptoObject", std::move(ids));
}

}  // namespace orrery::test
