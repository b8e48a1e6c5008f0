// SPDX-License-Identifier: Apache-2.0
// The commands info and check.
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace orrery::test {
namespace {

class CliSceneCommands : public ProgramTest {};

TEST_F(CliSceneCommands, SettingsShowTheirOrigin) {
  const Outcome r = run("info good.toml --settings --set camera.vfov=33");
  EXPECT_EQ(r.status, 0);
  EXPECT_TRUE(contains(r.out, "good.toml:3")) << r.out;
  EXPECT_TRUE(contains(r.out, "--set")) << r.out;
  EXPECT_TRUE(contains(r.out, "default")) << r.out;
}

/// A track replaces what --set sets; the user must not believe otherwise.
TEST_F(CliSceneCommands, SettingAnAnimatedKeyIsAWarning) {
  write("keys.toml", std::string(kGoodScene) +
                         "\n[[key]]\ntarget = \"camera.vfov\"\nframes = [1, 2]\nvalues = [30, 10]\n"
                         "[[key]]\ntarget = \"sphere[0].radius\"\nframes = [1, 2]\nvalues = [0.5, 1]\n");
  const std::string warning = "is animated by key[0], which takes precedence";
  EXPECT_TRUE(contains(run("render keys.toml -o a.png -q --set camera.vfov=90").err, warning) ||
              contains(run("render keys.toml -o a.png --set camera.vfov=90").err, warning));
  EXPECT_TRUE(
      contains(run("check keys.toml --set 'sphere[0].radius=2'").err, "sphere[0].radius is animated by key[1]"));
  const Outcome settings = run("info keys.toml --settings --set camera.vfov=90");
  const std::size_t line = settings.out.find("camera.vfov");
  ASSERT_NE(line, std::string::npos);
  EXPECT_TRUE(contains(settings.out.substr(line, settings.out.find('\n', line) - line), "key[0]")) << settings.out;
  EXPECT_FALSE(contains(run("check keys.toml --set camera.vfov=90 --set 'key=[]'").err, "animated"));
}

TEST_F(CliSceneCommands, InfoPrintsJson) {
  const Outcome r = run("info good.toml --json");
  ASSERT_EQ(r.status, 0) << r.err;
  const auto json = nlohmann::json::parse(r.out);
  EXPECT_EQ(json["spheres"], 1);
  EXPECT_EQ(json["schema"], "orrery.info/1");
}

TEST_F(CliSceneCommands, CheckValidatesAllScenesAndExitsWithAFailure) {
  write("bad.toml", "nonsense");
  const Outcome r = run("check bad.toml good.toml");
  EXPECT_EQ(r.status, 65);
  EXPECT_EQ(r.out, "good.toml: ok\n");
  EXPECT_EQ(run("check good.toml missing.toml").status, 66);
}

}  // namespace
}  // namespace orrery::test
