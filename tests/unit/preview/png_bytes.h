// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

#include "preview/file_sink.h"

namespace orrery::preview {

/// Decodes an uncompressed 8-bit RGB PNG and checks every checksum, bit by bit.
inline Bitmap decoded_png(const std::string& bytes) {
  const auto require = [](bool holds, const char* what) {
    if (!holds) throw std::runtime_error(what);
  };
  const auto byte = [&](const std::string& text, std::size_t i) {
    return static_cast<std::uint32_t>(static_cast<unsigned char>(text.at(i)));
  };
  const auto big = [&](const std::string& text, std::size_t i) {
    return byte(text, i) << 24 | byte(text, i + 1) << 16 | byte(text, i + 2) << 8 | byte(text, i + 3);
  };
  require(bytes.substr(0, 8) == "\x89PNG\r\n\x1a\n", "signature");
  std::string header, stream, type;
  std::size_t at = 8;
  while (type != "IEND") {
    const std::uint32_t length = big(bytes, at);
    type = bytes.substr(at + 4, 4);
    std::uint32_t crc = ~0u;
    for (std::size_t i = 0; i < length + 4; ++i) {
      crc ^= byte(bytes, at + 4 + i);
      for (int bit = 0; bit < 8; ++bit) crc = (crc & 1) != 0 ? crc >> 1 ^ 0xedb88320u : crc >> 1;
    }
    require(~crc == big(bytes, at + 8 + length), "CRC");
    if (type == "IHDR") header = bytes.substr(at + 8, length);
    if (type == "IDAT") stream += bytes.substr(at + 8, length);
    at += 12 + length;
  }
  require(at == bytes.size(), "bytes after the end");
  require(header.substr(8) == std::string("\x08\x02\0\0\0", 5), "format");
  require((byte(stream, 0) * 256 + byte(stream, 1)) % 31 == 0 && byte(stream, 0) == 0x78, "zlib header");
  std::string rows;
  at = 2;
  for (bool last = false; !last;) {
    last = byte(stream, at) == 1;
    const std::size_t length = byte(stream, at + 1) | byte(stream, at + 2) << 8;
    require((length ^ (byte(stream, at + 3) | byte(stream, at + 4) << 8)) == 0xffff, "length of a block");
    rows += stream.substr(at + 5, length);
    at += 5 + length;
  }
  std::uint32_t a = 1, b = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    a = (a + byte(rows, i)) % 65521;
    b = (b + a) % 65521;
  }
  require(big(stream, at) == (b << 16 | a) && at + 4 == stream.size(), "Adler-32");
  Bitmap out{static_cast<int>(big(header, 0)), static_cast<int>(big(header, 4)), {}};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (i % (out.row_bytes() + 1) == 0) {
      require(rows[i] == 0, "filter");
    } else {
      out.codes.push_back(static_cast<std::uint8_t>(rows[i]));
    }
  }
  return out;
}

}  // namespace orrery::preview
