// SPDX-License-Identifier: Apache-2.0
#include "preview/file_sink.h"

#include <algorithm>
#include <cstddef>

#include "base/atomic_file.h"
#include "display/settings.h"
#include "image/write.h"
#include "math/pixels.h"

namespace orrery::preview {

void FileSink::begin(const display::PictureInfo& picture, const Canvas& canvas) {
  canvas_ = &canvas;
  develop_.emplace(picture.display);
  picture_.width = canvas.width();
  picture_.height = canvas.height();
  picture_.values.assign(3 * math::pixel_count(picture_.width, picture_.height), 0);
}

void FileSink::update(const std::vector<std::size_t>& cells) {
  std::vector<float> rgb(3 * math::pixel_count(Canvas::kSide, Canvas::kSide));
  std::vector<std::uint8_t> codes(rgb.size());
  for (const std::size_t index : cells) {
    const Cell cell = canvas_->cell(index);
    const auto row = [&](int y) { return 3 * math::pixel_index(0, y, cell.width); };
    for (int y = 0; y < cell.height; ++y) canvas_->read(cell.x, cell.y + y, cell.width, &rgb[row(y)]);
    (*develop_)(rgb.data(), math::pixel_count(cell.width, cell.height), codes.data());
    for (int y = 0; y < cell.height; ++y)
      std::copy_n(&codes[row(y)], row(1), &picture_.values[3 * math::pixel_index(cell.x, cell.y + y, picture_.width)]);
  }
  base::write_text_file(file_, image::png_bytes(picture_, image::kUncompressed), false);
}

}  // namespace orrery::preview
