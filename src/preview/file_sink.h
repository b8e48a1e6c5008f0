// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "display/develop.h"
#include "preview/sink.h"

namespace orrery::preview {

/// An image of 8-bit display values.
struct Bitmap {
  int width = 0, height = 0;        ///< px
  std::vector<std::uint8_t> codes;  ///< R, G, B of all pixels, row by row from the top

  std::size_t row_bytes() const { return 3 * static_cast<std::size_t>(width); }
  const std::uint8_t* row(int y) const { return codes.data() + static_cast<std::size_t>(y) * row_bytes(); }
};

/// Encodes a PNG without compression, which would take most of the time.
///
/// Reference  PNG
std::string encode_png(const Bitmap& bitmap);

/// Rewrites a PNG, uncompressed and through the display transform. Its readers never see an incomplete file.
class FileSink : public Sink {
 public:
  explicit FileSink(std::filesystem::path file) : file_(std::move(file)) {}

  double interval_s() const override { return 1; }
  void begin(const display::PictureInfo& picture, const Canvas& canvas) override;

  /// Develops the changed cells and rewrites the file.
  ///
  /// Errors     base::Error: kCannotCreate, kIo
  void update(const std::vector<std::size_t>& cells) override;

 private:
  std::filesystem::path file_;
  const Canvas* canvas_ = nullptr;
  std::optional<display::PixelDeveloper> develop_;
  Bitmap bitmap_;
};

}  // namespace orrery::preview
