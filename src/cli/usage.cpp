// SPDX-License-Identifier: Apache-2.0
#include "cli/usage.h"

#include <fmt/core.h>

#include "base/text.h"

namespace orrery::cli {
namespace {

std::vector<std::string> flag_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

std::vector<std::string> command_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* sub : command.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(sub->get_name());
  return names;
}

std::string unknown_flag(const std::string& flag, const CLI::App& command) {
  const std::string remedy = base::did_you_mean(flag, flag_names(command));
  return fmt::format("unknown option {}{}", flag, remedy.empty() ? "" : "; " + remedy);
}

/// The message for a word in place of a command.
std::string unknown_command(const std::string& word, const CLI::App& command) {
  const std::vector<std::string> commands = command_names(command);
  const std::string remedy = base::did_you_mean(word, commands);
  if (!remedy.empty()) return fmt::format("unknown command {}; {}", word, remedy);
  if (command.get_parent() == nullptr && word.ends_with(".toml"))
    return fmt::format("unknown command {}; to render it: orrery render {} -o image.png", word, word);
  return fmt::format("unknown command {}; use one of {}", word, base::joined(commands));
}

std::string unexpected(const std::string& word, const CLI::App& command) {
  if (word.size() > 1 && word[0] == '-') return unknown_flag(word.substr(0, word.find('=')), command);
  if (!command_names(command).empty()) return unknown_command(word, command);
  return fmt::format("unexpected argument `{}`{}", word,
                     base::contains(flag_names(command), "--output") ? "; name output files with -o" : "");
}

/// The first long option that the command does not have. Reported before other errors, since a mistyped option often
/// causes them.
std::string first_unknown_flag(const CLI::App& command, const std::vector<std::string>& words) {
  const std::vector<std::string> names = flag_names(command);
  for (const std::string& word : words) {
    if (word == "--") break;
    const std::string flag = word.substr(0, word.find('='));
    if (flag.size() > 2 && flag.starts_with("--") && !base::contains(names, flag)) return flag;
  }
  return {};
}

}  // namespace

const CLI::App& innermost(const CLI::App& program) {
  const auto chosen = program.get_subcommands();
  return chosen.empty() ? program : innermost(*chosen.front());
}

std::string full_name(const CLI::App& command) {
  const CLI::App* const parent = command.get_parent();
  return (parent == nullptr ? "" : full_name(*parent) + " ") + command.get_name();
}

std::string option_without_value(const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    if (word == "--") break;
    if (word.starts_with("--") && word.find('=') == word.size() - 1) return word.substr(0, word.size() - 1);
  }
  return {};
}

std::string usage_message(const CLI::App& program, const CLI::ParseError& error,
                          const std::vector<std::string>& words) {
  const CLI::App& command = innermost(program);
  if (const std::string flag = first_unknown_flag(command, words); !flag.empty()) return unknown_flag(flag, command);
  const std::vector<std::string> left = command.remaining();
  if (!left.empty()) return unexpected(left.front(), command);
  if (const auto commands = command_names(command); !commands.empty())
    return "no command given; use one of " + base::joined(commands);
  const std::string said = error.what();
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr)
    return said.substr(0, said.find(':')) + " needs a value";
  // Options check their values before conversion, so only flags fail here: "Could not convert: --quiet = ...".
  if (dynamic_cast<const CLI::ConversionError*>(&error) != nullptr)
    if (const std::size_t name = said.find('-'); name != std::string::npos)
      return said.substr(name, said.find(' ', name) - name) + " takes no value";
  return said;
}

}  // namespace orrery::cli
