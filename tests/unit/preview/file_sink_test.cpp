// SPDX-License-Identifier: Apache-2.0
#include "preview/file_sink.h"

#include <gtest/gtest.h>

#include "unit/preview/pictures.h"
#include "unit/preview/png_bytes.h"

namespace orrery::preview {

namespace {

TEST(PreviewPng, HoldsTheBitmapWithRightChecksums) {
  // One pixel; several stored blocks; several chunks.
  for (const auto& [width, height] : {std::pair{1, 1}, {7, 5}, {333, 201}, {2600, 2400}}) {
    const Bitmap bitmap = gradient(width, height);
    const Bitmap read = decoded_png(encode_png(bitmap));
    EXPECT_EQ(read.width, width);
    EXPECT_EQ(read.height, height);
    EXPECT_TRUE(read.codes == bitmap.codes) << width;
  }
}

}  // namespace

}  // namespace orrery::preview
