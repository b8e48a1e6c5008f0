// SPDX-License-Identifier: Apache-2.0
#include "display/view.h"

#include <cmath>
#include <utility>

#include <fmt/core.h>

#include "base/error.h"
#include "base/text.h"
#include "display/config.h"
#include "display/settings.h"

namespace orrery::display {
namespace {

namespace ocio = OCIO_NAMESPACE;

void require(const Config& config, const std::string& what, const std::string& name, const Names& known) {
  if (!base::contains(known, name)) unknown(config, what, name, known);
}

Names views_of(const Config& config, const std::string& display) {
  return names(config.config->getNumViews(display.c_str()),
               [&](int i) { return config.config->getView(display.c_str(), i); });
}

/// The output colour space of the view.
std::string final_space(const ocio::Config& config, const Choice& choice) {
  const std::string space = config.getDisplayViewColorSpaceName(choice.display.c_str(), choice.view.c_str());
  return space == "<USE_DISPLAY_NAME>" ? choice.display : space;
}

/// The encoding of a space according to the config; empty if it does not say.
std::string encoding_of(const ocio::Config& config, const std::string& space) {
  const ocio::ConstColorSpaceRcPtr found = config.getColorSpace(space.c_str());
  return found ? found->getEncoding() : "";
}

/// Whether a space is for high dynamic range displays, by its encoding in the config, or else by its name.
bool is_hdr(const ocio::Config& config, const std::string& space) {
  if (const std::string encoding = encoding_of(config, space); !encoding.empty()) return encoding == "hdr-video";
  return space.find("2100") != std::string::npos || space.find("ST2084") != std::string::npos;
}

/// Whether images in this space may be tagged as sRGB.
bool is_srgb(const ocio::Config& config, const std::string& space) {
  if (space.find("sRGB") == std::string::npos) return false;
  if (const std::string encoding = encoding_of(config, space); !encoding.empty()) return encoding == "sdr-video";
  return space.find("inear") == std::string::npos;  // "Linear Rec.709 (sRGB)"
}

/// Looks as a transform of the working space.
ocio::LookTransformRcPtr look_transform(const std::string& looks, const Choice& choice) {
  auto look = ocio::LookTransform::Create();
  look->setSrc(choice.working_space.c_str());
  look->setDst(choice.working_space.c_str());
  look->setLooks(looks.c_str());
  return look;
}

/// `has_looks`  with the looks of the view
ocio::ConstProcessorRcPtr transform(const ocio::Config& config, const Settings& settings, const Choice& choice,
                                    bool has_looks) {
  auto group = ocio::GroupTransform::Create();
  if (!settings.look.empty()) group->appendTransform(look_transform(settings.look, choice));
  auto view = ocio::DisplayViewTransform::Create();
  view->setSrc(choice.working_space.c_str());
  view->setDisplay(choice.display.c_str());
  view->setView(choice.view.c_str());
  view->setLooksBypass(!has_looks);
  group->appendTransform(view);
  return config.getProcessor(group);
}

void choose_display(const Config& config, const Settings& settings, Choice& choice) {
  choice.display = settings.display.empty() ? config.config->getDefaultDisplay() : settings.display;
  require(config, "display", choice.display,
          names(config.config->getNumDisplays(), [&](int i) { return config.config->getDisplay(i); }));
}

void choose_view(const Config& config, const Settings& settings, Choice& choice) {
  choice.view = settings.view.empty() ? config.config->getDefaultView(choice.display.c_str()) : settings.view;
  require(config, fmt::format("view on display `{}` named", choice.display), choice.view,
          views_of(config, choice.display));
}

void check_look(const Config& config, const Settings& settings) {
  if (settings.look.empty()) return;
  require(config, "look", settings.look,
          names(config.config->getNumLooks(), [&](int i) { return config.config->getLookNameByIndex(i); }));
}

/// Runs `find`; stores its error as a fault and returns false if it throws.
template <class Find>
bool found(LookUp& out, const char* name, Find find) {
  try {
    find();
    return true;
  } catch (const base::Error& error) {
    out.faults.push_back({name, error});
    return false;
  }
}

}  // namespace

View find_view(const Settings& settings) { return find_view(load_config(settings.config), settings); }

View find_view(const Config& source, const Settings& settings) {
  if (!std::isfinite(settings.stops())) base::refuse("the exposure must be a finite number of stops");
  View out;
  try {
    out.choice.config = source.name;
    out.choice.config_id = source.config->getCacheID();
    out.choice.warnings = source.warnings;
    choose_display(source, settings, out.choice);
    choose_view(source, settings, out.choice);
    check_look(source, settings);
    out.choice.working_space = find_color_space(source, settings.working_space);
    // Lossless, since the default optimization replaces curves by LUTs.
    const auto lossless = [](const ocio::ConstProcessorRcPtr& processor) {
      return processor->getOptimizedCPUProcessor(ocio::OPTIMIZATION_LOSSLESS);
    };
    out.processor = lossless(transform(*source.config, settings, out.choice, true));
    const std::string looks = source.config->getDisplayViewLooks(out.choice.display.c_str(), out.choice.view.c_str());
    out.choice.has_looks = !looks.empty();
    if (out.choice.has_looks && settings.backdrop) {
      out.looks = lossless(source.config->getProcessor(look_transform(looks, out.choice)));
      out.page = lossless(transform(*source.config, settings, out.choice, false));
    }
    out.choice.transform_id = out.processor->getCacheID();
    const std::string space = final_space(*source.config, out.choice);
    out.is_srgb = is_srgb(*source.config, space);
    out.choice.is_hdr = is_hdr(*source.config, space);
  } catch (const ocio::ExceptionMissingFile& error) {
    throw base::Error(base::ErrorKind::kMissingInput,
                      fmt::format("the OCIO config {} refers to a missing file: {}", source.name, error.what()));
  } catch (const ocio::Exception& error) {
    throw base::Error(base::ErrorKind::kBadData,
                      fmt::format("the OCIO config {} cannot be used: {}", source.name, error.what()));
  }
  return out;
}

void Settings::complete(const Settings& others) {
  for (std::string Settings::*const name : {&Settings::config, &Settings::display, &Settings::view, &Settings::look})
    if ((this->*name).empty()) this->*name = others.*name;
  if (!exposure) exposure = others.exposure;
  working_space = others.working_space;
  backdrop = others.backdrop;
}

LookUp look_up(const Settings& settings, const std::string& space) {
  LookUp out;
  Config config;
  if (!found(out, "config", [&] { config = load_config(settings.config); })) return out;
  found(out, "space", [&] { find_scene_linear(config, space); });
  if (settings.working_space != space)
    found(out, "working", [&] { find_scene_linear(config, settings.working_space); });
  Choice choice;
  if (found(out, "display", [&] { choose_display(config, settings, choice); }))
    found(out, "view", [&] { choose_view(config, settings, choice); });
  found(out, "look", [&] { check_look(config, settings); });
  if (!out.faults.empty()) return out;
  View view;  // building the transform fails if a LUT file is missing
  if (found(out, "config", [&] { view = find_view(config, settings); })) out.choice = std::move(view.choice);
  return out;
}

std::string view_or_default(const Settings& settings, const std::string& preferred) {
  Choice choice;
  try {
    const Config config = load_config(settings.config);
    choose_display(config, settings, choice);
    if (base::contains(views_of(config, choice.display), preferred)) return preferred;
    Settings with_default = settings;
    with_default.view.clear();
    choose_view(config, with_default, choice);
  } catch (const base::Error&) {
    return preferred;
  }
  return choice.view;
}

}  // namespace orrery::display
