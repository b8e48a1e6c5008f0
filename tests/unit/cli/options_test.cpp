// SPDX-License-Identifier: Apache-2.0
#include "cli/options.h"

#include <gtest/gtest.h>
#include <CLI/CLI.hpp>

#include "base/error.h"

namespace orrery::cli {
namespace {

using Texts = std::vector<std::string>;

/// The overrides of a command line, as they would be typed with --set.
Texts overrides_of(const std::vector<const char*>& words) {
  CLI::App app;
  app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  Command command(app);
  SceneOptions options;
  options.add_to(command);
  std::vector<const char*> argv = {"program"};
  argv.insert(argv.end(), words.begin(), words.end());
  app.parse(static_cast<int>(argv.size()), argv.data());
  Texts texts;
  for (const load::KeyValue& set : options.overrides().values()) texts.push_back(set.text);
  return texts;
}

TEST(CliOptions, NoOptionsGiveNoOverrides) { EXPECT_TRUE(overrides_of({}).empty()); }

TEST(CliOptions, EveryShortFormSetsItsKey) {
  EXPECT_EQ(overrides_of({"--samples", "1", "--width", "2", "--height", "3", "--precision", "fast"}),
            (Texts{"image.width=2", "image.height=3", "render.samples=1", "render.precision=\"fast\""}));
}

TEST(CliOptions, SetComesAfterShortForms) {
  EXPECT_EQ(overrides_of({"--set", "image.width=9", "--set", "camera.vfov=30", "--samples", "1"}),
            (Texts{"render.samples=1", "image.width=9", "camera.vfov=30"}));
}

TEST(CliOptions, AKeyIsNotSetTwiceByDifferentOptions) {
  for (const char* text : {"render.samples=9", "render={samples=9}", " render . samples = 9", "\"render\".samples=9",
                           "render={\"s\\u0061mples\"=9}"})
    EXPECT_THROW(overrides_of({"--set", text, "--samples", "1"}), base::Error) << text;
}

TEST(CliOptions, TheLastShortFormCounts) {
  EXPECT_EQ(overrides_of({"--samples", "1", "--samples", "2"}), (Texts{"render.samples=2"}));
}

TEST(CliOptions, AnEmptyValueIsAnErrorExceptForLayers) {
  for (const char* option : {"--samples", "--precision"})
    EXPECT_THROW(overrides_of({option, ""}), CLI::ValidationError) << option;
  EXPECT_EQ(overrides_of({"--layers", ""}), (Texts{"output.layers=[]"}));
}

TEST(CliOptions, LayersAreSeparatedByCommas) {
  EXPECT_EQ(overrides_of({"--layers", "Z,denoise.albedo"}), (Texts{"output.layers=[\"Z\", \"denoise.albedo\"]"}));
}

}  // namespace
}  // namespace orrery::cli
