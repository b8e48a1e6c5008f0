// SPDX-License-Identifier: Apache-2.0
#include "image/damage.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <fstream>
#include <string_view>
#include <vector>

namespace orrery::image {
namespace {

constexpr const char* kTruncated = "the file is truncated";

/// Reads bytes; false at the end of the file.
bool get(std::istream& in, char* to, std::size_t count) {
  return static_cast<bool>(in.read(to, static_cast<std::streamsize>(count)));
}

std::uint32_t big_endian(const char* bytes) {
  std::uint32_t out = 0;
  for (int i = 0; i < 4; ++i) out = out << 8 | static_cast<unsigned char>(bytes[i]);
  return out;
}

/// A PNG file is a signature and chunks: length, name, data, checksum of name and data. The last one is IEND.
std::string damage_of_png(std::istream& in) {
  constexpr std::string_view kSignature("\x89PNG\r\n\x1a\n", 8);
  std::array<char, 8> head{};
  const bool is_complete = get(in, head.data(), head.size());
  if (!kSignature.starts_with({head.data(), static_cast<std::size_t>(in.gcount())})) return {};
  if (!is_complete) return kTruncated;
  std::vector<char> data(std::size_t{1} << 16);
  const auto update = [](uLong sum, const char* bytes, std::size_t count) {
    return crc32(sum, reinterpret_cast<const Bytef*>(bytes), static_cast<uInt>(count));
  };
  for (;;) {
    if (!get(in, head.data(), head.size())) return kTruncated;
    const std::string_view name(head.data() + 4, 4);
    uLong sum = update(crc32(0, nullptr, 0), name.data(), name.size());
    for (std::size_t left = big_endian(head.data()); left > 0;) {
      const std::size_t count = std::min(left, data.size());
      if (!get(in, data.data(), count)) return kTruncated;
      sum = update(sum, data.data(), count);
      left -= count;
    }
    std::array<char, 4> stored{};
    if (!get(in, stored.data(), stored.size())) return kTruncated;
    // libpng leaves out chunks that are not needed to decode the image; their names begin with a small letter.
    const bool is_needed = std::isupper(static_cast<unsigned char>(name[0])) != 0;
    if (is_needed && sum != big_endian(stored.data())) return "the file is damaged: a checksum does not match";
    if (name == "IEND") return {};
  }
}

/// In a truncated JPEG file, no end marker follows the last scan.
std::string damage_of_jpeg(std::istream& in) {
  if (in.get() != 0xFF || in.get() != 0xD8) return {};
  bool in_scan = false, is_closed = false;
  for (int before = 0, now = in.get(); now != std::istream::traits_type::eof(); before = now, now = in.get()) {
    if (before != 0xFF) continue;
    if (now == 0xDA) in_scan = true, is_closed = false;
    if (now == 0xD9 && in_scan) is_closed = true;
  }
  return is_closed ? "" : kTruncated;
}

}  // namespace

std::string damage_of(const std::filesystem::path& file, Format format) {
  if (format != Format::kPng && format != Format::kJpeg) return {};
  std::ifstream in(file, std::ios::binary);
  if (!in) return {};
  return format == Format::kPng ? damage_of_png(in) : damage_of_jpeg(in);
}

}  // namespace orrery::image
