// SPDX-License-Identifier: Apache-2.0
#include "job/matte_manifest.h"

#include <nlohmann/json.hpp>

#include <fmt/core.h>

#include "base/atomic_file.h"
#include "base/file_name.h"
#include "film/cryptomatte.h"
#include "image/format.h"
#include "job/layers.h"
#include "job/outputs.h"

namespace orrery::job {
namespace {

/// {"name":"13851a76",...}, in scene order. Written directly, since the JSON library's ordered object searches all
/// names on every insertion.
std::string manifest(const MatteNames& matte) {
  std::string out = "{";
  for (const auto& [name, id] : matte.things) {
    if (out.size() > 1) out += ',';
    out += fmt::format("{}:\"{}\"", nlohmann::json(name).dump(), film::matte_id_text(id));
  }
  return out + '}';
}

bool is_large(const MatteNames& matte) { return matte.things.size() > kMaxNamesInHeader; }

std::filesystem::path manifest_file(const std::string& layer, const std::filesystem::path& picture) {
  return picture.parent_path() / base::companion_name(picture.stem().string(), fmt::format(".{}.json", layer));
}

}  // namespace

std::vector<image::Attribute> matte_attributes(const std::vector<MatteNames>& mattes,
                                               const std::filesystem::path& picture) {
  std::vector<image::Attribute> out;
  for (const MatteNames& matte : mattes) {
    const std::string key =
        fmt::format("cryptomatte/{}/", film::matte_id_text(film::matte_id(matte.layer)).substr(0, 7));
    out.push_back({key + "name", matte.layer});
    out.push_back({key + "hash", std::string("MurmurHash3_32")});
    out.push_back({key + "conversion", std::string("uint32_to_float32")});
    if (is_large(matte)) {
      out.push_back({key + "manif_file", manifest_file(matte.layer, picture).filename().string()});
    } else {
      out.push_back({key + "manifest", manifest(matte)});
    }
  }
  return out;
}

std::vector<std::filesystem::path> manifest_files(const std::vector<MatteNames>& mattes, const Outputs& outputs) {
  std::vector<std::filesystem::path> files;
  for (const auto& [picture, format] : outputs.images)
    for (const MatteNames& matte : mattes)
      if (is_large(matte) && format == image::Format::kExr) files.push_back(manifest_file(matte.layer, picture));
  return files;
}

std::vector<std::filesystem::path> possible_manifest_files(const Outputs& outputs) {
  std::vector<std::filesystem::path> files;
  for (const auto& [picture, format] : outputs.images)
    if (format == image::Format::kExr)
      for (const char* layer : kMatteLayers) files.push_back(manifest_file(layer, picture));
  return files;
}

void write_manifests(const std::vector<MatteNames>& mattes, const std::filesystem::path& picture) {
  for (const MatteNames& matte : mattes)
    if (is_large(matte)) base::write_text_file(manifest_file(matte.layer, picture), manifest(matte));
}

}  // namespace orrery::job
