// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "data/data_file.h"
#include "data/forward.h"

namespace orrery::data {

/// A file with one frame, which is described when it is opened.
class SingleFrame : public DataFile {
 public:
  SingleFrame(data::Format format, Bytes bytes) : bytes_(std::move(bytes)), format_(format) {}

  Format format() const final { return format_; }
  int frame_count() final { return 1; }
  FrameInfo describe(int) override { return info_; }

 protected:
  Bytes bytes_;
  FrameInfo info_;

 private:
  data::Format format_;
};

}  // namespace orrery::data
