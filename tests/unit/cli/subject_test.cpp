// SPDX-License-Identifier: Apache-2.0
#include "cli/subject.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "cli/film.h"
#include "support/mentions.h"
#include "support/temp_dir.h"

namespace orrery::cli {
namespace {

class CliSubject : public testing::Test {
 protected:
  void SetUp() override {
    support::write_bytes(data_, "x,y,z,radius,q\n0,0,0,1,2\n3,0,0,1,4\n");
    support::write_bytes(scene_, "[image]\nwidth = 32\n");
  }
  /// The exit status of an error; 0: there is none.
  template <class F>
  static int status_of(F f) {
    try {
      f();
    } catch (const base::Error& error) {
      return base::exit_status(error.kind());
    }
    return 0;
  }

  support::TempDir folder_;
  const std::filesystem::path data_ = folder_ / "a.csv", scene_ = folder_ / "a.toml";
};

TEST_F(CliSubject, ADataFileIsShownWithWhatWasChosen) {
  const view::Subject subject = subject_of(data_, {"--color-by", "q", "--samples", "3"}, {});
  EXPECT_EQ(subject.job.scene.file, data_);
  EXPECT_EQ(subject.chosen.at("--range"), "2:4");
  EXPECT_EQ(subject.chosen.at("--material"), "matte");
  EXPECT_EQ(subject.chosen.at("--bonds"), "none");
  EXPECT_EQ(subject.data->rows, 2u);
  EXPECT_EQ(subject.frame_count, 1);
  EXPECT_EQ(subject.up, (math::Vec3d{0, 0, 1}));
  EXPECT_EQ(subject.legend.range->high, 4);
  EXPECT_EQ(subject.job.scene.overrides.integer("render.samples"), 3);
}

TEST_F(CliSubject, ASceneHasItsKeysInsteadOfOptionsForData) {
  const view::Subject subject = subject_of(scene_, {"--set", "image.width=16"}, {});
  EXPECT_EQ(subject.job.scene.overrides.integer("image.width"), 16);
  EXPECT_FALSE(subject.data);
  EXPECT_EQ(status_of([&] { subject_of(scene_, {"--color-by", "q"}, {}); }), 2);
  EXPECT_EQ(status_of([&] { subject_of(scene_, {"--no-such-option"}, {}); }), 2);
}

TEST_F(CliSubject, OnlyFilesOfTheCommandLineMayBeNamed) {
  const std::vector<std::string> words = {"--color-by", "q", "--map", "maps/own.map"};
  EXPECT_EQ(status_of([&] { subject_of(data_, words, {}); }), 2);
  EXPECT_EQ(status_of([&] { check_film(data_.string(), words, {}); }), 2);
  EXPECT_EQ(status_of([&] { check_film(data_.string(), words, {"maps/own.map"}); }), 0);
  ShownOptions shown;
  shown.plot.options.points.color.map = "maps/own.map";
  EXPECT_EQ(files_of(shown), (std::set<std::string>{"maps/own.map"}));
}

TEST_F(CliSubject, AFilmHasOptionsOfItsOwn) {
  const std::vector<std::string> words = {"--frames", "1-2", "--turntable", "4s", "--fps", "12"};
  EXPECT_EQ(status_of([&] { check_film(data_.string(), words, {}); }), 0);
  EXPECT_EQ(status_of([&] { check_film(data_.string(), {"--output", "a.png"}, {}); }), 2);
  const FilmSettings film{.fps = 12, .turntable_s = 0.25};
  const view::Subject subject = data_subject(data_.string(), {}, {}, {}, &film);
  EXPECT_EQ(subject.frames, (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(subject.job.scene.overrides.number("animation.turntable"), 3);
}

}  // namespace
}  // namespace orrery::cli
