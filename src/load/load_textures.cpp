// SPDX-License-Identifier: Apache-2.0
#include "load/load_textures.h"

#include <algorithm>
#include <utility>

#include <fmt/core.h>

#include "base/input_file.h"
#include "image/read.h"
#include "load/load_map.h"
#include "scene/scene.h"
#include "scene/texture.h"

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

std::string version_of(const MapRequest& request) {
  return fmt::format("{}\n{}\n{}\n{}\n{}\n{} {} {}", base::file_version(request.file), request.ocio_config,
                     request.color_space, request.default_space, request.working_space, request.is_color,
                     request.largest, request.has_mip_map);
}

/// The texture with this version; null if there is none.
const LoadedTexture* find(const std::vector<LoadedTexture>& textures, const std::string& version) {
  for (const LoadedTexture& texture : textures)
    if (texture.map.version == version && texture.map.image) return &texture;
  return nullptr;
}

}  // namespace

std::vector<LoadedTexture> load_textures(const fs::path& scene_file, const std::string& ocio_config,
                                         std::uint64_t memory_limit, bool skips_large,
                                         const std::vector<LoadedTexture>& known, const scene::Scene& scene) {
  std::vector<LoadedTexture> out;
  std::uint64_t bytes = 0;
  for (const scene::NamedTexture& named : scene::image_textures(scene)) {
    if (named.texture->file.empty()) {
      out.push_back({named.key, {}, true});
      out.back().map.diagnostics.push_back(
          {base::Severity::kError, named.key + ".file", "texture \"image\" needs an image file"});
      continue;
    }
    MapRequest request = request_of(named, scene_file.parent_path(), ocio_config, scene);
    const std::string version = version_of(request);
    if (const LoadedTexture* same = find(out, version)) {
      out.push_back({named.key, LoadedMap(same->map), true});
      out.back().map.diagnostics.clear();  // reported at the first
      continue;
    }
    if (const LoadedTexture* same = find(known, version)) {
      out.push_back({named.key, same->map, false});
    } else {
      if (memory_limit > 0)
        request.memory_limit = std::max<std::uint64_t>(memory_limit - std::min(bytes, memory_limit), 1);
      request.skips_large = skips_large;
      out.push_back({named.key, load_map(request), false});
      out.back().map.version = version;
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
