// SPDX-License-Identifier: Apache-2.0
#include "display/view.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/suggestion.h"
#include "display/config.h"
#include "display/find_color_space.h"
#include "display/names.h"

namespace orrery::display {
namespace {

namespace ocio = OCIO_NAMESPACE;
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
  choice.working_space = find_color_space(source, settings.working_space);
}

/// The colour space that the view ends in.
std::string final_space(const ocio::Config& config, const Choice& choice) {
  const std::string space = config.getDisplayViewColorSpaceName(choice.display.c_str(), choice.view.c_str());
  return space == "<USE_DISPLAY_NAME>" ? choice.display : space;
}

/// Whether a space is for displays of high dynamic range: by what the config says of it, and by name where it says
/// nothing.
bool is_hdr(const ocio::Config& config, const std::string& space) {
  const ocio::ConstColorSpaceRcPtr found = config.getColorSpace(space.c_str());
  const std::string encoding = found ? found->getEncoding() : "";
  if (!encoding.empty()) return encoding == "hdr-video";
  return space.find("2100") != std::string::npos || space.find("ST2084") != std::string::npos;
}

ocio::ConstProcessorRcPtr transform(const ocio::Config& config, const Settings& settings, const Choice& choice) {
  auto group = ocio::GroupTransform::Create();
  if (!settings.look.empty()) {
    auto look = ocio::LookTransform::Create();
    look->setSrc(choice.working_space.c_str());
    look->setDst(choice.working_space.c_str());
    look->setLooks(settings.look.c_str());
    group->appendTransform(look);
  }
  auto view = ocio::DisplayViewTransform::Create();
  view->setSrc(choice.working_space.c_str());
  view->setDisplay(choice.display.c_str());
  view->setView(choice.view.c_str());
  group->appendTransform(view);
  return config.getProcessor(group);
}

}  // namespace

View find_view(const Settings& settings) {
  if (!std::isfinite(settings.stops()))
    throw base::Error(base::ErrorKind::kUsage, "the exposure must be a finite number of stops");
  const Config source = load_config(settings.config);
  View out;
  try {
    out.choice.config = source.source;
    out.choice.config_id = source.config->getCacheID();
    out.choice.warnings = source.warnings;
    choose_names(source, settings, out.choice);
    out.transform = transform(*source.config, settings, out.choice);
    // Lossless: the default trades accuracy for tables.
    const ocio::ConstProcessorMetadataRcPtr metadata = out.transform->getProcessorMetadata();
    for (int i = 0; i < metadata->getNumFiles(); ++i) out.choice.files.emplace_back(metadata->getFile(i));
    out.processor = out.transform->getOptimizedCPUProcessor(ocio::OPTIMIZATION_LOSSLESS);
    const std::string space = final_space(*source.config, out.choice);
    out.is_srgb = space.find("sRGB") != std::string::npos;
    out.choice.is_hdr = is_hdr(*source.config, space);
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
