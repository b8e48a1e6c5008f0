// SPDX-License-Identifier: Apache-2.0
#include "job/version.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "accel/accel.h"
#include "display/develop.h"
#include "kernel/isa.h"
#include "load/read_scene.h"
#include "render/render.h"

namespace orrery::job {

std::string program_version() { return ORRERY_VERSION; }

std::vector<std::pair<std::string, std::string>> library_versions() {
  return {{"Embree", accel::embree_version()},
          {"oneTBB", render::tbb_version()},
          {"OpenImageIO", ORRERY_OIIO_VERSION},
          {"OpenColorIO", display::ocio_version()},
          {"Highway", kernel::highway_version()},
          {"toml++", load::toml_version()},
          {"fmt", fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100)},
          {"nlohmann-json", fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR,
                                        NLOHMANN_JSON_VERSION_PATCH)}};
}

}  // namespace orrery::job
