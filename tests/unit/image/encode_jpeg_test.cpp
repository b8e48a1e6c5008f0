// SPDX-License-Identifier: Apache-2.0
#include <OpenImageIO/imageio.h>

#include <cerrno>
#include <cstdint>
#include <vector>

#include "image/checked_file.h"
#include "image/whole_file.h"
#include "image/write.h"
#include "support/temp_dir.h"
#include "unit/image/test_pictures.h"

namespace orrery::image {
namespace {

class ImageEncodeJpeg : public testing::Test {
 protected:
  support::TempDir folder_;
};

TEST_F(ImageEncodeJpeg, BytesMatchOpenImageIo) {
  const film::EncodedPicture picture = test_encoded(67, 43, 8);
  OIIO::ImageSpec spec(67, 43, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("Software", "orrery test");
  spec.attribute("ImageDescription", "orrery/stamp 0123");
  spec.attribute("compression", "jpeg:95");
  spec.attribute("jpeg:subsampling", "4:4:4");
  for (const bool is_srgb : {false, true}) {
    film::EncodedPicture shown = picture;
    shown.is_srgb = is_srgb;
    write_encoded(folder_ / "ours.jpg", shown, "orrery test", "0123");
    if (is_srgb) spec.attribute("oiio:ColorSpace", "sRGB");
    const auto out = OIIO::ImageOutput::create("jpeg");
    ASSERT_TRUE(out->open((folder_ / "theirs.jpg").string(), spec));
    const std::vector<std::uint8_t> codes(picture.values.begin(), picture.values.end());
    ASSERT_TRUE(out->write_image(OIIO::TypeDesc::UINT8, codes.data()) && out->close());
    EXPECT_TRUE(support::file_bytes(folder_ / "ours.jpg") == support::file_bytes(folder_ / "theirs.jpg")) << is_srgb;
  }
}

TEST_F(ImageEncodeJpeg, LibjpegErrorsAreReturnedWithoutExit) {
  // libjpeg rejects this size with an error handler that must not return, as for lack of memory.
  support::write_bytes(folder_ / "a", "");
  CheckedFile file(folder_ / "a");
  const OIIO::ImageSpec spec(65501, 1, 3, OIIO::TypeDesc::UINT8);
  const std::vector<std::uint8_t> pixels(65501 * 3);
  EXPECT_NE(encode_jpeg(spec, pixels.data(), file).find("65500"), std::string::npos);
}

TEST_F(ImageEncodeJpeg, AFullDiskFailsTheFile) {
  CheckedFile full("/dev/full");
  const OIIO::ImageSpec spec(600, 400, 3, OIIO::TypeDesc::UINT8);
  std::vector<std::uint8_t> pixels(600 * 400 * 3);
  encode_jpeg(spec, pixels.data(), full);
  EXPECT_EQ(full.finish(), ENOSPC) << "all in one buffer";
  std::uint32_t state = 1;
  for (std::uint8_t& code : pixels) code = static_cast<std::uint8_t>((state = state * 1664525 + 1013904223) >> 24);
  CheckedFile again("/dev/full");
  EXPECT_NE(encode_jpeg(spec, pixels.data(), again), "") << "noise fills several buffers";
  EXPECT_EQ(again.finish(), ENOSPC);
}

}  // namespace
}  // namespace orrery::image
