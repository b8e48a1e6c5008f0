// SPDX-License-Identifier: Apache-2.0
#include "job/write_outputs.h"

#include <gtest/gtest.h>

#include "support/temp_dir.h"

namespace orrery::job {
namespace {

TEST(JobWriteOutputs, SvgHasOutlinesInTheImageAndTextBesides) {
  film::Picture picture;
  picture.width = 40;
  picture.height = 20;
  for (const char* channel : {"R", "G", "B"})
    picture.planes.push_back({channel, std::vector<float>(40 * 20, 0.5F), film::PlaneKind::kLight});
  annotation::Drawing drawing;
  drawing.width = picture.width;
  drawing.height = picture.height;
  drawing.texts = {{"title", 1, 10, 8, 0}};
  const support::TempDir folder;
  const display::Settings settings;
  const auto written = [&](const char* name, const annotation::Drawing& over) {
    DisplayWriter(picture, settings, 8, over).write(folder / name, "");
    return support::file_bytes(folder / name);
  };
  const auto image_of = [](const std::string& svg) {
    const std::size_t begin = svg.find("<image");
    return svg.substr(begin, svg.find("/>", begin) - begin);
  };
  const std::string plain = written("plain.svg", {}), titled = written("titled.svg", drawing);
  EXPECT_NE(plain.find("base64,iVBORw0KGgo"), std::string::npos) << plain;  // the signature of PNG
  EXPECT_EQ(plain.find("<text"), std::string::npos);
  EXPECT_NE(titled.find(">title</text>"), std::string::npos) << titled;
  EXPECT_EQ(image_of(plain), image_of(titled));  // the text is not drawn into the image

  drawing.outline_px = 1;
  drawing.lines.assign(40 * 20, 1);
  EXPECT_NE(image_of(written("outlined.svg", drawing)), image_of(plain));
}

}  // namespace
}  // namespace orrery::job
