// SPDX-License-Identifier: Apache-2.0
#include "job/image_files.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "base/error.h"
#include "image/format.h"
#include "image/header.h"
#include "image/read.h"
#include "image/write.h"
#include "support/temp_dir.h"

namespace orrery::job {
namespace {

class JobDevelopFile : public testing::Test {
 protected:
  JobDevelopFile() {
    ::unsetenv("OCIO");
    film::Picture picture{4, 2, {}};
    for (const char* name : {"R", "G", "B"}) picture.planes.push_back({name, std::vector<float>(8, 0.25f)});
    image::write_exr(folder_ / "in.exr", picture, {}, {true, "zips"});
    development_.input = folder_ / "in.exr";
    development_.display.display = "Gamma 2.0 Rec.709";
  }

  base::ErrorKind kind_of_error() {
    try {
      develop_file(development_);
    } catch (const base::Error& error) {
      return error.kind();
    }
    ADD_FAILURE() << "no error";
    return base::ErrorKind::kInternal;
  }

  support::TempDir folder_;
  Development development_;
};

TEST_F(JobDevelopFile, AppliesTheDisplayTransformToEveryOutput) {
  development_.outputs = {folder_ / "out.png", folder_ / "out.ppm"};
  const DevelopReport report = develop_file(development_);
  EXPECT_EQ(report.display.display, "Gamma 2.0 Rec.709");
  for (const auto& output : development_.outputs)
    EXPECT_NEAR(image::read(output).planes.at(0).values.at(0), 0.5, 0.6 / 255) << "the square root of a quarter";
}

TEST_F(JobDevelopFile, SixteenBitsAreFiner) {
  development_.outputs = {folder_ / "out.png"};
  development_.bits = 16;
  develop_file(development_);
  EXPECT_NEAR(image::read(folder_ / "out.png").planes.at(0).values.at(0), 0.5, 0.6 / 65535);
}

TEST_F(JobDevelopFile, RequiresSceneLinearInputAndDisplayFormatOutputs) {
  development_.outputs = {folder_ / "out.exr"};
  EXPECT_EQ(kind_of_error(), base::ErrorKind::kUsage);
  development_.outputs = {folder_ / "out.png"};
  develop_file(development_);
  development_.input = folder_ / "out.png";
  development_.outputs = {folder_ / "again.png"};
  EXPECT_EQ(kind_of_error(), base::ErrorKind::kUsage);
}

TEST_F(JobDevelopFile, ErrorsAreFoundBeforeAnythingIsWritten) {
  development_.outputs = {folder_ / "out.png", folder_.path() / "none/out.png"};
  EXPECT_EQ(kind_of_error(), base::ErrorKind::kCannotCreate);
  development_.outputs = {folder_ / "out.png"};
  development_.display.view = "none such";
  EXPECT_EQ(kind_of_error(), base::ErrorKind::kUsage);
  development_.display.view.clear();
  development_.input = folder_ / "missing.exr";
  EXPECT_EQ(kind_of_error(), base::ErrorKind::kMissingInput);
  EXPECT_EQ(folder_.count(), 1u);
}

TEST_F(JobDevelopFile, CountsInvalidValuesBeforeTheDisplayTransform) {
  // write_exr() never writes NaN, so the test uses negative and large values.
  film::Picture picture{2, 1, {}};
  for (const char* name : {"R", "G", "B"}) picture.planes.push_back({name, {-1.0f, 70000.0f}});
  image::write_exr(folder_ / "odd.exr", picture, {}, {true, "zips"});
  development_.input = folder_ / "odd.exr";
  development_.outputs = {folder_ / "out.png"};
  const film::BadValues bad = develop_file(development_).bad_values;
  EXPECT_EQ(bad.negative, 3u);
  EXPECT_EQ(bad.above_half, 3u);
}

/// ACEScg red is more saturated than Rec.709 red. The space in the header is the default.
TEST_F(JobDevelopFile, TheHeaderSetsTheDefaultWorkingSpace) {
  film::Picture red{1, 1, {{"R", {0.5f}}, {"G", {0.1f}}, {"B", {0.1f}}}};
  image::Header header;
  header.color_interop_id = "lin_ap1_scene";
  image::write_exr(folder_ / "in.exr", red, header, {true, "zips"});
  development_.display.working_space.clear();
  development_.outputs = {folder_ / "out.png"};
  EXPECT_EQ(develop_file(development_).display.working_space, "acescg");
  EXPECT_GT(image::read(folder_ / "out.png").planes[0].values[0], 0.8f);  // the square root of 0.5 is 0.71
  development_.display.working_space = "lin_rec709";
  EXPECT_EQ(develop_file(development_).display.working_space, "lin_rec709");
  EXPECT_NEAR(image::read(folder_ / "out.png").planes[0].values[0], 0.707, 0.003);
}

}  // namespace
}  // namespace orrery::job
