// SPDX-License-Identifier: Apache-2.0
#include "display/view.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/suggestion.h"
#include "display/config.h"

namespace orrery::display {
namespace {

namespace ocio = OCIO_NAMESPACE;
using Names = std::vector<std::string>;

/// Names handed out one by one by OCIO.
template <class Get>
Names names(int count, Get get) {
  Names out;
  for (int i = 0; i < count; ++i) out.emplace_back(get(i));
  return out;
}

[[noreturn]] void unknown(const Config& config, const std::string& what, const std::string& name, const Names& known) {
  const std::string near = base::did_you_mean(name, known);
  throw base::Error(base::ErrorKind::kUsage, "the OCIO config (" + config.source + ") has no " + what + " `" + name +
                                                 "`; " + (near.empty() ? "" : near + " ") +
                                                 (known.empty() ? "it has none" : "it has " + base::joined(known)));
}

void require(const Config& config, const std::string& what, const std::string& name, const Names& known) {
  if (std::find(known.begin(), known.end(), name) == known.end()) unknown(config, what, name, known);
}

void choose_names(const Config& source, const Settings& settings, Choice& choice) {
  const ocio::Config& config = *source.config;
  choice.display = settings.display.empty() ? config.getDefaultDisplay() : settings.display;
  const char* const display = choice.display.c_str();
  require(source, "display", choice.display,
          names(config.getNumDisplays(), [&](int i) { return config.getDisplay(i); }));
  choice.view = settings.view.empty() ? config.getDefaultView(display) : settings.view;
  require(source, "view on display `" + choice.display + "` named", choice.view,
          names(config.getNumViews(display), [&](int i) { return config.getView(display, i); }));
  if (!settings.look.empty())
    require(source, "look", settings.look,
            names(config.getNumLooks(), [&](int i) { return config.getLookNameByIndex(i); }));
  if (config.getColorSpace(settings.working_space.c_str()) == nullptr)
    unknown(source, "colour space", settings.working_space,
            names(config.getNumColorSpaces(), [&](int i) { return config.getColorSpaceNameByIndex(i); }));
}

/// Whether the view ends in the encoding that files without a profile are taken to have.
bool ends_in_srgb(const ocio::Config& config, const Choice& choice) {
  std::string space = config.getDisplayViewColorSpaceName(choice.display.c_str(), choice.view.c_str());
  if (space == "<USE_DISPLAY_NAME>") space = choice.display;
  return space.find("sRGB") != std::string::npos;
}

ocio::ConstCPUProcessorRcPtr processor(const ocio::Config& config, const Settings& settings, const Choice& choice) {
  auto group = ocio::GroupTransform::Create();
  if (!settings.look.empty()) {
    auto look = ocio::LookTransform::Create();
    look->setSrc(settings.working_space.c_str());
    look->setDst(settings.working_space.c_str());
    look->setLooks(settings.look.c_str());
    group->appendTransform(look);
  }
  auto view = ocio::DisplayViewTransform::Create();
  view->setSrc(settings.working_space.c_str());
  view->setDisplay(choice.display.c_str());
  view->setView(choice.view.c_str());
  group->appendTransform(view);
  // Lossless: the default trades accuracy for tables.
  return config.getProcessor(group)->getOptimizedCPUProcessor(ocio::OPTIMIZATION_LOSSLESS);
}

}  // namespace

View find_view(const Settings& settings) {
  if (!std::isfinite(settings.exposure))
    throw base::Error(base::ErrorKind::kUsage, "the exposure must be a finite number of stops");
  const Config source = load_config(settings.config);
  View out;
  try {
    out.choice.config = source.source;
    out.choice.config_id = source.config->getCacheID();
    out.choice.warnings = source.warnings;
    choose_names(source, settings, out.choice);
    out.processor = processor(*source.config, settings, out.choice);
    out.is_srgb = ends_in_srgb(*source.config, out.choice);
  } catch (const ocio::ExceptionMissingFile& error) {
    throw base::Error(base::ErrorKind::kMissingInput,
                      "the OCIO config " + source.source + " names a file that is not there: " + error.what());
  } catch (const ocio::Exception& error) {
    throw base::Error(base::ErrorKind::kBadData,
                      "the OCIO config " + source.source + " cannot be used: " + error.what());
  }
  return out;
}

}  // namespace orrery::display
