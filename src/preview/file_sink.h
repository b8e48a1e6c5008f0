// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "display/develop.h"
#include "film/picture.h"
#include "preview/sink.h"

namespace orrery::preview {

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
  film::EncodedPicture picture_;
};

}  // namespace orrery::preview
