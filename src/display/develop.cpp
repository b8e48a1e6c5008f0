// SPDX-License-Identifier: Apache-2.0
#include "display/develop.h"

#include <OpenColorIO/OpenColorIO.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <vector>

#include "base/error.h"
#include "base/suggestion.h"
#include "display/builtin_config.h"

namespace orrery::display {
namespace {

namespace ocio = OCIO_NAMESPACE;

/// Where the config comes from: a file, or nothing for the built-in one.
std::string config_file(const Settings& settings) {
  if (!settings.config.empty()) return settings.config;
  const char* const environment = std::getenv("OCIO");
  return environment != nullptr ? environment : "";
}

ocio::ConstConfigRcPtr load(const std::string& file) {
  if (file.empty()) {
    std::istringstream text(kBuiltinConfig);
    return ocio::Config::CreateFromStream(text);
  }
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored))
    throw base::Error(base::ErrorKind::kMissingInput, "cannot open the OCIO config " + file);
  try {
    ocio::ConstConfigRcPtr config = ocio::Config::CreateFromFile(file.c_str());
    config->validate();
    return config;
  } catch (const ocio::Exception& error) {
    throw base::Error(base::ErrorKind::kBadData, "the OCIO config " + file + " cannot be used: " + error.what());
  }
}

[[noreturn]] void unknown(const std::string& what, const std::string& name, const std::vector<std::string>& known) {
  const std::string near = base::did_you_mean(name, known);
  throw base::Error(base::ErrorKind::kUsage, "the OCIO config has no " + what + " `" + name + "`; " +
                                                 (near.empty() ? "" : near + " ") + "it has " + base::joined(known));
}

/// Names handed out one by one by OCIO.
template <class Count, class Get>
std::vector<std::string> names(Count count, Get get) {
  std::vector<std::string> out;
  for (int i = 0; i < count(); ++i) out.emplace_back(get(i));
  return out;
}

void require(const std::string& what, const std::string& name, const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), name) == known.end()) unknown(what, name, known);
}

struct Chosen {
  ocio::ConstConfigRcPtr config;
  Choice choice;
};

Chosen choose_from_config(const Settings& settings) {
  Chosen out;
  const std::string file = config_file(settings);
  out.config = load(file);
  const ocio::Config& config = *out.config;
  out.choice.config = file.empty() ? "built-in" : file;
  out.choice.display = settings.display.empty() ? config.getDefaultDisplay() : settings.display;
  const char* const display = out.choice.display.c_str();
  require("display", out.choice.display,
          names([&] { return config.getNumDisplays(); }, [&](int i) { return config.getDisplay(i); }));
  out.choice.view = settings.view.empty() ? config.getDefaultView(display) : settings.view;
  require("view", out.choice.view,
          names([&] { return config.getNumViews(display); }, [&](int i) { return config.getView(display, i); }));
  if (!settings.look.empty())
    require("look", settings.look,
            names([&] { return config.getNumLooks(); }, [&](int i) { return config.getLookNameByIndex(i); }));
  if (config.getColorSpace(settings.working_space.c_str()) == nullptr)
    unknown("colour space", settings.working_space,
            names([&] { return config.getNumColorSpaces(); }, [&](int i) { return config.getColorSpaceNameByIndex(i); }));
  return out;
}

ocio::ConstCPUProcessorRcPtr processor(const Chosen& chosen, const Settings& settings) {
  auto group = ocio::GroupTransform::Create();
  if (settings.exposure != 0) {
    auto gain = ocio::MatrixTransform::Create();
    const double g = std::exp2(settings.exposure);
    const double matrix[16] = {g, 0, 0, 0, 0, g, 0, 0, 0, 0, g, 0, 0, 0, 0, 1};
    gain->setMatrix(matrix);
    group->appendTransform(gain);
  }
  if (!settings.look.empty()) {
    auto look = ocio::LookTransform::Create();
    look->setSrc(settings.working_space.c_str());
    look->setDst(settings.working_space.c_str());
    look->setLooks(settings.look.c_str());
    group->appendTransform(look);
  }
  auto view = ocio::DisplayViewTransform::Create();
  view->setSrc(settings.working_space.c_str());
  view->setDisplay(chosen.choice.display.c_str());
  view->setView(chosen.choice.view.c_str());
  group->appendTransform(view);
  // Lossless: the default trades accuracy for look-up tables.
  return chosen.config->getProcessor(group)->getOptimizedCPUProcessor(ocio::OPTIMIZATION_LOSSLESS);
}

const film::Plane& plane(const film::Picture& picture, const char* name) {
  const film::Plane* found = picture.find(name);
  if (found == nullptr)
    throw base::Error(base::ErrorKind::kBadData, std::string("the picture has no channel ") + name);
  return *found;
}

/// A foreign exception becomes ours at the edge of this room.
template <class Function>
auto translated(Function function) {
  try {
    return function();
  } catch (const ocio::Exception& error) {
    throw base::Error(base::ErrorKind::kBadData, std::string("OCIO: ") + error.what());
  }
}

}  // namespace

Choice choose(const Settings& settings) {
  return translated([&] { return choose_from_config(settings).choice; });
}

film::EncodedPicture develop(const film::Picture& picture, const Settings& settings, int bits) {
  const film::Plane* const planes[3] = {&plane(picture, "R"), &plane(picture, "G"), &plane(picture, "B")};
  return translated([&] {
    const Chosen chosen = choose_from_config(settings);
    const auto cpu = processor(chosen, settings);
    const std::size_t pixels = planes[0]->values.size();
    std::vector<float> rgb(pixels * 3);
    for (std::size_t i = 0; i < pixels; ++i)
      for (std::size_t c = 0; c < 3; ++c) rgb[i * 3 + c] = planes[c]->values[i];
    ocio::PackedImageDesc image(rgb.data(), picture.width, picture.height, 3);
    cpu->apply(image);
    film::EncodedPicture out;
    out.width = picture.width;
    out.height = picture.height;
    out.bits = bits;
    out.is_srgb = chosen.choice.display.find("sRGB") != std::string::npos && chosen.choice.view != "Raw";
    out.values.resize(rgb.size());
    const float largest = bits == 8 ? 255.0f : 65535.0f;
    for (std::size_t i = 0; i < rgb.size(); ++i) {
      // Written so that NaN, which the caller has counted, becomes 0.
      const float v = rgb[i] > 0 ? std::min(rgb[i], 1.0f) : 0.0f;
      out.values[i] = static_cast<std::uint16_t>(std::lround(v * largest));
    }
    return out;
  });
}

std::string ocio_version() { return ocio::GetVersion(); }

}  // namespace orrery::display
