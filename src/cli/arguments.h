// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace orrery::cli {

// The part of CLI11 that commands use, without its headers: these take several seconds to compile in each file that
// includes them. Only arguments.cpp, usage.cpp and run.cpp do.

/// Checks the text of an argument, and may replace it. Returns what is wrong with it; empty: nothing.
using Check = std::function<std::string(std::string& value)>;

/// A flag or a positional argument.
class Option {
 public:
  explicit Option(CLI::Option& option) : option_(&option) {}

  Option* required();
  Option* type_name(const std::string& name);
  /// Refuses what `check` finds wrong; the value stays as it was typed.
  Option* check(Check check);
  /// Refuses what `check` finds wrong, and takes the value that it leaves.
  Option* transform(Check check);
  Option* excludes(const Option* other);
  /// Takes all values up to the next flag.
  Option* take_all();
  /// Can be given several times, with one value each time: what follows the value is the next argument.
  Option* repeatable();
  /// How often it was given.
  std::size_t count() const;

 private:
  CLI::Option* option_;
};

/// A command with its options, or the program with its commands. Options and subcommands live as long as it does, and
/// so must the variables.
class Command {
 public:
  explicit Command(CLI::App& app) : app_(&app) {}
  Command(const Command&) = delete;
  Command& operator=(const Command&) = delete;

  Command* add_subcommand(const std::string& name, const std::string& description);
  void require_subcommand();

  // `names` as "-o,--output", or "SCENE" for a positional argument; parsing writes the value into `variable`.
  Option* add_option(const std::string& names, std::string& variable, const std::string& description);
  Option* add_option(const std::string& names, std::filesystem::path& variable, const std::string& description);
  Option* add_option(const std::string& names, int& variable, const std::string& description);
  Option* add_option(const std::string& names, std::uint64_t& variable, const std::string& description);
  Option* add_option(const std::string& names, double& variable, const std::string& description);
  Option* add_option(const std::string& names, std::optional<double>& variable, const std::string& description);
  Option* add_option(const std::string& names, std::vector<std::string>& variable, const std::string& description);
  Option* add_option(const std::string& names, std::vector<std::filesystem::path>& variable,
                     const std::string& description);
  Option* add_flag(const std::string& names, bool& variable, const std::string& description);

  /// Text below the options in the help.
  void footer(const std::string& text);
  /// Called after parsing where the command line names this command.
  void callback(std::function<void()> function);

 private:
  CLI::App* app_;
  std::deque<Option> options_;
  std::deque<Command> subcommands_;
};

}  // namespace orrery::cli
