// SPDX-License-Identifier: Apache-2.0
#include "annotation/drawing.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>

#include "support/temp_dir.h"

namespace orrery::annotation {
namespace {

Vec3d same(const Vec3d& color) { return color; }

/// The alpha of a row of pixels: "0 0.25 1".
std::string alphas(const Overlay& overlay, int row) {
  std::string out;
  for (int x = 0; x < overlay.width; ++x) {
    const float a = overlay.rgba[4 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(overlay.width) +
                                      static_cast<std::size_t>(x)) +
                                 3];
    out += (out.empty() ? "" : " ") + std::to_string(a).substr(0, 4);
  }
  return out;
}

TEST(AnnotationDrawing, BoxesCoverPartsOfPixels) {
  Drawing drawing;
  drawing.width = 5;
  drawing.height = 2;
  drawing.boxes = {{0.75, 0, 3.5, 1, {1, 0.5, 0}}};
  const Overlay overlay = draw(drawing, same);
  EXPECT_EQ(alphas(overlay, 0), "0.25 1.00 1.00 0.50 0.00");
  EXPECT_EQ(alphas(overlay, 1), "0.00 0.00 0.00 0.00 0.00");
  EXPECT_EQ(overlay.rgba[0], 0.25f) << "premultiplied";
  drawing.boxes = {{-5, -5, 50, 50, {0, 0, 0}}};
  EXPECT_EQ(alphas(draw(drawing, same), 1), "1.00 1.00 1.00 1.00 1.00") << "beyond the image";
}

TEST(AnnotationDrawing, BlendsWithOpaqueAndTransparentImages) {
  const Overlay overlay{2, 1, {0.5f, 0, 0, 0.5f, 0, 0, 0, 0}};
  film::EncodedPicture picture;
  picture.width = 2;
  picture.height = 1;
  picture.values = {0, 0, 255, 9, 9, 9};
  blend(overlay, picture);
  EXPECT_EQ(picture.values, (std::vector<std::uint16_t>{128, 0, 128, 9, 9, 9}));
  picture.channels = 4;
  picture.bits = 16;
  picture.values = {7, 7, 7, 0, 0, 0, 0, 0};
  blend(overlay, picture);
  EXPECT_EQ(picture.values, (std::vector<std::uint16_t>{65535, 0, 0, 32768, 0, 0, 0, 0})) << "unassociated alpha";
}

TEST(AnnotationDrawing, IsALayerOfExrFiles) {
  film::Picture picture;
  add_layer({1, 1, {0.1f, 0.2f, 0.3f, 0.4f}}, picture);
  ASSERT_EQ(picture.planes.size(), 4u);
  EXPECT_EQ(picture.find("annotation.B")->values[0], 0.3f);
  EXPECT_EQ(picture.find("annotation.A")->layer(), "annotation");
}

TEST(AnnotationDrawing, StampsDifferIfDrawingsDo) {
  Drawing drawing;
  EXPECT_EQ(stamped("s", drawing), "s");
  drawing.outline_px = 2;
  const std::string two = stamped("s", drawing);
  EXPECT_NE(two, "s");
  drawing.outline_px = 3;
  EXPECT_NE(stamped("s", drawing), two);
  drawing.outline_px = 2;
  EXPECT_EQ(stamped("s", drawing), two);
  drawing.texts = {{"a", 1, 2, 3, 0}};
  EXPECT_NE(stamped("s", drawing), two);
  const support::TempDir folder;
  drawing.font = folder / "font.ttf";
  std::filesystem::copy_file(image::font_file("DejaVuSans"), drawing.font);
  const std::string sans = stamped("s", drawing);
  std::filesystem::copy_file(image::font_file("DejaVuSans-Bold"), drawing.font,
                             std::filesystem::copy_options::overwrite_existing);
  EXPECT_NE(stamped("s", drawing), sans) << "another font of the same name";
}

TEST(AnnotationDrawing, TextInSvgIsEscaped) {
  Drawing drawing;
  drawing.labels = {{"a < b & \x80", 1, 2, 10, 0.5}};
  const std::string text = svg(drawing, same);
  EXPECT_NE(text.find(">a &lt; b &amp; ?</text>"), std::string::npos) << text;
  EXPECT_NE(text.find("text-anchor=\"middle\""), std::string::npos) << text;
}

TEST(AnnotationDrawing, SvgNamesTheFont) {
  Drawing drawing;
  drawing.texts = {{"a", 1, 2, 10, 0}};
  drawing.font = image::font_file("DejaVuSansMono");
  EXPECT_NE(svg(drawing, same).find("font-family=\"'DejaVu Sans Mono', sans-serif\""), std::string::npos);
}

TEST(AnnotationDrawing, SvgHasTheImageBelowTheText) {
  Drawing drawing;
  drawing.width = 3;
  drawing.height = 2;
  drawing.texts = {{"a", 1, 2, 10, 0}};
  // Digits and padding of RFC 4648, section 10, and bytes above 127.
  const std::pair<const char*, const char*> encoded[] = {
      {"f", "Zg=="}, {"fo", "Zm8="}, {"foo", "Zm9v"}, {"foob", "Zm9vYg=="}, {"\xff\xfe\xfd", "//79"}};
  for (const auto& [bytes, text] : encoded) {
    const std::string out = svg(drawing, same, bytes);
    const std::size_t image =
        out.find(std::string("<image width=\"3\" height=\"2\" href=\"data:image/png;base64,") + text + "\"/>");
    ASSERT_NE(image, std::string::npos) << out;
    EXPECT_LT(image, out.find("<text"));
  }
  EXPECT_EQ(svg(drawing, same).find("<image"), std::string::npos);
}

}  // namespace
}  // namespace orrery::annotation
