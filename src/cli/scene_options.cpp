// SPDX-License-Identifier: Apache-2.0
#include "cli/scene_options.h"

#include <utility>

namespace orrery::cli {

void SceneOptions::add_to(CLI::App& command) {
  command.add_option("--set", set_, "Override a key of the scene file: --set camera.vfov=30")->type_name("KEY=VALUE")->take_all()->expected(1);
  command.add_option("--samples", samples_, "Samples per pixel; as --set render.samples")->type_name("N");
  command.add_option("--width", width_, "Width of the picture in pixels; as --set image.width")->type_name("N");
  command.add_option("--height", height_, "Height of the picture in pixels; as --set image.height")->type_name("N");
  command.add_option("--seed", seed_, "Seed of the random numbers; as --set render.seed")->type_name("N");
  command.add_option("--max-depth", max_depth_, "Most scattering events of a path; as --set render.max_depth")->type_name("N");
  command.add_option("--precision", precision_, "exact, fast or book; as --set render.precision")->type_name("NAME");
  command.add_option("--accelerator", accelerator_, "embree or list; as --set render.accelerator")->type_name("NAME");
}

std::vector<std::string> SceneOptions::overrides() const {
  std::vector<std::string> out;
  for (const auto& [key, value] : {std::pair<const char*, const std::string*>{"render.samples", &samples_},
                                   {"image.width", &width_},
                                   {"image.height", &height_},
                                   {"render.seed", &seed_},
                                   {"render.max_depth", &max_depth_},
                                   {"render.precision", &precision_},
                                   {"render.accelerator", &accelerator_}})
    if (!value->empty()) out.push_back(std::string(key) + "=" + *value);
  out.insert(out.end(), set_.begin(), set_.end());
  return out;
}

}  // namespace orrery::cli
