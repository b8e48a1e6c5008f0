// SPDX-License-Identifier: Apache-2.0
#include "image/exr_spec.h"

#include <OpenImageIO/imageio.h>

#include <limits>
#include <vector>

#include "image/format.h"
#include "image/header.h"
#include "image/read.h"
#include "image/write.h"
#include "support/temp_dir.h"
#include "unit/image/test_pictures.h"

namespace orrery::image {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

class ImageExrSpec : public testing::Test {
 protected:
  support::TempDir folder_;
};

TEST_F(ImageExrSpec, ExrClampsToHalfAndWritesNoNonFiniteValues) {
  const film::Picture picture{7, 1, {{"R", {1e6f, -1e6f, 65504, 65505, kNan, kInfinity, -kInfinity}}}};
  const WriteReport report = write_exr(folder_ / "a.exr", picture, {}, {});
  EXPECT_EQ(report.clamped, 3u);
  EXPECT_EQ(report.not_finite, 3u);
  EXPECT_EQ(read(folder_ / "a.exr").planes[0].values, (std::vector<float>{65504, -65504, 65504, 65504, 0, 0, 0}));
  ExrOptions options;
  options.as_float = true;
  const WriteReport wide = write_exr(folder_ / "a.exr", picture, {}, options);
  EXPECT_EQ(wide.clamped, 0u);
  EXPECT_EQ(wide.not_finite, 3u);
  EXPECT_EQ(read(folder_ / "a.exr").planes[0].values, (std::vector<float>{1e6f, -1e6f, 65504, 65505, 0, 0, 0}));
}

TEST_F(ImageExrSpec, HdrClampsValuesOutOfRange) {
  const film::Picture picture{3, 1, {{"R", {-1, 3e38f, kNan}}, {"G", {1, 0, 1}}, {"B", {1, 0, kInfinity}}}};
  const WriteReport report = write_hdr(folder_ / "a.hdr", picture);
  EXPECT_EQ(report.clamped, 2u);
  EXPECT_EQ(report.not_finite, 2u);
  const film::Picture back = read(folder_ / "a.hdr");
  EXPECT_NEAR(back.planes[0].values[0], 0, 0.01);
  EXPECT_NEAR(back.planes[1].values[0], 1, 0.01);
  EXPECT_NEAR(back.planes[0].values[1] / 0x1p127f, 1, 0.01);
  EXPECT_NEAR(back.planes[0].values[2], 0, 0.01);
  EXPECT_NEAR(back.planes[1].values[2], 1, 0.01);
}

TEST_F(ImageExrSpec, APlaneOfTheWrongSizeIsAnInternalError) {
  film::Picture picture = test_picture(4, 4);
  picture.planes[2].values.pop_back();
  expect_error(base::ErrorKind::kInternal, {"plane B"}, [&] { write_exr(folder_ / "a.exr", picture, {}, {}); });
  EXPECT_EQ(folder_.count(), 0u);
}

TEST_F(ImageExrSpec, DataAndDisplayWindowsAreInTheHeader) {
  film::Picture picture = test_picture(6, 4);
  picture.x = -2;
  picture.y = 3;
  picture.frame_width = 20;
  picture.frame_height = 10;
  picture.pixel_aspect = 2;
  write_exr(folder_ / "a.exr", picture, {}, {});
  const auto in = OIIO::ImageInput::open((folder_ / "a.exr").string());
  ASSERT_TRUE(in);
  const OIIO::ImageSpec spec = in->spec();
  EXPECT_EQ(spec.x, -2);
  EXPECT_EQ(spec.y, 3);
  EXPECT_EQ(spec.full_width, 20);
  EXPECT_EQ(spec.full_height, 10);
  EXPECT_EQ(spec.get_float_attribute("PixelAspectRatio"), 2);
  // Reading gives the frame without the pixels outside of it.
  const film::Picture back = read(folder_ / "a.exr");
  EXPECT_EQ(back.width, 20);
  EXPECT_EQ(back.planes[0].values[3 * 20], picture.planes[0].values[2]);
  EXPECT_EQ(back.planes[0].values[0], 0);
}

}  // namespace
}  // namespace orrery::image
