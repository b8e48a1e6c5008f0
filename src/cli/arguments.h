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

// The part of CLI11 that commands use, without its headers, which take several seconds to compile. Only arguments.cpp,
// usage.cpp and run.cpp include them.

/// Checks the text of an argument, and may replace it. Returns an error message, or an empty string.
using Check = std::function<std::string(std::string& value)>;

/// An option or a positional argument.
class Option {
 public:
  /// `takes_several`  its variable is a list
  explicit Option(CLI::Option& option, bool takes_several = false) : option_(&option), takes_several_(takes_several) {}

  Option* required();
  Option* type_name(const std::string& name);
  /// Rejects values that fail `check`, and keeps the others as typed.
  Option* check(Check check);
  /// Rejects values that fail `check`, and replaces the others with its output.
  Option* transform(Check check);
  Option* excludes(const Option* other);
  /// Accepts an empty value, which is otherwise an error.
  Option* may_be_empty();
  /// Makes the option take all values up to the next option.
  Option* take_all();
  /// Allows the option to be given several times, with one value each.
  Option* repeatable();
  /// Number of times that the option was given.
  std::size_t count() const;
  /// The option's arguments as typed: {"-o", "a.exr", "-o", "b.png"}. A value that begins with a dash is one word with
  /// its option: {"--exposure=-1"}.
  std::vector<std::string> arguments() const;
  /// The option's long name: "--output"; empty for a positional argument.
  std::string name() const;
  /// The option's heading in the help.
  std::string heading() const;
  /// Refuses an option of a single value that was given several times: all values but one would be ignored.
  ///
  /// Errors     base::Error(kUsage)
  void require_one() const;

 private:
  CLI::Option* option_;
  bool takes_several_;
  std::vector<std::string> typed_;  ///< values before transform()
};

/// A command with its options, or the program with its commands. Its options and subcommands live as long as it does.
///
/// Domain     the variables that options write to outlive the command
class Command {
 public:
  explicit Command(CLI::App& app) : app_(&app) {}
  Command(const Command&) = delete;
  Command& operator=(const Command&) = delete;

  Command* add_subcommand(const std::string& name, const std::string& description);
  void require_subcommand();
  /// The subcommand with this name.
  ///
  /// Domain     it was added
  const Command& subcommand(const std::string& name) const;
  /// All options and positional arguments, in the order in which they were added.
  const std::deque<Option>& options() const { return options_; }

  // `names` are "-o,--output", or "SCENE" for a positional argument. Parsing writes the value to `variable`. Empty
  // values are errors.
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

  /// The arguments, as typed, of the options listed under a heading of the help.
  std::vector<std::string> arguments(const std::string& heading) const;

  /// Sets the heading, in the program's help, of commands that are added from now on.
  void heading(const std::string& text);
  /// Sets the text below the options in the help.
  void footer(const std::string& text);
  /// Calls the function after parsing, if the command line names this command. Options that were given twice are
  /// refused before.
  void callback(std::function<void()> function);

 private:
  friend class OptionGroup;

  Option* added(CLI::Option& option, bool takes_several = false);

  CLI::App* app_;
  std::string heading_;
  std::deque<Option> options_;
  std::deque<Command> subcommands_;
};

/// During its lifetime, options that are added to a command are listed under its heading in the help.
class OptionGroup {
 public:
  OptionGroup(Command& command, const std::string& heading);
  ~OptionGroup();
  OptionGroup(const OptionGroup&) = delete;
  OptionGroup& operator=(const OptionGroup&) = delete;

 private:
  CLI::App* app_;
  std::string outer_;
};

}  // namespace orrery::cli
