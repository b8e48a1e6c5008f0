// SPDX-License-Identifier: Apache-2.0
#include "load/load_map.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <utility>

#include <fmt/core.h>

#include "base/available_memory.h"
#include "base/error.h"
#include "base/text.h"
#include "display/color_space.h"
#include "sky/mip_map.h"

namespace orrery::load {
namespace {

/// The colour space of integers that declare none.
constexpr const char* kEncodedSpace = "srgb_texture";

/// White may come out of a conversion brighter by this factor.
constexpr float kRoundingFactor = 1 + 1e-5F;

constexpr float kLargestHalf = 65504;

/// Values of texels that were replaced.
struct Replaced {
  std::uint64_t nan = 0, infinite = 0, negative = 0, out_of_range = 0;
};

class Loader {
 public:
  explicit Loader(const MapRequest& request) : request_(request) {}

  LoadedMap load() {
    try {
      const image::MapHeader header = image::read_map_header(request_.file, request_.formats);
      out_.width = header.width;
      out_.height = header.height;
      out_.bytes = request_.has_mip_map ? sky::mip_map_bytes(header.width, header.height)
                                        : compile::environment_bytes(header.width, header.height, request_.sampling);
      if (header.width != 2 * header.height)
        warn(request_.file_key, fmt::format("{} x {} texels; a latitude-longitude map is twice as wide as high",
                                            header.width, header.height));
      if (header.is_padded)
        warn(request_.file_key, "its data window does not cover its display window; the rest is black");
      const display::PixelConversion convert = conversion(header);
      if (has_errors() || !fits()) return std::move(out_);
      read(header, convert);
    } catch (const base::Error& error) {
      if (error.kind() != base::ErrorKind::kMissingInput && error.kind() != base::ErrorKind::kBadData) throw;
      fail(request_.file_key, error);
    } catch (const std::bad_alloc&) {
      throw base::Error(base::ErrorKind::kNoMemory, "there is not enough memory for " + request_.file.string());
    }
    return std::move(out_);
  }

 private:
  void warn(const std::string& key, std::string text) {
    out_.diagnostics.push_back({base::Severity::kWarning, key, std::move(text)});
  }
  void fail(const std::string& key, const base::Error& error) {
    const bool is_missing = error.kind() == base::ErrorKind::kMissingInput;
    out_.diagnostics.push_back({base::Severity::kError, key, error.what(),
                                is_missing ? base::ErrorKind::kMissingInput : base::ErrorKind::kBadData});
  }
  bool has_errors() const {
    return std::any_of(out_.diagnostics.begin(), out_.diagnostics.end(),
                       [](const auto& d) { return d.severity == base::Severity::kError; });
  }

  /// The space that the file declares; empty if it declares none.
  std::string declared_space(const image::MapHeader& header) {
    if (!header.color_interop_id.empty()) return header.color_interop_id;
    if (header.chromaticities) {
      if (const display::KnownSpace* known = display::known_space(*header.chromaticities)) return known->interop_id;
      warn(request_.file_key, "its chromaticities match no known colour space and are ignored");
    }
    return header.color_space;
  }

  display::PixelConversion conversion(const image::MapHeader& header) {
    if (!request_.is_color) return {};
    const std::string& working = request_.working_space;
    const std::string& chosen = request_.color_space;
    const std::string declared = declared_space(header);
    if (!declared.empty()) {
      try {
        out_.color_space = declared;
        display::PixelConversion convert = display::pixel_conversion(request_.ocio_config, declared, working);
        const display::KnownSpace* const known = display::known_space(declared);
        if (!chosen.empty() && chosen != declared && (known == nullptr || known != display::known_space(chosen)))
          warn(request_.space_key, fmt::format("is ignored: {} declares the colour space `{}`", name(), declared));
        return convert;
      } catch (const base::Error& error) {
        if (error.kind() != base::ErrorKind::kUsage) throw;
        warn(request_.file_key, fmt::format("declares a colour space that cannot be used: {}", error.what()));
      }
    }
    out_.color_space = !chosen.empty() ? chosen : header.is_encoded ? kEncodedSpace : request_.default_space;
    try {
      return display::pixel_conversion(request_.ocio_config, out_.color_space, working);
    } catch (const base::Error& error) {
      fail(chosen.empty() ? request_.file_key : request_.space_key, error);
      return {};
    }
  }

  std::string name() const { return request_.file.filename().string(); }

  bool fits() {
    const std::uint64_t allowed =
        request_.memory_limit > 0 ? request_.memory_limit : base::available_memory().value_or(out_.bytes);
    if (out_.bytes <= allowed) return true;
    const std::string text = fmt::format(
        "an image of {} x {} texels needs about {}, and {}", out_.width, out_.height, base::bytes_text(out_.bytes),
        request_.memory_limit > 0 ? "--memory-limit allows " + base::bytes_text(allowed)
                                  : base::bytes_text(allowed) + " is free");
    if (!request_.skips_large)
      throw base::Error(base::ErrorKind::kNoMemory, fmt::format("{}: {}", request_.file.string(), text));
    warn(request_.file_key, text + "; its pixels were not read");
    return false;
  }

  void read(const image::MapHeader& header, const display::PixelConversion& convert) {
    const auto image = std::make_shared<scene::EnvironmentImage>(header.width, header.height);
    const std::size_t values = 3 * static_cast<std::size_t>(header.width);
    // An infinite sun is one that did not fit into the file.
    const float infinite = header.is_half ? std::min(kLargestHalf, request_.largest) : request_.largest;
    const auto take = [&](int y, float* rgb) {
      for (std::size_t i = 0; i < values; ++i) {
        if (rgb[i] >= 0 && std::isfinite(rgb[i])) continue;
        const bool is_infinite = rgb[i] > 0;
        ++(std::isnan(rgb[i]) ? replaced_.nan : is_infinite ? replaced_.infinite : replaced_.negative);
        rgb[i] = is_infinite ? infinite : 0;
      }
      if (convert) convert(rgb, values / 3);
      float* const row = image->row(y);
      for (std::size_t i = 0; i < values; ++i) {
        const bool is_good = rgb[i] >= 0 && std::isfinite(rgb[i]);
        if (!is_good || rgb[i] > request_.largest * kRoundingFactor) ++replaced_.out_of_range;
        row[i] = is_good ? std::min(rgb[i], request_.largest) : 0.0F;
        out_.brightest = std::max(out_.brightest, row[i]);
      }
    };
    image::read_map(request_.file, take, request_.formats);
    if (request_.has_mip_map) sky::add_mip_map(*image);
    out_.image = image;
    if (replaced_.nan + replaced_.negative > 0)
      warn(request_.file_key,
           fmt::format("{} values are NaN and {} negative; they are replaced by 0", replaced_.nan, replaced_.negative));
    if (replaced_.infinite > 0)
      warn(request_.file_key, fmt::format("{} values are infinite; they are replaced by {}{}", replaced_.infinite,
                                          static_cast<double>(infinite),
                                          header.is_half ? "; write brighter values in single precision" : ""));
    if (replaced_.out_of_range > 0)
      warn(request_.file_key, fmt::format("{} values are out of range{} and were clamped", replaced_.out_of_range,
                                          request_.is_color ? " in " + request_.working_space : ""));
  }

  const MapRequest& request_;
  Replaced replaced_;
  LoadedMap out_;
};

}  // namespace

LoadedMap load_map(const MapRequest& request) { return Loader(request).load(); }

}  // namespace orrery::load
