// SPDX-License-Identifier: Apache-2.0
#include "display/look_up.h"

#include <utility>

#include "display/config.h"
#include "display/settings.h"
#include "display/view.h"

namespace orrery::display {
namespace {

/// Runs `find`; stores its error as a fault and returns false if it throws.
template <class Find>
bool found(LookUp& out, Name name, Find find) {
  try {
    find();
    return true;
  } catch (const base::Error& error) {
    out.faults.push_back({name, error});
    return false;
  }
}

}  // namespace

LookUp look_up(const Settings& settings, const std::string& space) {
  LookUp out;
  Config config;
  if (!found(out, Name::kConfig, [&] { config = load_config(settings.config); })) return out;
  found(out, Name::kSpace, [&] { find_scene_linear(config, space); });
  if (settings.working_space != space)
    found(out, Name::kWorkingSpace, [&] { find_scene_linear(config, settings.working_space); });
  Choice choice;
  if (found(out, Name::kDisplay, [&] { choose_display(config, settings, choice); }))
    found(out, Name::kView, [&] { choose_view(config, settings, choice); });
  found(out, Name::kLook, [&] { check_look(config, settings); });
  if (!out.faults.empty()) return out;
  View view;  // building the transform fails if a LUT file is missing
  if (found(out, Name::kConfig, [&] { view = find_view(config, settings); })) out.choice = std::move(view.choice);
  return out;
}

std::string view_or_default(const Settings& settings, const std::string& preferred) {
  Choice choice;
  try {
    const Config config = load_config(settings.config);
    choose_display(config, settings, choice);
    if (has_view(config, choice.display, preferred)) return preferred;
    Settings with_default = settings;
    with_default.view.clear();
    choose_view(config, with_default, choice);
  } catch (const base::Error&) {
    return preferred;
  }
  return choice.view;
}

}  // namespace orrery::display
