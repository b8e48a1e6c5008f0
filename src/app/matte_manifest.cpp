// SPDX-License-Identifier: Apache-2.0
#include "app/matte_manifest.h"

#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "film/cryptomatte.h"

namespace orrery::app {
namespace {

/// {"name": "13851a76", ...}, in the order of the scene file.
std::string manifest(const MatteNames& matte) {
  nlohmann::ordered_json out = nlohmann::ordered_json::object();
  for (const auto& [name, id] : matte.things) out[name] = film::matte_id_text(id);
  return out.dump();
}

bool is_large(const MatteNames& matte) { return matte.things.size() > kMostNamesInHeader; }

std::filesystem::path manifest_file(const MatteNames& matte, const std::filesystem::path& picture) {
  return picture.parent_path() / (picture.stem().string() + "." + matte.layer + ".json");
}

}  // namespace

std::vector<image::Attribute> matte_attributes(const std::vector<MatteNames>& mattes,
                                               const std::filesystem::path& picture) {
  std::vector<image::Attribute> out;
  for (const MatteNames& matte : mattes) {
    const std::string key = "cryptomatte/" + film::matte_id_text(film::matte_id(matte.layer)).substr(0, 7) + "/";
    out.push_back({key + "name", matte.layer});
    out.push_back({key + "hash", std::string("MurmurHash3_32")});
    out.push_back({key + "conversion", std::string("uint32_to_float32")});
    if (is_large(matte)) {
      out.push_back({key + "manif_file", manifest_file(matte, picture).filename().string()});
    } else {
      out.push_back({key + "manifest", manifest(matte)});
    }
  }
  return out;
}

void write_manifests(const std::vector<MatteNames>& mattes, const std::filesystem::path& picture) {
  for (const MatteNames& matte : mattes)
    if (is_large(matte)) base::write_text_file(manifest_file(matte, picture), manifest(matte));
}

}  // namespace orrery::app
