// SPDX-License-Identifier: Apache-2.0
#include "cli/run.h"

#include <gtest/gtest.h>
#include <CLI/CLI.hpp>

#include "cli/arguments.h"
#include "support/mentions.h"

namespace orrery::cli {
namespace {

/// A program with commands like orrery's.
class CliRun : public testing::Test {
 protected:
  CliRun() {
    commands_.require_subcommand();
    Command& render = *commands_.add_subcommand("render", "");
    render.add_option("SCENE", scene_, "", "")->required();
    render.add_option("-o,--output", outputs_, "", "")->required()->repeatable();
    render.add_option("--samples", samples_, "", "");
    render.add_flag("-q,--quiet", quiet_, "");
    Command& generate = *commands_.add_subcommand("generate", "");
    generate.require_subcommand();
    generate.add_subcommand("final", "")->add_option("--seed", samples_, "", "");
    generate.add_subcommand("cloud", "");
  }

  /// The message for a command line; empty: it is valid.
  std::string message(const std::vector<std::string>& words) {
    std::vector<const char*> argv = {"orrery"};
    for (const std::string& word : words) argv.push_back(word.c_str());
    try {
      program_.parse(static_cast<int>(argv.size()), argv.data());
    } catch (const CLI::ParseError& error) {
      return usage_message(program_, error, words);
    }
    return {};
  }

  CLI::App program_{"", "orrery"};
  Command commands_{program_};
  std::string scene_, samples_;
  std::vector<std::string> outputs_;
  bool quiet_ = false;
};

TEST_F(CliRun, ValidCommandLinesHaveNoMessage) {
  EXPECT_EQ(message({"render", "a.toml", "-o", "a.png", "--samples", "3"}), "");
  EXPECT_EQ(message({"generate", "final", "--seed=3"}), "");
}

TEST_F(CliRun, ARepeatableOptionTakesOneValueEachTime) {
  EXPECT_EQ(message({"render", "-o", "a.png", "-o", "b.png", "a.toml"}), "");
  EXPECT_EQ(outputs_, (std::vector<std::string>{"a.png", "b.png"}));
  EXPECT_EQ(scene_, "a.toml");
}

TEST_F(CliRun, AnEqualsSignNeedsAValue) {
  EXPECT_EQ(option_without_value({"render", "a.toml", "--samples=", "-o", "a.png"}), "--samples");
  EXPECT_EQ(option_without_value({"render", "a.toml", "--samples=1", "--set", "camera.vfov=", "-q"}), "");
  EXPECT_EQ(option_without_value({"render", "--", "--samples="}), "");
}

TEST_F(CliRun, UnknownOptionsGetASuggestion) {
  EXPECT_TRUE(test::mentions(message({"render", "a.toml", "-o", "a.png", "--samlpes", "3"}),
                             {"option", "--samlpes", "`--samples`"}));
  EXPECT_TRUE(test::mentions(message({"render", "a.toml", "-o", "a.png", "--samlpes=3"}),
                             {"option", "--samlpes", "`--samples`"}));
  EXPECT_EQ(message({"render", "a.toml", "-o", "a.png", "--zzzzzz"}), "unknown option --zzzzzz");
  EXPECT_EQ(message({"render", "a.toml", "-o", "a.png", "-x"}), "unknown option -x");
}

TEST_F(CliRun, AnUnknownOptionIsReportedBeforeMissingOnes) {
  EXPECT_TRUE(test::mentions(message({"render", "--ouptut", "a.png", "a.toml"}), {"option", "--ouptut", "`--output`"}));
}

TEST_F(CliRun, OptionsBelongToTheInnermostCommand) {
  EXPECT_TRUE(test::mentions(message({"generate", "final", "--sede", "3"}), {"option", "--sede", "`--seed`"}));
  EXPECT_EQ(message({"generate", "cloud", "--sede", "3"}), "unknown option --sede");
}

TEST_F(CliRun, UnknownCommandsGetASuggestion) {
  EXPECT_TRUE(test::mentions(message({"rendr", "a.toml"}), {"command", "rendr", "`render`"}));
  EXPECT_TRUE(test::mentions(message({"paint", "a.toml"}), {"command", "generate"}));
  EXPECT_TRUE(test::mentions(message({"generate", "fianl"}), {"command", "fianl", "`final`"}));
}

TEST_F(CliRun, ASceneWithoutACommandShowsHowToRenderIt) {
  EXPECT_TRUE(test::mentions(message({"a.toml"}), {"command", "a.toml", "a.toml -o image.png"}));
}

TEST_F(CliRun, MissingArgumentsAreNamed) {
  EXPECT_TRUE(test::mentions(message({}), {"command", "generate"}));
  EXPECT_TRUE(test::mentions(message({"generate"}), {"command", "given"}));
  EXPECT_EQ(message({"render"}), "SCENE is required");
  EXPECT_EQ(message({"render", "a.toml"}), "--output is required");
  EXPECT_EQ(message({"render", "a.toml", "-o", "a.png", "--samples"}), "--samples needs a value");
}

TEST_F(CliRun, UnexpectedArgumentsAreNamed) {
  EXPECT_TRUE(test::mentions(message({"render", "a.toml", "-o", "a.png", "b.png"}), {"unexpected", "`b.png`", "-o"}));
  EXPECT_EQ(message({"generate", "cloud", "b.png"}), "unexpected argument `b.png`");
  EXPECT_EQ(message({"render", "a.toml", "-o", "a.png", "--quiet=maybe"}), "--quiet takes no value");
}

TEST_F(CliRun, FullNamesOfCommandsAreAsTyped) {
  EXPECT_EQ(commands_.full_name(), "orrery");
  EXPECT_EQ(commands_.subcommands()[1].subcommands()[0].full_name(), "orrery generate final");
}

TEST_F(CliRun, RemovedCommandsNameWhatReplacesThem) {
  commands_.add_subcommand("info", "");
  EXPECT_TRUE(test::mentions(message({"bake", "-o", "a.cube"}), {"removed", "ociobakelut", "docs/output.md"}));
  EXPECT_TRUE(test::mentions(message({"info", "--measure"}), {"--measure", "measures", "features"}));
  EXPECT_TRUE(test::mentions(message({"generate", "planet"}), {"planet", "removed", "scenes/next-week/planet.jpg"}));
  EXPECT_NE(message({"planet"}).find("unknown command planet"), std::string::npos) << "it never had it";
}

TEST_F(CliRun, OptionsThatAreGuessedNameTheRightOnes) {
  std::vector<std::string> settings;
  Command& check = *commands_.add_subcommand("check", "");
  check.add_option("--set", settings, "KEY=VALUE", "");
  EXPECT_TRUE(test::mentions(message({"check", "--seed", "3"}), {"option", "--seed", "--set render.seed=N"}));
  EXPECT_EQ(message({"generate", "cloud", "--log"}), "unknown option --log") << "it has no --set";
  EXPECT_TRUE(test::mentions(message({"render", "--spp", "3"}), {"option", "--spp", "--samples"}));
}

}  // namespace
}  // namespace orrery::cli
