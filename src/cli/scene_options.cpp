// SPDX-License-Identifier: Apache-2.0
#include "cli/scene_options.h"

#include <sstream>
#include <string_view>
#include <utility>

#include "cli/option_checks.h"

namespace orrery::cli {

namespace {

/// a,b as ["a","b"].
std::string quoted_list(const std::string& words) {
  std::string out = "[";
  std::istringstream in(words);
  for (std::string word; std::getline(in, word, ',');) out += (out.size() > 1 ? ",\"" : "\"") + word + '"';
  return out + "]";
}

}  // namespace

void SceneOptions::add_to(Command& command, bool allows_range) {
  allows_range_ = allows_range;
  command.add_option("--set", set_, "Override a key of the scene file: --set camera.vfov=30; can be repeated")
      ->type_name("KEY=VALUE")
      ->repeatable();
  const auto add = [&](const char* flag, const char* key, const char* type, const std::string& what) {
    Short& option = short_forms_.emplace_back(Short{key, {}, nullptr, false});
    option.flag = command.add_option(flag, option.value, what + "; as --set " + key)->type_name(type);
  };
  add("--samples", "render.samples", allows_range ? "N or A:B" : "N",
      allows_range ? "Samples per pixel, or of the scene's only those from A to before B, as a part"
                   : "Samples per pixel");
  add("--width", "image.width", "N", "Width of the picture in pixels");
  add("--height", "image.height", "N", "Height of the picture in pixels");
  add("--seed", "render.seed", "N", "Seed of the random numbers");
  add("--max-depth", "render.max_depth", "N", "Most scattering events of a path");
  add("--precision", "render.precision", "NAME", "exact, fast or book");
  add("--accelerator", "render.accelerator", "NAME", "embree or list");
  add("--layers", "output.layers", "NAMES", "Layers of EXR files beside the beauty, as in Z,N,diffuse; none: \"\"");
  short_forms_.back().is_list = true;
}

bool SceneOptions::is_range(const Short& option) const {
  return allows_range_ && std::string_view(option.key) == "render.samples" &&
         option.value.find(':') != std::string::npos;
}

std::optional<std::string> SceneOptions::sample_range() const {
  for (const Short& option : short_forms_)
    if (option.flag->count() > 0 && is_range(option)) return option.value;
  return {};
}

std::vector<std::string> SceneOptions::overrides() const {
  std::vector<std::string> out;
  for (const Short& option : short_forms_)
    if (option.flag->count() > 0 && !is_range(option))
      out.push_back(std::string(option.key) + "=" + (option.is_list ? quoted_list(option.value) : option.value));
  out.insert(out.end(), set_.begin(), set_.end());
  return out;
}

}  // namespace orrery::cli
