// SPDX-License-Identifier: Apache-2.0
#include "base/file_name.h"

#include "base/hash.h"
#include "base/text.h"

namespace orrery::base {

std::filesystem::path folder_of(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : ".";
}

std::string extension(const std::filesystem::path& file) { return lower(file.extension().string()); }

std::string_view utf8_prefix(std::string_view text, std::size_t bytes) {
  if (text.size() <= bytes) return text;
  while (bytes > 0 && continues_character(text[bytes])) --bytes;
  return text.substr(0, bytes);
}

std::string companion_name(std::string_view stem, std::string_view suffix) {
  std::string out(stem);
  if (stem.size() + suffix.size() > kLongestFileName) {
    const std::string digest = "." + text_hash(stem);
    out = utf8_prefix(stem, kLongestFileName - suffix.size() - digest.size());
    out += digest;
  }
  return out.append(suffix);
}

}  // namespace orrery::base
