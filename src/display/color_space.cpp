// SPDX-License-Identifier: Apache-2.0
#include "display/color_space.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "base/error.h"
#include "display/config.h"

namespace orrery::display {
namespace {

namespace ocio = OCIO_NAMESPACE;

/// A space with its names in orrery's config and in all generations of the ACES configs.
struct Entry {
  Names names;
  KnownSpace space;
};

const std::vector<Entry>& entries() {
  static const std::vector<Entry> all = {
      {{"lin_rec709", "lin_rec709_scene", "Linear Rec.709 (sRGB)", "lin_srgb", "Utility - Linear - sRGB",
        "Utility - Linear - Rec.709"},
       {"lin_rec709_scene", {0.64F, 0.33F, 0.30F, 0.60F, 0.15F, 0.06F, 0.3127F, 0.3290F}}},
      {{"acescg", "ACEScg", "lin_ap1", "lin_ap1_scene", "ACES - ACEScg"},
       {"lin_ap1_scene", {0.713F, 0.293F, 0.165F, 0.830F, 0.128F, 0.044F, 0.32168F, 0.33767F}}},
      {{"aces2065_1", "ACES2065-1", "lin_ap0", "lin_ap0_scene", "ACES - ACES2065-1"},
       {"lin_ap0_scene", {0.7347F, 0.2653F, 0.0F, 1.0F, 0.0001F, -0.077F, 0.32168F, 0.33767F}}},
      {{"lin_rec2020", "lin_rec2020_scene", "Linear Rec.2020", "Utility - Linear - Rec.2020"},
       {"lin_rec2020_scene", {0.708F, 0.292F, 0.170F, 0.797F, 0.131F, 0.046F, 0.3127F, 0.3290F}}},
      {{"lin_p3d65", "lin_p3d65_scene", "Linear P3-D65", "Utility - Linear - P3-D65"},
       {"lin_p3d65_scene", {0.680F, 0.320F, 0.265F, 0.690F, 0.150F, 0.060F, 0.3127F, 0.3290F}}}};
  return all;
}

const Entry* entry_of(const std::string& name) {
  for (const Entry& entry : entries())
    if (std::find(entry.names.begin(), entry.names.end(), name) != entry.names.end()) return &entry;
  return nullptr;
}

/// The conversion between two spaces of a config.
ocio::ConstCPUProcessorRcPtr processor_of(const Config& source, const std::string& from, const std::string& to) {
  try {
    // Lossless, since the default optimization replaces curves by LUTs.
    return source.config->getProcessor(from.c_str(), to.c_str())->getOptimizedCPUProcessor(ocio::OPTIMIZATION_LOSSLESS);
  } catch (const ocio::Exception& error) {
    throw base::Error(base::ErrorKind::kBadData,
                      fmt::format("the OCIO config {} cannot be used: {}", source.name, error.what()));
  }
}

}  // namespace

std::string find_color_space(const Config& config, const std::string& name) {
  Names tried = {name};
  if (const Entry* entry = entry_of(name)) tried.insert(tried.end(), entry->names.begin(), entry->names.end());
  for (const std::string& candidate : tried)  // OCIO itself looks for names, aliases and roles
    if (const auto space = config.config->getColorSpace(candidate.c_str())) return space->getName();
  tried.erase(std::unique(tried.begin(), tried.end()), tried.end());
  const std::string also =
      tried.size() > 1 ? ", nor under the names " + base::joined(Names(tried.begin() + 1, tried.end())) : "";
  unknown(config, "colour space", name,
          names(config.config->getNumColorSpaces(), [&](int i) { return config.config->getColorSpaceNameByIndex(i); }),
          also);
}

std::string find_scene_linear(const Config& config, const std::string& name) {
  const std::string found = find_color_space(config, name);
  const ocio::ConstColorSpaceRcPtr space = config.config->getColorSpace(found.c_str());
  const std::string encoding = space->getEncoding();
  if (space->isData() || (!encoding.empty() && encoding != "scene-linear"))
    base::refuse(fmt::format(
        "colour space `{}` of the OCIO config ({}) is not scene-linear; rendering needs a scene-linear space", name,
        config.name));
  return found;
}

PixelConversion pixel_conversion(const std::string& config_file, const std::string& from, const std::string& to) {
  if (from == to || (known_space(from) != nullptr && known_space(from) == known_space(to))) return {};
  const Config source = load_config(config_file);
  const auto processor = processor_of(source, find_color_space(source, from), find_scene_linear(source, to));
  return [processor](float* rgb, std::size_t pixels) {
    ocio::PackedImageDesc image(rgb, static_cast<long>(pixels), 1, 3);
    processor->apply(image);
  };
}

math::Vec3d converted(const PixelConversion& convert, math::Vec3d color) {
  if (!convert) return color;
  float rgb[3] = {static_cast<float>(color.x), static_cast<float>(color.y), static_cast<float>(color.z)};
  convert(rgb, 1);
  return {static_cast<double>(rgb[0]), static_cast<double>(rgb[1]), static_cast<double>(rgb[2])};
}

const KnownSpace* known_space(const std::array<float, 8>& chromaticities) {
  constexpr float kTolerance = 5e-4F;  // files hold the numbers with three or four digits
  for (const Entry& entry : entries()) {
    const auto& known = entry.space.chromaticities;
    const auto is_near = [](float a, float b) { return std::abs(a - b) <= kTolerance; };
    if (std::equal(known.begin(), known.end(), chromaticities.begin(), is_near)) return &entry.space;
  }
  return nullptr;
}

const KnownSpace* known_space(const std::string& name) {
  const Entry* entry = entry_of(name == "scene_linear" ? "lin_rec709" : name);
  return entry != nullptr ? &entry->space : nullptr;
}

}  // namespace orrery::display
