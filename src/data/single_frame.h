// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <variant>

#include "data/byte_source.h"
#include "data/data_file.h"
#include "data/elements.h"
#include "data/forward.h"

namespace orrery::data {

/// A file with one frame, which is described when it is opened.
class SingleFrame : public DataFile {
 public:
  SingleFrame(data::Format format, Bytes bytes) : bytes_(std::move(bytes)), format_(format) {}

  Format format() const final { return format_; }
  int frame_count() final { return 1; }
  FrameInfo describe(int) override { return info_; }
  std::uint64_t memory() const override { return bytes_->memory(); }

 protected:
  /// Reads the column of elements, if there is one, and settles its role, see settle_element().
  void settle_names() {
    if (info_.roles.element.empty()) return;
    const Table table = read(0, {info_.roles.element});
    settle_element(std::get<Words>(table.columns.at(0).values).words, info_.roles);
  }

  Bytes bytes_;
  FrameInfo info_;

 private:
  data::Format format_;
};

}  // namespace orrery::data
