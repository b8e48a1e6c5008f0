// SPDX-License-Identifier: Apache-2.0
#include "job/load_background.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <utility>

#include <fmt/core.h>

#include "base/error.h"
#include "compile/daylight.h"
#include "compile/environment.h"
#include "display/color_space.h"
#include "image/read_map.h"
#include "job/memory.h"
#include "job/text.h"

namespace orrery::job {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFileKey = "background.file";
constexpr const char* kSpaceKey = "background.color_space";

/// Values of texels that were replaced.
struct Replaced {
  std::uint64_t nan = 0, infinite = 0, negative = 0, out_of_range = 0;
};

compile::EnvironmentSampling sampling_of(const scene::Scene& scene) {
  return scene.render.direct_lighting == scene::DirectLighting::kBsdf ? compile::EnvironmentSampling::kNone
                                                                      : compile::EnvironmentSampling::kComplete;
}

class Loader {
 public:
  Loader(const BackgroundRequest& request, const scene::Scene& scene) : request_(request), scene_(scene) {}

  LoadedBackground load() {
    try {
      const image::MapHeader header = image::read_map_header(request_.file);
      out_.width = header.width;
      out_.height = header.height;
      out_.bytes = compile::environment_bytes(header.width, header.height, sampling_of(scene_));
      if (header.width != 2 * header.height)
        warn(kFileKey, fmt::format("{} x {} texels; a latitude-longitude map is twice as wide as high", header.width,
                                   header.height));
      const display::PixelConversion convert = conversion(header);
      if (has_errors() || !fits()) return std::move(out_);
      read(header, convert);
    } catch (const base::Error& error) {
      if (error.kind() != base::ErrorKind::kMissingInput && error.kind() != base::ErrorKind::kBadData) throw;
      fail(kFileKey, error);
    } catch (const std::bad_alloc&) {
      throw base::Error(base::ErrorKind::kNoMemory, "there is not enough memory for " + request_.file.string());
    }
    return std::move(out_);
  }

 private:
  void warn(const char* key, std::string text) {
    out_.diagnostics.push_back({base::Severity::kWarning, key, std::move(text)});
  }
  void fail(const char* key, const base::Error& error) {
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
      warn(kFileKey, "its chromaticities are those of no known colour space and are ignored");
    }
    return header.color_space;
  }

  display::PixelConversion conversion(const image::MapHeader& header) {
    const std::string& working = scene_.color.working_space();
    const std::string& chosen = scene_.background.color_space;
    const std::string declared = declared_space(header);
    if (!declared.empty()) {
      try {
        out_.color_space = declared;
        display::PixelConversion convert = display::pixel_conversion(request_.ocio_config, declared, working);
        const display::KnownSpace* const known = display::known_space(declared);
        if (!chosen.empty() && chosen != declared && (known == nullptr || known != display::known_space(chosen)))
          warn(kSpaceKey, fmt::format("is ignored: {} declares the colour space `{}`", name(), declared));
        return convert;
      } catch (const base::Error& error) {
        if (error.kind() != base::ErrorKind::kUsage) throw;
        warn(kFileKey, fmt::format("declares a colour space that cannot be used: {}", error.what()));
      }
    }
    out_.color_space = chosen.empty() ? scene_.color.space : chosen;
    try {
      return display::pixel_conversion(request_.ocio_config, out_.color_space, working);
    } catch (const base::Error& error) {
      fail(chosen.empty() ? kFileKey : kSpaceKey, error);
      return {};
    }
  }

  std::string name() const { return request_.file.filename().string(); }

  bool fits() {
    const std::uint64_t allowed =
        request_.memory_limit > 0 ? request_.memory_limit : available_memory().value_or(out_.bytes);
    if (out_.bytes <= allowed) return true;
    const std::string text = fmt::format(
        "an image of {} x {} texels needs about {}, and {}", out_.width, out_.height, bytes_text(out_.bytes),
        request_.memory_limit > 0 ? "--memory-limit allows " + bytes_text(allowed) : bytes_text(allowed) + " is free");
    if (!request_.skips_large) throw base::Error(base::ErrorKind::kNoMemory, request_.file.string() + ": " + text);
    warn(kFileKey, text + "; its pixels were not read");
    return false;
  }

  void read(const image::MapHeader& header, const display::PixelConversion& convert) {
    const auto image = std::make_shared<scene::EnvironmentImage>(header.width, header.height);
    const std::size_t values = 3 * static_cast<std::size_t>(header.width);
    image::read_map(request_.file, [&](int y, float* rgb) {
      for (std::size_t i = 0; i < values; ++i) {
        if (rgb[i] >= 0 && std::isfinite(rgb[i])) continue;
        ++(std::isnan(rgb[i]) ? replaced_.nan : std::isinf(rgb[i]) ? replaced_.infinite : replaced_.negative);
        rgb[i] = 0;
      }
      if (convert) convert(rgb, values / 3);
      float* const row = image->row(y);
      for (std::size_t i = 0; i < values; ++i) {
        const bool is_good = rgb[i] >= 0 && std::isfinite(rgb[i]);
        if (!is_good) ++replaced_.out_of_range;
        row[i] = is_good ? rgb[i] : 0.0F;
      }
    });
    out_.image = image;
    if (replaced_.nan + replaced_.infinite + replaced_.negative > 0)
      warn(kFileKey, fmt::format("{} values are NaN, {} infinite and {} negative; they count as 0", replaced_.nan,
                                 replaced_.infinite, replaced_.negative));
    if (replaced_.out_of_range > 0)
      warn(kFileKey, fmt::format("{} values are out of range in {} and were clamped", replaced_.out_of_range,
                                 scene_.color.working_space()));
  }

  const BackgroundRequest& request_;
  const scene::Scene& scene_;
  Replaced replaced_;
  LoadedBackground out_;
};

/// Identifies a version of the file and the conversion; empty if the file cannot be examined.
std::string key_of(const BackgroundRequest& request, const scene::Scene& scene) {
  std::error_code size_error, time_error;
  const std::uintmax_t size = fs::file_size(request.file, size_error);
  const fs::file_time_type time = fs::last_write_time(request.file, time_error);
  if (size_error || time_error) return {};
  return fmt::format("{}\n{} {}\n{}\n{}\n{}\n{}", fs::absolute(request.file).string(), size,
                     time.time_since_epoch().count(), request.ocio_config, scene.background.color_space,
                     scene.color.space, scene.color.working_space());
}

/// Converts a colour, and replaces negative components by 0.
math::Vec3d converted(const display::PixelConversion& convert, math::Vec3d color) {
  if (!convert) return color;
  float rgb[3] = {static_cast<float>(color.x), static_cast<float>(color.y), static_cast<float>(color.z)};
  convert(rgb, 1);
  const auto component = [](float v) { return static_cast<double>(std::max(v, 0.0F)); };
  return {component(rgb[0]), component(rgb[1]), component(rgb[2])};
}

}  // namespace

LoadedBackground load_sky(const std::string& ocio_config, const scene::Scene& scene) {
  LoadedBackground out;
  out.color_space = "lin_rec709";
  display::PixelConversion to_sky, to_working;
  try {
    to_sky = display::pixel_conversion(ocio_config, scene.color.space, out.color_space);
    to_working = display::pixel_conversion(ocio_config, out.color_space, scene.color.working_space());
  } catch (const base::Error& error) {
    if (error.kind() != base::ErrorKind::kUsage) throw;
    out.diagnostics.push_back({base::Severity::kError, "background.type",
                               std::string("a sky needs linear Rec.709: ") + error.what(), base::ErrorKind::kBadData});
    return out;
  }
  scene::Background background = scene.background;
  const math::Vec3d albedo = converted(to_sky, background.ground_albedo);
  background.ground_albedo = {std::min(albedo.x, 1.0), std::min(albedo.y, 1.0), std::min(albedo.z, 1.0)};
  const auto image = std::make_shared<scene::EnvironmentImage>(compile::bake_sky(background));
  if (to_working) {
    const auto width = static_cast<std::size_t>(image->width());
    for (int y = 0; y < image->height(); ++y) {
      float* const row = image->row(y);
      to_working(row, width);
      for (std::size_t i = 0; i < 3 * width; ++i) row[i] = std::max(row[i], 0.0F);
    }
    image->sun.radiance = converted(to_working, image->sun.radiance);
  }
  out.width = image->width();
  out.height = image->height();
  out.bytes = compile::environment_bytes(out.width, out.height, sampling_of(scene));
  out.image = image;
  return out;
}

LoadedBackground load_background(const BackgroundRequest& request, const scene::Scene& scene) {
  if (!request.cache) return Loader(request, scene).load();
  const std::string key = key_of(request, scene);
  if (!key.empty() && key == request.cache->key && request.cache->loaded.image) return request.cache->loaded;
  *request.cache = {};  // its memory must be free before another image is read
  LoadedBackground loaded = Loader(request, scene).load();
  *request.cache = {key, loaded};
  return loaded;
}

}  // namespace orrery::job
