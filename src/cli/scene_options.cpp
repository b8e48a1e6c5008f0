// SPDX-License-Identifier: Apache-2.0
#include "cli/scene_options.h"

#include <fmt/core.h>

#include "base/error.h"
#include "base/frames.h"
#include "cli/option_checks.h"
#include "format/read_scene.h"

namespace orrery::cli {

void SceneOptions::add_to(Command& command, Short forms) {
  const OptionGroup group(command, "Scene options");
  command.add_option("--set", set_, "Override a key of the scene file, e.g. camera.vfov=30; can be repeated")
      ->type_name("KEY=VALUE")
      ->repeatable();
  const auto add = [&](const char* flag, const char* key, const char* type, const char* what) {
    ShortForm& option = short_forms_.emplace_back(ShortForm{flag, key, {}, nullptr, false});
    option.flag = command.add_option(flag, option.value, fmt::format("{} ({})", what, key))->type_name(type);
  };
  add("--width", "image.width", "N", "Image width in pixels");
  add("--height", "image.height", "N", "Image height in pixels");
  if (forms == Short::kSize) return;
  add("--samples", "render.samples", "N", "Samples per pixel");
  add("--precision", "render.precision", "NAME", "Arithmetic: exact, fast or book");
  add("--layers", "output.layers", "NAMES",
      "Additional EXR layers, e.g. Z,N,diffuse; all: every layer of the scene; \"\": none");
  short_forms_.back().is_list = true;
  short_forms_.back().flag->may_be_empty();
}

format::Overrides SceneOptions::overrides() const {
  format::Overrides out, set;
  for (const std::string& setting : set_) set.add(setting);
  for (const ShortForm& option : short_forms_) {
    if (option.flag->count() == 0) continue;
    for (const format::Override& other : set)
      if (other.sets(option.key))
        throw base::Error(base::ErrorKind::kUsage,
                          fmt::format("{} and --set {} set the same key; omit one of them", option.name, other.typed));
    out.add_option(option.name, option.key, option.value, option.is_list);
  }
  for (const format::Override& other : set) out.add(other);
  return out;
}

void SceneOptions::add_frame_to(Command& command) {
  command.add_option("--frame,--frames", frame_, "Frame of an animation; default: 1")->type_name("N");
}

int SceneOptions::frame() const {
  if (frame_.empty()) return format::kFirstFrame;
  const std::vector<int> frames = base::parse_frames(frame_);
  if (frames.size() != 1)
    throw base::Error(
        base::ErrorKind::kUsage,
        fmt::format("--frame {} selects {} frames, but this command takes one; orrery check takes several", frame_,
                    frames.size()));
  return frames.front();
}

}  // namespace orrery::cli
