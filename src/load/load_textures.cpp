// SPDX-License-Identifier: Apache-2.0
#include "load/load_textures.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include <fmt/core.h>

#include "image/read_map.h"
#include "load/load_map.h"
#include "scene/scene.h"
#include "scene/textures.h"

namespace orrery::load {
namespace {

namespace fs = std::filesystem;

MapRequest request_of(const scene::NamedTexture& named, const fs::path& folder, const std::string& ocio_config,
                      const scene::Scene& scene) {
  MapRequest out;
  out.file = folder / named.texture->file;
  out.file_key = named.key + ".file";
  out.space_key = named.key + ".color_space";
  out.formats = image::MapFormats::kAll;
  out.color_space = named.texture->color_space;
  out.default_space = scene.color.space;
  out.working_space = scene.color.working_space();
  out.is_color = named.use != scene::TextureUse::kNumber;
  if (named.use != scene::TextureUse::kRadiance) out.largest = 1;
  out.ocio_config = ocio_config;
  out.has_mip_map = named.texture->filter == scene::TextureFilter::kMip;
  return out;
}

/// Identifies a version of the file and the conversion.
std::string name_of(const MapRequest& request) {
  std::error_code size_error, time_error;
  const std::uintmax_t size = fs::file_size(request.file, size_error);
  const fs::file_time_type time = fs::last_write_time(request.file, time_error);
  const bool is_known = !size_error && !time_error;
  return fmt::format("{}\n{} {}\n{}\n{}\n{}\n{}\n{} {} {}", fs::absolute(request.file).string(), is_known ? size : 0,
                     is_known ? time.time_since_epoch().count() : 0, request.ocio_config, request.color_space,
                     request.default_space, request.working_space, request.is_color, request.largest,
                     request.has_mip_map);
}

}  // namespace

std::vector<LoadedTexture> load_textures(const fs::path& scene_file, const std::string& ocio_config,
                                         std::uint64_t memory_limit, bool skips_large, TextureCache* cache,
                                         const scene::Scene& scene) {
  std::vector<LoadedTexture> out;
  std::map<std::string, LoadedMap> maps;
  std::uint64_t bytes = 0;
  for (const scene::NamedTexture& named : scene::image_textures(scene)) {
    if (named.texture->file.empty()) {
      out.push_back({named.key, {}, true});
      out.back().map.diagnostics.push_back(
          {base::Severity::kError, named.key + ".file", "texture \"image\" needs an image file"});
      continue;
    }
    MapRequest request = request_of(named, scene_file.parent_path(), ocio_config, scene);
    const std::string name = name_of(request);
    if (const auto same = maps.find(name); same != maps.end()) {
      out.push_back({named.key, same->second, true});
      out.back().map.diagnostics.clear();  // reported at the first
      continue;
    }
    if (cache != nullptr && cache->maps.count(name) != 0) {
      out.push_back({named.key, cache->maps.at(name), false});
    } else {
      if (memory_limit > 0)
        request.memory_limit = std::max<std::uint64_t>(memory_limit - std::min(bytes, memory_limit), 1);
      request.skips_large = skips_large;
      out.push_back({named.key, load_map(request), false});
    }
    if (out.back().map.image) {
      bytes += out.back().map.bytes;
      maps.emplace(name, out.back().map);
    }
  }
  if (cache != nullptr) cache->maps = std::move(maps);
  return out;
}

void set_textures(const std::vector<LoadedTexture>& loaded, scene::Scene& scene) {
  std::size_t next = 0;
  scene::modify_textures(scene, [&](scene::Texture& texture, scene::TextureUse) {
    if (texture.type == scene::TextureType::kImage) texture.image = loaded.at(next++).map.image;
  });
}

}  // namespace orrery::load
