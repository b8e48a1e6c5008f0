// SPDX-License-Identifier: Apache-2.0
#include "load/file_settings.h"

#include <variant>

#include "scene/schema.h"
#include "scene/texture.h"

namespace orrery::load {
namespace {

std::string last_part(const std::string& key) { return key.substr(key.rfind('.') + 1); }

/// "file", "config", "map": the last parts of all keys whose values may be names of files.
std::set<std::string> last_parts_of_file_keys() {
  std::set<std::string> out;
  const auto add = [&out](const auto& keys) {
    for (const auto& key : keys)
      if (key.file != nullptr) out.insert(last_part(key.name));
  };
  for (const scene::Table& table : scene::tables()) add(table.keys);
  for (const scene::TextureUse use :
       {scene::TextureUse::kReflectance, scene::TextureUse::kRadiance, scene::TextureUse::kNumber})
    for (const auto& type : scene::texture_types(use)) add(type.keys);
  add(scene::points_keys());
  add(scene::rod_file_keys());
  return out;
}

}  // namespace

std::set<std::string> named_files(const Overrides& overrides) {
  static const std::set<std::string> file_keys = last_parts_of_file_keys();
  std::set<std::string> out;
  for (const KeyValue& set : overrides.values()) {
    const bool is_file = file_keys.count(last_part(set.key)) > 0;
    const bool may_hold_files =
        std::holds_alternative<std::monostate>(set.value) && set.text.find('{') != std::string::npos;
    if (is_file || may_hold_files) out.insert(set.text);
  }
  return out;
}

}  // namespace orrery::load
