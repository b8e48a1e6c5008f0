// SPDX-License-Identifier: Apache-2.0
#include "image/rewrite.h"

#include "image/format.h"
#include "image/header.h"
#include "image/read.h"
#include "image/sums_file.h"
#include "support/temp_dir.h"
#include "unit/image/test_pictures.h"

namespace orrery::image {
namespace {

class ImageRewrite : public testing::Test {
 protected:
  ImageRewrite() {
    Header header;
    header.software = "somebody";
    header.stamp = "0123";
    write_exr(folder_ / "in.exr", test_picture(6, 4, {"R", "G", "B", "Z"}), header, {});
  }

  support::TempDir folder_;
};

TEST_F(ImageRewrite, EditedPlanesAreChangedAndOthersKept) {
  const auto edit = [](film::Picture& planes) {
    for (film::Plane& plane : planes.planes)
      if (plane.name == "G") plane.values[5] = 1e6F;
    return std::vector<Attribute>{{"edited", 1}};
  };
  const RewriteReport report = rewrite_exr(folder_ / "in.exr", folder_ / "out.exr", edit);
  EXPECT_EQ(report.clamped, 1u);
  EXPECT_FALSE(report.had_attributes);
  film::Picture expected = read(folder_ / "in.exr");
  const film::Picture found = read(folder_ / "out.exr");
  ASSERT_EQ(found.planes.size(), expected.planes.size());
  for (std::size_t c = 0; c < found.planes.size(); ++c) {
    if (expected.planes[c].name == "G") expected.planes[c].values[5] = film::kLargestHalf;
    EXPECT_EQ(found.planes[c].values, expected.planes[c].values) << found.planes[c].name;
  }
  EXPECT_TRUE(rewrite_exr(folder_ / "out.exr", folder_ / "again.exr", edit).had_attributes);
}

TEST_F(ImageRewrite, AttributesAreKeptExceptTheStamp) {
  rewrite_exr(folder_ / "in.exr", folder_ / "out.exr", [](film::Picture&) { return std::vector<Attribute>{}; });
  const std::string bytes = support::file_bytes(folder_ / "out.exr");
  EXPECT_NE(bytes.find("somebody"), std::string::npos);
  EXPECT_EQ(bytes.find("0123"), std::string::npos);
}

TEST_F(ImageRewrite, AFailedEditKeepsTheOldFile) {
  support::write_bytes(folder_ / "out.exr", "old");
  const auto fail = [](film::Picture&) -> std::vector<Attribute> { base::refuse("no"); };
  expect_error(base::ErrorKind::kUsage, {"no"}, [&] { rewrite_exr(folder_ / "in.exr", folder_ / "out.exr", fail); });
  EXPECT_EQ(support::file_bytes(folder_ / "out.exr"), "old");
}

}  // namespace
}  // namespace orrery::image
