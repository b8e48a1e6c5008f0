// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "display/forward.h"
#include "display/picture_info.h"
#include "preview/screen.h"
#include "preview/sink.h"

namespace orrery::preview {

/// Draws images on a Screen, through the display transform.
class TerminalSink : public Sink {
 public:
  /// A sink that draws on `screen`.
  ///
  /// Domain     `screen` outlives this
  explicit TerminalSink(Screen& screen);
  ~TerminalSink() override;

  double interval_s() const override { return 0.5; }
  void begin(const display::PictureInfo& picture, const Canvas& canvas) override;
  void update(const std::vector<std::size_t>& cells) override;
  void poll() override;
  void finish() override;

 private:
  void draw();

  Screen& screen_;
  Screen::CellGrid grid_;
  display::PictureInfo picture_;
  const Canvas* canvas_ = nullptr;
  std::unique_ptr<display::PixelDeveloper> develop_;
  bool has_content_ = false;  ///< there is something to draw
  bool is_pending_ = false;   ///< pixels have changed since the last drawing
};

}  // namespace orrery::preview
