// SPDX-License-Identifier: Apache-2.0
#include "preview/file_sink.h"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/output_file.h"
#include "display/develop.h"
#include "display/picture_info.h"
#include "preview/canvas.h"

namespace orrery::preview {

FileSink::FileSink(std::filesystem::path file) : file_(std::move(file)) {}
FileSink::~FileSink() = default;

void FileSink::begin(const display::PictureInfo& picture, const Canvas& canvas) {
  canvas_ = &canvas;
  develop_ = std::make_unique<display::PixelDeveloper>(picture.display);
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
