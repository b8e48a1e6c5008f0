// SPDX-License-Identifier: Apache-2.0
#include "preview/file_sink.h"

#include <algorithm>
#include <cstddef>

#include "base/atomic_file.h"
#include "display/settings.h"
#include "image/write.h"

namespace orrery::preview {

void FileSink::begin(const display::PictureInfo& picture, const Canvas& canvas) {
  canvas_ = &canvas;
  develop_.emplace(picture.display);
  picture_.width = canvas.width();
  picture_.height = canvas.height();
  picture_.values.assign(row_size() * static_cast<std::size_t>(picture_.height), 0);
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
      std::copy_n(
          &codes[static_cast<std::size_t>(y) * row], row,
          &picture_.values[static_cast<std::size_t>(cell.y + y) * row_size() + 3 * static_cast<std::size_t>(cell.x)]);
  }
  base::write_text_file(file_, image::png_bytes(picture_, image::kUncompressed), false);
}

}  // namespace orrery::preview
