// SPDX-License-Identifier: Apache-2.0
#include "preview/terminal_sink.h"

#include <utility>

#include "display/develop.h"
#include "preview/canvas.h"
#include "preview/fit.h"
#include "preview/png.h"

namespace orrery::preview {

TerminalSink::TerminalSink(Screen& screen) : screen_(screen) {}
TerminalSink::~TerminalSink() = default;

void TerminalSink::begin(const display::PictureInfo& picture, const Canvas& canvas) {
  picture_ = picture;
  canvas_ = &canvas;
  has_content_ = is_pending_ = false;
  grid_ = screen_.cell_grid();
  develop_ = std::make_unique<display::PixelDeveloper>(picture.display);
}

void TerminalSink::update(const std::vector<std::size_t>&) {
  has_content_ = is_pending_ = true;
  if (screen_.is_idle()) draw();
}

void TerminalSink::poll() {
  const Screen::CellGrid grid = screen_.cell_grid();
  if (!(grid == grid_) && has_content_ && screen_.is_idle()) {
    grid_ = grid;
    draw();
  }
  screen_.poll();
}

void TerminalSink::finish() {
  // The last drawing replaces one that the terminal has not begun to read.
  if (is_pending_) draw();
  screen_.poll();
  canvas_ = nullptr;
  has_content_ = false;
}

void TerminalSink::draw() {
  is_pending_ = false;
  const Fit size = fit(picture_.width, picture_.height, picture_.pixel_aspect, grid_);
  if (size.width == 0) return;
  std::vector<float> rgb = scaled(*canvas_, size.width, size.height);
  Bitmap bitmap{size.width, size.height, std::vector<std::uint8_t>(rgb.size())};
  (*develop_)(rgb.data(), rgb.size() / 3, bitmap.codes.data());
  screen_.show(drawn(screen_.graphics(), bitmap, size.columns, size.rows), size.rows);
}

}  // namespace orrery::preview
