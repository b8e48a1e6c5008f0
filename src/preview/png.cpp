// SPDX-License-Identifier: Apache-2.0
#include "preview/png.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace orrery::preview {
namespace {

/// Largest stored block of deflate, bytes.
constexpr std::size_t kLargestBlock = 65535;

/// Bytes of an IDAT chunk; the format allows 2^31 - 1.
constexpr std::size_t kChunkBytes = std::size_t{1} << 24;

constexpr std::uint32_t kCrcPolynomial = 0xedb88320u;
constexpr std::size_t kCrcBytes = 8;  // processed at a time

/// Table k advances a byte by k further bytes, so that eight bytes need eight independent look-ups.
constexpr std::array<std::array<std::uint32_t, 256>, kCrcBytes> make_crc_tables() {
  std::array<std::array<std::uint32_t, 256>, kCrcBytes> tables{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t c = i;
    for (int bit = 0; bit < 8; ++bit) c = (c >> 1) ^ ((c & 1) != 0 ? kCrcPolynomial : 0);
    tables[0][i] = c;
  }
  for (std::size_t k = 1; k < kCrcBytes; ++k)
    for (std::size_t i = 0; i < 256; ++i) tables[k][i] = (tables[k - 1][i] >> 8) ^ tables[0][tables[k - 1][i] & 0xff];
  return tables;
}
constexpr auto kCrcTables = make_crc_tables();

std::uint32_t crc(std::string_view bytes) {
  std::uint32_t c = 0xffffffffu;
  const auto byte = [&](std::size_t i) { return static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i])); };
  std::size_t i = 0;
  for (; i + kCrcBytes <= bytes.size(); i += kCrcBytes) {
    std::uint32_t next = 0;
    for (std::size_t k = 0; k < kCrcBytes; ++k) {
      const std::uint32_t mixed = k < 4 ? (byte(i + k) ^ (c >> (8 * k))) & 0xff : byte(i + k);
      next ^= kCrcTables[kCrcBytes - 1 - k][mixed];
    }
    c = next;
  }
  for (; i < bytes.size(); ++i) c = (c >> 8) ^ kCrcTables[0][(c ^ byte(i)) & 0xff];
  return ~c;
}

std::uint32_t adler(std::string_view bytes) {
  constexpr std::uint32_t kModulus = 65521;
  constexpr std::size_t kWithoutOverflow = 5552;  // bytes before the sums must be reduced
  std::uint32_t a = 1, b = 0;
  while (!bytes.empty()) {
    const std::size_t count = std::min(bytes.size(), kWithoutOverflow);
    for (std::size_t i = 0; i < count; ++i) {
      a += static_cast<unsigned char>(bytes[i]);
      b += a;
    }
    a %= kModulus;
    b %= kModulus;
    bytes.remove_prefix(count);
  }
  return b << 16 | a;
}

void add_big_endian(std::string& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(value >> shift & 0xff);
}

void add_chunk(std::string& out, std::string_view type, std::string_view data) {
  add_big_endian(out, static_cast<std::uint32_t>(data.size()));
  const std::size_t begin = out.size();
  out += type;
  out += data;
  add_big_endian(out, crc(std::string_view(out).substr(begin)));
}

/// A zlib stream of stored blocks.
std::string stored(std::string_view bytes) {
  std::string out = "\x78\x01";
  out.reserve(bytes.size() + bytes.size() / kLargestBlock * 5 + 16);
  const std::uint32_t sum = adler(bytes);
  do {
    const std::size_t count = std::min(bytes.size(), kLargestBlock);
    const auto length = static_cast<std::uint32_t>(count);
    out += static_cast<char>(count == bytes.size() ? 1 : 0);  // 1: the last block
    for (const std::uint32_t word : {length, ~length}) {
      out += static_cast<char>(word & 0xff);
      out += static_cast<char>(word >> 8 & 0xff);
    }
    out += bytes.substr(0, count);
    bytes.remove_prefix(count);
  } while (!bytes.empty());
  add_big_endian(out, sum);
  return out;
}

}  // namespace

std::string encode_png(const Bitmap& bitmap) {
  std::string header;
  add_big_endian(header, static_cast<std::uint32_t>(bitmap.width));
  add_big_endian(header, static_cast<std::uint32_t>(bitmap.height));
  header += std::string("\x08\x02\x00\x00\x00", 5);  // 8 bits, R G B, deflate, filters, not interlaced
  std::string rows;
  rows.reserve((bitmap.row_bytes() + 1) * static_cast<std::size_t>(bitmap.height));
  for (int y = 0; y < bitmap.height; ++y) {
    rows += '\0';  // no filter
    rows.append(reinterpret_cast<const char*>(bitmap.row(y)), bitmap.row_bytes());
  }
  std::string out = "\x89PNG\r\n\x1a\n";
  add_chunk(out, "IHDR", header);
  const std::string stream = stored(rows);
  for (std::size_t at = 0; at < stream.size(); at += kChunkBytes)
    add_chunk(out, "IDAT", std::string_view(stream).substr(at, kChunkBytes));
  add_chunk(out, "IEND", {});
  return out;
}

}  // namespace orrery::preview
