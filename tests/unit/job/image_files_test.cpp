// SPDX-License-Identifier: Apache-2.0
#include "job/image_files.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>

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

class JobDenoiseFile : public testing::Test {
 protected:
  JobDenoiseFile() {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> value(0.25F, 0.75F);
    picture_ = {40, 20, {}};
    std::vector<std::string> names = {"R", "G", "B", "A", "Z", "CryptoObject00.R"};
    for (const char* half : {"half_a", "half_b"})
      for (const char* end : {".R", ".G", ".B", ".albedo.R", ".albedo.G", ".albedo.B", ".normal.X", ".normal.Y",
                              ".normal.Z", ".inverse_depth.X"})
        names.push_back(std::string(half) + end);
    for (const std::string& name : names) {
      film::Plane plane{name, std::vector<float>(800, 0.5F)};
      if (!name.starts_with("half_") || name.size() == 8)  // the guides are equal
        for (float& v : plane.values) v = value(random);
      if (plane.name == "Z" || plane.name[0] == 'C') plane.kind = film::PlaneKind::kData;
      picture_.planes.push_back(std::move(plane));
    }
    denoising_ = {folder_ / "in.exr", folder_ / "out.exr", 2};
  }

  void write(bool multipart = false, bool as_float = false) {
    image::Header header;
    header.stamp = "of the noisy image";
    header.attributes = {{"orrery/seed", "7"}};
    image::write_exr(denoising_.input, picture_, header, {as_float, "zips", multipart});
  }
  std::string bytes(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  base::ErrorKind kind_of_error() {
    try {
      denoise_file(denoising_);
    } catch (const base::Error& error) {
      return error.kind();
    }
    ADD_FAILURE() << "no error";
    return base::ErrorKind::kInternal;
  }

  support::TempDir folder_;
  film::Picture picture_;
  Denoising denoising_;
};

TEST_F(JobDenoiseFile, ChangesOnlyTheLight) {
  for (const bool multipart : {false, true}) {
    write(multipart);
    denoise_file(denoising_);
    const film::Picture before = image::read(denoising_.input), after = image::read(denoising_.output);
    ASSERT_EQ(before.planes.size(), after.planes.size());
    for (std::size_t i = 0; i < before.planes.size(); ++i) {
      EXPECT_EQ(before.planes[i].name, after.planes[i].name);
      const std::string& name = before.planes[i].name;
      const bool is_filtered = name == "R" || name == "G" || name == "B" || name == "A";
      EXPECT_EQ(before.planes[i].values != after.planes[i].values, is_filtered) << name;
    }
    const std::string out = bytes(denoising_.output);
    EXPECT_EQ(out.find("of the noisy image"), std::string::npos) << "the stamp no longer describes the pixels";
    EXPECT_NE(out.find("orrery/seed"), std::string::npos);
    EXPECT_NE(out.find("orrery/denoised"), std::string::npos);
    EXPECT_EQ(out.find("CryptoObject") != std::string::npos, true) << "other parts are kept";
  }
}

TEST_F(JobDenoiseFile, TheSameFileGivesTheSameBytes) {
  write();
  denoise_file(denoising_);
  const std::string first = bytes(denoising_.output);
  denoising_.threads = 1;
  denoise_file(denoising_);
  EXPECT_EQ(bytes(denoising_.output), first);
}

TEST_F(JobDenoiseFile, NeverReplacesItsInput) {
  write();
  const std::string before = bytes(denoising_.input);
  denoising_.output = denoising_.input;
  EXPECT_EQ(kind_of_error(), base::ErrorKind::kUsage);
  std::filesystem::create_hard_link(denoising_.input, folder_ / "link.exr");
  denoising_.output = folder_ / "link.exr";
  EXPECT_EQ(kind_of_error(), base::ErrorKind::kUsage);
  EXPECT_EQ(bytes(denoising_.input), before);
}

TEST_F(JobDenoiseFile, RejectsFilesThatAreNotImages) {
  EXPECT_EQ(kind_of_error(), base::ErrorKind::kMissingInput);
  denoising_.output = folder_ / "out.png";
  EXPECT_EQ(kind_of_error(), base::ErrorKind::kUsage);
  denoising_.output = folder_ / "out.exr";
  std::ofstream(denoising_.input) << "no EXR";
  EXPECT_EQ(kind_of_error(), base::ErrorKind::kBadData);
  write();
  std::filesystem::resize_file(denoising_.input, std::filesystem::file_size(denoising_.input) / 2);
  EXPECT_EQ(kind_of_error(), base::ErrorKind::kBadData);
  picture_.planes.erase(picture_.planes.begin());
  write();
  EXPECT_EQ(kind_of_error(), base::ErrorKind::kBadData) << "no channel R";
  picture_.planes.insert(picture_.planes.begin(), {"R", picture_.planes.front().values});
  picture_.planes.pop_back();
  write();
  EXPECT_EQ(kind_of_error(), base::ErrorKind::kBadData) << "an incomplete half";
  EXPECT_FALSE(std::filesystem::exists(denoising_.output));
}

TEST_F(JobDenoiseFile, DamagedFilesNeverCrash) {
  write();
  const std::string good = bytes(denoising_.input);
  std::mt19937 random(5);
  for (int n = 0; n < 60; ++n) {
    std::string bad = good;
    for (int k = 0; k < 4; ++k) bad[random() % (n < 40 ? 600 : bad.size())] = static_cast<char>(random());
    std::ofstream(denoising_.input, std::ios::binary) << bad;
    try {
      denoise_file(denoising_);
    } catch (const base::Error& error) {
      EXPECT_TRUE(error.kind() == base::ErrorKind::kBadData || error.kind() == base::ErrorKind::kIo) << error.what();
    }
  }
}

}  // namespace
}  // namespace orrery::job
