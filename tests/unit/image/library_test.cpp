// SPDX-License-Identifier: Apache-2.0
#include "image/library.h"

#include "image/format.h"
#include "image/header.h"
#include "image/write.h"
#include "support/temp_dir.h"
#include "unit/image/test_pictures.h"

namespace orrery::image {
namespace {

class ImageLibrary : public testing::Test {
 protected:
  support::TempDir folder_;
};

TEST_F(ImageLibrary, ThreadsDoNotChangeTheBytes) {
  const film::Picture picture = test_picture(64, 200);
  write_exr(folder_ / "a.exr", picture, {}, {});
  set_threads(3);
  write_exr(folder_ / "b.exr", picture, {}, {});
  set_threads(1);
  EXPECT_TRUE(support::file_bytes(folder_ / "a.exr") == support::file_bytes(folder_ / "b.exr"));
}

}  // namespace
}  // namespace orrery::image
