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

// The part of CLI11 that commands use, without its headers, which take several seconds to compile. Only arguments.cpp
// and run.cpp include them.

/// Checks the text of an argument, and may replace it. Returns an error message, or an empty string.
using Check = std::function<std::string(std::string& value)>;

// Checks of option values. They replace CLI11's own, whose messages differ between versions. Those that convert the
// value need Option::transform(); Option::check() keeps the typed text.

/// Maximum number of threads: more than any machine has.
inline constexpr std::uint64_t kMaxThreads = 4096;

/// Rejects a word that is not one of `names`, and suggests the closest one.
Check one_of(std::vector<std::string> names);

/// Accepts an integer in from..to. Removes leading zeros, which CLI11 would interpret as octal.
Check whole_number(std::uint64_t from, std::uint64_t to);

/// Accepts a finite number in from..to.
Check real_number(double from, double to);

/// Accepts a size such as 512M or 1.5G and converts it to bytes; K, M, G and T are powers of 1024.
Check byte_size();

/// Accepts a time from 0.01 seconds to a year, such as 90s, 5m, 1.5h or 1h30m, and converts it to seconds.
Check duration();

/// The name of a command as it is typed: "orrery generate final".
std::string full_name(const CLI::App& command);

/// An option or a positional argument, as help, manual and completions show it.
struct OptionText {
  std::vector<std::string> names;  ///< "-o", "--output"; "SCENE" for a positional argument
  std::string type;                ///< "FILE"; empty: a flag
  std::string description;
  std::string details;               ///< further sentences of the manual
  std::string heading;               ///< "Image options"
  std::vector<std::string> choices;  ///< values, if they are words of a list
  bool is_required = false, is_repeatable = false;
};

/// An option or a positional argument.
class Option {
 public:
  /// `takes_several`  its variable is a list
  explicit Option(CLI::Option& option, bool takes_several = false) : option_(&option), takes_several_(takes_several) {}

  Option* required();
  /// Accepts only these words.
  Option* choices(std::vector<std::string> words);
  /// Adds sentences that only the manual has.
  Option* details(const char* sentences);
  /// Rejects values that fail `check`, and keeps the others as typed.
  Option* check(Check check);
  /// Rejects values that fail `check`, and replaces the others with its output.
  Option* transform(Check check);
  /// Accepts an empty value, which is otherwise an error.
  Option* may_be_empty();
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
  OptionText text() const;
  /// Refuses an option of a single value that was given several times: all values but one would be ignored.
  ///
  /// Errors     base::Error(kUsage)
  void require_one() const;

 private:
  CLI::Option* option_;
  bool takes_several_;
  std::vector<std::string> typed_;  ///< values before transform()
  std::vector<std::string> choices_;
  const char* details_ = "";
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
  /// Hides the command in the help and in the manual.
  void hide();
  std::string full_name() const { return cli::full_name(*app_); }
  std::string name() const;
  std::string description() const;
  bool is_hidden() const;
  /// Adds sentences that only the manual has.
  void details(const char* sentences) { details_ = sentences; }
  const char* details() const { return details_; }
  const std::string& footer() const { return footer_; }
  const std::deque<Command>& subcommands() const { return subcommands_; }
  /// All options and positional arguments, in the order in which they were added.
  const std::deque<Option>& options() const { return options_; }

  // `names` are "-o,--output", or "SCENE" for a positional argument; `type` names the value in the help. Parsing writes
  // the value to `variable`. Empty values are errors.
  template <class Variable>
  Option* add_option(const std::string& names, Variable& variable, const std::string& type,
                     const std::string& description);
  Option* add_flag(const std::string& names, bool& variable, const std::string& description);

  /// The arguments, as typed, of some options.
  std::vector<std::string> arguments(const std::function<bool(const Option&)>& is_wanted) const;

  /// Sets the heading, in the program's help, of commands that are added from now on.
  void heading(const std::string& text);
  /// Sets the text below the options in the help.
  void footer(const std::string& text);
  /// Sets what the command does; `run` returns the exit status.
  void action(std::function<int()> run);
  /// The same for a command that cannot stop midway: a signal ends the process.
  void act(std::function<void()> run);
  /// Runs the command that the command line named, after refusing options that were given twice. Of the program.
  int run() const;

 private:
  friend class OptionGroup;

  /// Adds what all options with a value have.
  Option* added(CLI::Option& option, const std::string& type, bool takes_several);

  CLI::App* app_;
  std::string heading_, footer_;
  const char* details_ = "";
  std::function<int()> action_;
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
