// SPDX-License-Identifier: Apache-2.0
#include "base/file_name.h"

#include <cstdint>

#include <fmt/core.h>

#include "base/text.h"

namespace orrery::base {
namespace {

/// Returns the 32-bit FNV-1a hash of a text.
///
/// Reference  fnv
std::uint32_t digest(std::string_view text) {
  std::uint32_t hash = 0x811c9dc5u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x01000193u;
  return hash;
}

}  // namespace

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
    constexpr std::size_t kDigest = 9;  // a dot, eight digits
    out = utf8_prefix(stem, kLongestFileName - suffix.size() - kDigest);
    out += fmt::format(".{:08x}", digest(stem));
  }
  return out.append(suffix);
}

}  // namespace orrery::base
