// SPDX-License-Identifier: Apache-2.0
#include "preview/file_sink.h"

#include <algorithm>
#include <cstddef>
#include <string_view>

#include <zlib.h>

#include "base/atomic_file.h"
#include "display/settings.h"

namespace orrery::preview {

namespace {

/// Bytes of an IDAT chunk; the format allows 2^31 - 1.
constexpr std::size_t kChunkBytes = std::size_t{1} << 24;

void add_big_endian(std::string& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(value >> shift & 0xff);
}

void add_chunk(std::string& out, std::string_view type, std::string_view data) {
  add_big_endian(out, static_cast<std::uint32_t>(data.size()));
  const std::size_t begin = out.size();
  out += type;
  out += data;
  add_big_endian(
      out, static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(&out[begin]), out.size() - begin)));
}

/// A zlib stream that is not compressed: the file is soon replaced.
std::string stored(std::string_view bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string out(size, '\0');
  compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
            static_cast<uLong>(bytes.size()), Z_NO_COMPRESSION);  // cannot fail with this much space
  out.resize(size);
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

void FileSink::begin(const display::PictureInfo& picture, const Canvas& canvas) {
  canvas_ = &canvas;
  develop_.emplace(picture.display);
  bitmap_.width = canvas.width();
  bitmap_.height = canvas.height();
  bitmap_.codes.assign(bitmap_.row_bytes() * static_cast<std::size_t>(bitmap_.height), 0);
}

void FileSink::update(const std::vector<std::size_t>& cells) {
  std::vector<float> rgb(3 * static_cast<std::size_t>(Canvas::kSide) * static_cast<std::size_t>(Canvas::kSide));
  std::vector<std::uint8_t> codes(rgb.size());
  for (const std::size_t index : cells) {
    const Cell cell = canvas_->cell(index);
    const auto row = 3 * static_cast<std::size_t>(cell.width);
    for (int y = 0; y < cell.height; ++y)
      canvas_->read(cell.x, cell.y + y, cell.width, &rgb[static_cast<std::size_t>(y) * row]);
    (*develop_)(rgb.data(), static_cast<std::size_t>(cell.width) * static_cast<std::size_t>(cell.height), codes.data());
    for (int y = 0; y < cell.height; ++y)
      std::copy_n(&codes[static_cast<std::size_t>(y) * row], row,
                  &bitmap_.codes[static_cast<std::size_t>(cell.y + y) * bitmap_.row_bytes() +
                                 3 * static_cast<std::size_t>(cell.x)]);
  }
  base::write_text_file(file_, encode_png(bitmap_), false);
}

}  // namespace orrery::preview
