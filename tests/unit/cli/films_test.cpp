// SPDX-License-Identifier: Apache-2.0
#include "cli/films.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdlib>
#include <utility>

#include "base/error.h"
#include "support/temp_dir.h"

namespace orrery::cli {
namespace {

using Json = nlohmann::json;

/// The command of a film is this test program itself, which runs no tests then: it prints how many.
class CliFilms : public testing::Test {
 protected:
  void SetUp() override { setenv("GTEST_FILTER", "-*", 1); }
  void TearDown() override {
    unsetenv("GTEST_FILTER");
    unsetenv("GTEST_REPEAT");
  }

  static Json ended(const Films& films) {
    Json state;
    do state = Json::parse(films.state());
    while (state["is_running"]);
    return state;
  }

  support::TempDir folder_;
};

TEST_F(CliFilms, AFilmReportsHowItsCommandHasEnded) {
  Films films(folder_.path());
  EXPECT_EQ(ended(films)["file"], "") << "none has been started";
  films.start("plot", "a.csv", {"--fps", "12"}, "film.mp4");
  const Json state = ended(films);
  EXPECT_EQ(state["file"], (folder_ / "film.mp4").string());
  EXPECT_EQ(state["status"], 0);
  EXPECT_TRUE(state["progress"].is_null());
  EXPECT_NE(state["messages"].dump().find("0 tests"), std::string::npos) << state["messages"];
}

TEST_F(CliFilms, NoFileIsReplaced) {
  support::write_bytes(folder_ / "film.mp4", "mine");
  support::write_bytes(folder_ / "film-2.mp4", "mine");
  support::write_bytes(folder_ / "film.0001.png", "mine");
  Films films(folder_.path());
  for (const auto& [name, unused] : {std::pair{"film.mp4", "film-3.mp4"}, {"film.####.png", "film-2.####.png"}}) {
    films.start("plot", "a.csv", {}, name);
    EXPECT_EQ(ended(films)["file"], (folder_ / unused).string());
  }
}

TEST_F(CliFilms, OneFilmIsMadeAtATime) {
  Films films(folder_.path());
  setenv("GTEST_REPEAT", "-1", 1);  // it never ends
  films.start("plot", "a.csv", {}, "film.mp4");
  EXPECT_THROW(films.start("plot", "a.csv", {}, "film.mp4"), base::Error);
  films.cancel();
  EXPECT_EQ(ended(films)["status"], 128 + 2) << "ended by INT";
}

TEST_F(CliFilms, TheFolderMustExist) {
  try {
    const Films films(folder_ / "none");
    ADD_FAILURE() << "no error";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kMissingInput);
  }
}

}  // namespace
}  // namespace orrery::cli
