// SPDX-License-Identifier: Apache-2.0
#include "load/load_images.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <new>
#include <utility>

#include <fmt/core.h>

#include "base/available_memory.h"
#include "base/error.h"
#include "base/input_file.h"
#include "base/text.h"
#include "compile/environment.h"
#include "compile/mip_map.h"
#include "display/color_space.h"
#include "image/read.h"
#include "scene/limits.h"
#include "scene/texture.h"
#include "sky/daylight.h"

namespace orrery::load {
namespace {

/// The colour space of integers that declare none.
constexpr const char* kEncodedSpace = "srgb_texture";

/// White may come out of a conversion brighter by this factor.
constexpr float kRoundingFactor = 1 + 1e-5F;

constexpr float kLargestHalf = 65504;

/// A map to read.
struct MapRequest {
  std::filesystem::path file;
  std::string file_key, space_key;  ///< keys of the scene, for diagnostics
  image::MapFormats formats = image::MapFormats::kSceneLinear;
  std::string color_space;    ///< colour space that the scene assigns to the file; empty: none
  std::string default_space;  ///< default colour space of scene-linear files
  std::string working_space;  ///< colour space of the result
  bool is_color = true;       ///< false: data, which are not converted
  float largest = static_cast<float>(scene::kBrightestLight);  ///< values above are clamped
  compile::EnvironmentSampling sampling = {};  ///< sampling of the background for direct lighting; default: kNone
  bool has_mip_map = false;                    ///< add a mip map
  ImageRequest options;                        ///< all but its folder

  /// Identifies the contents of the file and the conversion.
  std::string version() const {
    return fmt::format("{}\n{}\n{}\n{}\n{}\n{} {} {}", base::file_version(file), options.ocio_config, color_space,
                       default_space, working_space, is_color, largest, has_mip_map);
  }
};

/// Reads a map and converts it to the working space.
class MapLoader {
 public:
  explicit MapLoader(const MapRequest& request) : request_(request) {}

  LoadedMap load() {
    try {
      const image::MapHeader header = image::read_map_header(request_.file, request_.formats);
      out_.width = header.width;
      out_.height = header.height;
      out_.bytes = request_.has_mip_map ? compile::mip_map_bytes(header.width, header.height)
                                        : compile::environment_bytes(header.width, header.height, request_.sampling);
      if (header.width != 2 * header.height)
        faults_.warning(request_.file_key,
                        fmt::format("{} x {} texels; a latitude-longitude map is twice as wide as high", header.width,
                                    header.height));
      if (header.is_padded)
        faults_.warning(request_.file_key, "its data window does not cover its display window; the rest is black");
      const display::PixelConversion convert = conversion(header);
      if (!faults_.has_errors() && fits()) read(header, convert);
    } catch (const base::Error& error) {
      if (error.kind() != base::ErrorKind::kMissingInput && error.kind() != base::ErrorKind::kBadData) throw;
      faults_.error(request_.file_key, error);
    } catch (const std::bad_alloc&) {
      throw base::Error(base::ErrorKind::kNoMemory, "there is not enough memory for " + request_.file.string());
    }
    out_.diagnostics = faults_.take();
    return std::move(out_);
  }

 private:
  /// The space that the file declares; empty if it declares none.
  std::string declared_space(const image::MapHeader& header) {
    if (!header.color_interop_id.empty()) return header.color_interop_id;
    if (header.chromaticities) {
      if (const display::KnownSpace* known = display::known_space(*header.chromaticities)) return known->interop_id;
      faults_.warning(request_.file_key, "its chromaticities match no known colour space and are ignored");
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
        display::PixelConversion convert = display::pixel_conversion(request_.options.ocio_config, declared, working);
        const display::KnownSpace* const known = display::known_space(declared);
        if (!chosen.empty() && chosen != declared && (known == nullptr || known != display::known_space(chosen)))
          faults_.warning(request_.space_key, fmt::format("is ignored: {} declares the colour space `{}`",
                                                          request_.file.filename().string(), declared));
        return convert;
      } catch (const base::Error& error) {
        if (error.kind() != base::ErrorKind::kUsage) throw;
        faults_.warning(request_.file_key,
                        fmt::format("declares a colour space that cannot be used: {}", error.what()));
      }
    }
    out_.color_space = !chosen.empty() ? chosen : header.is_encoded ? kEncodedSpace : request_.default_space;
    try {
      return display::pixel_conversion(request_.options.ocio_config, out_.color_space, working);
    } catch (const base::Error& error) {
      faults_.error(chosen.empty() ? request_.file_key : request_.space_key, error);
      return {};
    }
  }

  bool fits() {
    const std::uint64_t allowed = request_.options.memory_limit > 0 ? request_.options.memory_limit
                                                                    : base::available_memory().value_or(out_.bytes);
    if (out_.bytes <= allowed) return true;
    const std::string text = fmt::format(
        "an image of {} x {} texels needs about {}, and {}", out_.width, out_.height, base::bytes_text(out_.bytes),
        request_.options.memory_limit > 0 ? "--memory-limit allows " + base::bytes_text(allowed)
                                          : base::bytes_text(allowed) + " is free");
    if (!request_.options.skips_large)
      throw base::Error(base::ErrorKind::kNoMemory, fmt::format("{}: {}", request_.file.string(), text));
    faults_.warning(request_.file_key, text + "; its pixels were not read");
    return false;
  }

  void read(const image::MapHeader& header, const display::PixelConversion& convert) {
    const auto image = std::make_shared<scene::LatLongMap>(header.width, header.height);
    const std::size_t values = 3 * static_cast<std::size_t>(header.width);
    // An infinite sun is one that did not fit into the file.
    const float largest = header.is_half ? std::min(kLargestHalf, request_.largest) : request_.largest;
    std::uint64_t nan = 0, infinite = 0, negative = 0, out_of_range = 0;  // values that are replaced
    const auto take = [&](int y, float* rgb) {
      for (std::size_t i = 0; i < values; ++i) {
        if (rgb[i] >= 0 && std::isfinite(rgb[i])) continue;
        const bool is_infinite = rgb[i] > 0;
        ++(std::isnan(rgb[i]) ? nan : is_infinite ? infinite : negative);
        rgb[i] = is_infinite ? largest : 0;
      }
      if (convert) convert(rgb, values / 3);
      float* const row = image->row(y);
      for (std::size_t i = 0; i < values; ++i) {
        const bool is_good = rgb[i] >= 0 && std::isfinite(rgb[i]);
        if (!is_good || rgb[i] > request_.largest * kRoundingFactor) ++out_of_range;
        row[i] = is_good ? std::min(rgb[i], request_.largest) : 0.0F;
        out_.brightest = std::max(out_.brightest, row[i]);
      }
    };
    image::read_map(request_.file, take, request_.formats);
    if (request_.has_mip_map) compile::add_mip_map(*image);
    out_.image = image;
    if (nan + negative > 0)
      faults_.warning(request_.file_key,
                      fmt::format("{} values are NaN and {} negative; they are replaced by 0", nan, negative));
    if (infinite > 0)
      faults_.warning(
          request_.file_key,
          fmt::format("{} values are infinite; they are replaced by {}{}", infinite, static_cast<double>(largest),
                      header.is_half ? "; write brighter values in single precision" : ""));
    if (out_of_range > 0)
      faults_.warning(request_.file_key, fmt::format("{} values are out of range{} and were clamped", out_of_range,
                                                     request_.is_color ? " in " + request_.working_space : ""));
  }

  const MapRequest& request_;
  scene::KeyFaults faults_;
  LoadedMap out_;
};

/// `key`      of the table with the keys `file` and `color_space`
MapRequest map_request(const ImageRequest& request, const scene::Scene& scene, const std::string& key,
                       const std::filesystem::path& name, const std::string& color_space) {
  MapRequest out;
  out.file = request.folder / name;
  out.file_key = key + ".file";
  out.space_key = key + ".color_space";
  out.color_space = color_space;
  out.default_space = scene.color.space;
  out.working_space = scene.color.working_space();
  out.options = request;
  return out;
}

compile::EnvironmentSampling sampling_of(const scene::Scene& scene) {
  return scene.render.direct_lighting == scene::DirectLighting::kBsdf ? compile::EnvironmentSampling::kNone
                                                                      : compile::EnvironmentSampling::kComplete;
}

MapRequest background_request(const ImageRequest& request, const scene::Scene& scene) {
  MapRequest out = map_request(request, scene, "background", scene.background.file, scene.background.color_space);
  out.sampling = sampling_of(scene);
  return out;
}

MapRequest texture_request(const ImageRequest& request, const scene::Scene& scene, const scene::NamedTexture& named) {
  MapRequest out = map_request(request, scene, named.key, named.texture->file, named.texture->color_space);
  out.formats = image::MapFormats::kAll;
  out.is_color = named.use != scene::TextureUse::kNumber;
  if (named.use != scene::TextureUse::kRadiance) out.largest = 1;
  out.has_mip_map = named.texture->filter == scene::TextureFilter::kMip;
  return out;
}

LoadedMap load_map(const MapRequest& request) {
  std::string version = request.version();
  LoadedMap out = MapLoader(request).load();
  out.version = std::move(version);
  return out;
}

/// The texture with this version; null if there is none.
const LoadedTexture* find(const std::vector<LoadedTexture>& textures, const std::string& version) {
  for (const LoadedTexture& texture : textures)
    if (texture.map.version == version && texture.map.image) return &texture;
  return nullptr;
}

}  // namespace

std::uint64_t rest_of(std::uint64_t limit, std::uint64_t used) {
  return limit == 0 ? 0 : std::max<std::uint64_t>(limit - std::min(used, limit), 1);
}

LoadedMap load_background(const ImageRequest& request, const scene::Scene& scene) {
  return load_map(background_request(request, scene));
}

std::string background_version(const ImageRequest& request, const scene::Scene& scene) {
  return background_request(request, scene).version();
}

LoadedMap load_sky(const std::string& ocio_config, const scene::Scene& scene) {
  LoadedMap out;
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
  const math::Vec3d albedo = display::converted(to_sky, background.ground_albedo);
  background.ground_albedo = math::least(math::greatest(albedo, {}), math::Vec3d{1, 1, 1});
  const auto image = std::make_shared<scene::LatLongMap>(sky::bake_sky(background));
  if (to_working) {
    const auto width = static_cast<std::size_t>(image->width());
    for (int y = 0; y < image->height(); ++y) {
      float* const row = image->row(y);
      to_working(row, width);
      for (std::size_t i = 0; i < 3 * width; ++i) row[i] = std::max(row[i], 0.0F);
    }
    image->sun.radiance = math::greatest(display::converted(to_working, image->sun.radiance), {});
  }
  const math::Vec3d sun = image->sun.radiance;
  out.brightest = static_cast<float>(std::max({sun.x, sun.y, sun.z}));
  for (int y = 0; y < image->height(); ++y)
    out.brightest = std::max(out.brightest, *std::max_element(image->row(y), image->row(y) + 3 * image->width()));
  out.width = image->width();
  out.height = image->height();
  out.bytes = compile::environment_bytes(out.width, out.height, sampling_of(scene));
  out.image = image;
  return out;
}

std::vector<LoadedTexture> load_textures(const ImageRequest& request, const std::vector<LoadedTexture>& known,
                                         const scene::Scene& scene) {
  std::vector<LoadedTexture> out;
  std::uint64_t bytes = 0;
  for (const scene::NamedTexture& named : scene::image_textures(scene)) {
    if (named.texture->file.empty()) {
      out.push_back({named.key, {}, true});
      out.back().map.diagnostics.push_back(
          {base::Severity::kError, named.key + ".file", "texture \"image\" needs an image file"});
      continue;
    }
    MapRequest wanted = texture_request(request, scene, named);
    const std::string version = wanted.version();
    if (const LoadedTexture* same = find(out, version)) {
      out.push_back({named.key, LoadedMap(same->map), true});
      out.back().map.diagnostics.clear();  // reported at the first
      continue;
    }
    if (const LoadedTexture* same = find(known, version)) {
      out.push_back({named.key, same->map, false});
    } else {
      wanted.options.memory_limit = rest_of(request.memory_limit, bytes);
      out.push_back({named.key, load_map(wanted), false});
    }
    if (out.back().map.image) bytes += out.back().map.bytes;
  }
  return out;
}

void set_textures(const std::vector<LoadedTexture>& loaded, scene::Scene& scene) {
  std::size_t next = 0;
  scene::modify_textures(scene, [&](scene::Texture& texture, scene::TextureUse) {
    if (texture.type == scene::TextureType::kImage) texture.image = loaded.at(next++).map.image;
  });
}

}  // namespace orrery::load
