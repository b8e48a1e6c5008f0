// SPDX-License-Identifier: Apache-2.0
// The hidden command `documents`, by which the build writes the manual page and the shell completions from the options.
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "base/text.h"
#include "cli/commands.h"
#include "cli/messages.h"

namespace orrery::cli {
namespace {

/// The commands that do something, e.g. `generate final` but not `generate`.
std::vector<const Command*> leaves_of(const Command& command) {
  if (command.subcommands().empty()) return {&command};
  std::vector<const Command*> out;
  for (const Command& sub : command.subcommands()) {
    if (sub.is_hidden()) continue;
    const std::vector<const Command*> leaves = leaves_of(sub);
    out.insert(out.end(), leaves.begin(), leaves.end());
  }
  return out;
}

/// The name without the program: "generate final".
std::string short_name(const Command& command) {
  const std::string name = command.full_name();
  return name.substr(name.find(' ') + 1);
}

bool is_positional(const OptionText& option) { return option.names.front()[0] != '-'; }

std::vector<std::string> names_of(const std::deque<Command>& commands) {
  std::vector<std::string> out;
  for (const Command& command : commands)
    if (!command.is_hidden()) out.push_back(command.name());
  return out;
}

// --------------------------------------------------------------------------------------------- manual page

/// Text of an mdoc page.
std::string roff(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_line_start = i == 0 || text[i - 1] == '\n';
    const bool is_word_start = is_line_start || std::string(" (`'\"-").find(text[i - 1]) != std::string::npos;
    if (is_line_start && (text[i] == '.' || text[i] == '\'')) out += "\\&";
    if (text[i] == '\\') {
      out += "\\e";
    } else if (text[i] == '-' && is_word_start) {
      out += "\\-";  // a minus, not a hyphen
    } else {
      out += text[i];
    }
  }
  return out;
}

std::string sentence(const std::string& text) { return roff(text) + (text.ends_with('.') ? "\n" : ".\n"); }

/// "Fl t , Fl Fl threads Ar N".
std::string mdoc_name(const OptionText& option) {
  if (is_positional(option)) return fmt::format("Ar {}{}", option.names.front(), option.is_repeatable ? " ..." : "");
  std::string out;
  for (const std::string& name : option.names)
    out += fmt::format("{}Fl {}{}", out.empty() ? "" : " , ", name[1] == '-' ? "Fl " : "",
                       name.substr(name[1] == '-' ? 2 : 1));
  return option.type.empty() ? out : out + " Ar " + option.type;
}

std::string mdoc_synopsis(const std::vector<const Command*>& commands) {
  std::string out;
  for (const Command* command : commands) {
    out += fmt::format(".Nm orrery Cm {}\n", short_name(*command));
    for (const bool wants_positional : {true, false}) {
      for (const Option& option : command->options()) {
        OptionText text = option.text();
        if (!text.is_required || is_positional(text) != wants_positional) continue;
        text.names.resize(1);
        out += fmt::format(".{}{}\n", mdoc_name(text), text.is_repeatable && !wants_positional ? " ..." : "");
      }
    }
    out += ".Op Ar option ...\n";
  }
  return out;
}

/// The section of each command. An option that an earlier command has, with the same text, is named only.
std::string mdoc_commands(const std::vector<const Command*>& commands) {
  std::map<std::string, std::string> first_with;
  std::string out;
  for (const Command* command : commands) {
    const std::string name = short_name(*command);
    std::string own;
    std::map<std::string, std::string> shared;  // by the command that describes them
    for (const Option& option : command->options()) {
      const OptionText text = option.text();
      const std::string item = fmt::format(".It {}\n{}{}", mdoc_name(text), sentence(text.description),
                                           text.details.empty() ? "" : sentence(text.details));
      const std::string& first = first_with.emplace(item, name).first->second;
      if (first == name) {
        own += item;
      } else {
        shared[first] += fmt::format("{}{}", shared[first].empty() ? "" : " , ", mdoc_name(text));
      }
    }
    out += fmt::format(".Ss orrery {}\n{}", name, sentence(command->description()));
    if (command->details()[0] != '\0') out += sentence(command->details());
    if (!own.empty()) out += fmt::format(".Bl -tag -width Ds\n{}.El\n", own);
    for (const auto& [first, options] : shared) out += fmt::format(".Pp\nAs for\n.Cm {} :\n.{} .\n", first, options);
    if (!command->footer().empty()) out += fmt::format(".Bd -literal\n{}\n.Ed\n", roff(command->footer()));
  }
  return out;
}

// ----------------------------------------------------------------------------------------------- completions

/// The description for a list of completions: without what follows a semicolon.
std::string brief(const std::string& description) { return description.substr(0, description.find(';')); }

std::string bash_completion(const Command& program) {
  std::string find, values;
  std::string words =
      fmt::format("    '') words='{} --help --version' ;;\n", base::joined(names_of(program.subcommands()), " "));
  const auto add = [&](const std::string& outer, const Command& command) {
    const std::string name = outer.empty() ? command.name() : outer + " " + command.name();
    find += fmt::format("      '{} {}') command='{}' ;;\n", outer, command.name(), name);
    std::string own = command.subcommands().empty() ? "--help" : base::joined(names_of(command.subcommands()), " ");
    for (const Option& option : command.options()) {
      const OptionText text = option.text();
      if (is_positional(text)) continue;
      own += " " + text.names.back();
      if (text.choices.empty()) continue;
      values += fmt::format("    '{} {}') COMPREPLY=($(compgen -W '{}' -- \"$current\")); return ;;\n", name,
                            text.names.back(), base::joined(text.choices, " "));
    }
    words += fmt::format("    '{}') words='{}' ;;\n", name, own);
  };
  for (const Command& command : program.subcommands()) {
    if (command.is_hidden()) continue;
    add("", command);
    for (const Command& sub : command.subcommands()) add(command.name(), sub);
  }
  return fmt::format(R"(# bash completion of orrery
_orrery() {{
  local command='' words='' i current=${{COMP_WORDS[COMP_CWORD]}}
  for ((i = 1; i < COMP_CWORD; ++i)); do
    case "$command ${{COMP_WORDS[i]}}" in
{}    esac
  done
  case "$command ${{COMP_WORDS[COMP_CWORD - 1]}}" in
{}  esac
  case $command in
{}  esac
  # Other words are names of files.
  [[ $current == -* || -z $command || $command == generate ]] && COMPREPLY=($(compgen -W "$words" -- "$current"))
}}
complete -o default -F _orrery orrery
)",
                     find, values, words);
}

using base::quoted;

std::string zsh_escaped(const std::string& text) {
  std::string out;
  for (const char c : text) out += (c == '[' || c == ']' || c == ':' ? "\\" : "") + std::string(1, c);
  return out;
}

std::string zsh_arguments(const Command& command) {
  std::string out = "_arguments -S '(- *)'{-h,--help}'[print help]'";
  for (const Option& option : command.options()) {
    const OptionText text = option.text();
    const std::string values = text.choices.empty() ? (text.type == "FILE" ? "_files" : "")
                                                    : fmt::format("({})", base::joined(text.choices, " "));
    if (is_positional(text)) {
      out += " " + quoted(fmt::format("{}:{}:{}", text.is_repeatable ? "*" : "", text.names.front(), values));
      continue;
    }
    const std::string names = text.names.size() == 1 ? text.names.front() : "{" + base::joined(text.names, ",") + "}";
    const std::string alone = text.is_repeatable ? "*" : "(" + base::joined(text.names, " ") + ")";
    out += fmt::format(" '{}'{}{}", alone, names,
                       quoted("[" + zsh_escaped(brief(text.description)) + "]" +
                              (text.type.empty() ? "" : fmt::format(":{}:{}", zsh_escaped(text.type), values))));
  }
  return out;
}

/// The choice of a command, at the first word that is not yet consumed.
std::string zsh_choice(const Command& command) {
  if (command.subcommands().empty()) return zsh_arguments(command);
  std::string list, cases;
  for (const Command& sub : command.subcommands()) {
    if (sub.is_hidden()) continue;
    list += " " + quoted(sub.name() + ":" + zsh_escaped(sub.description()));
    cases += fmt::format("{}) shift words; (( CURRENT-- )); {} ;;\n", sub.name(), zsh_choice(sub));
  }
  return fmt::format(
      "if (( CURRENT == 2 )); then\ncommands=({})\n_describe command commands\nelse case $words[2] in\n{}esac\nfi",
      list, cases);
}

std::string zsh_completion(const Command& program) {
  return fmt::format("#compdef orrery\n_orrery() {{\nlocal -a commands\n{}\n}}\n_orrery \"$@\"\n", zsh_choice(program));
}

std::string fish_completion(const Command& program) {
  std::string out = "# fish completion of orrery\n";
  const auto add = [&](const Command& command, const std::string& condition) {
    out += fmt::format("complete -c orrery -n {} -f -a {} -d {}\n", quoted(condition), command.name(),
                       quoted(command.description()));
    for (const Option& option : command.options()) {
      const OptionText text = option.text();
      if (is_positional(text)) continue;
      out += fmt::format("complete -c orrery -n '__fish_seen_subcommand_from {}'", command.name());
      for (const std::string& name : text.names)
        out += name[1] == '-' ? " -l " + name.substr(2) : " -s " + name.substr(1);
      if (!text.type.empty()) out += text.type == "FILE" ? " -r" : " -x";
      if (!text.choices.empty()) out += " -a " + quoted(base::joined(text.choices, " "));
      out += fmt::format(" -d {}\n", quoted(brief(text.description)));
    }
  };
  for (const Command& command : program.subcommands()) {
    if (command.is_hidden()) continue;
    add(command, "__fish_use_subcommand");
    const std::string subs = base::joined(names_of(command.subcommands()), " ");
    for (const Command& sub : command.subcommands())
      add(sub,
          fmt::format("__fish_seen_subcommand_from {}; and not __fish_seen_subcommand_from {}", command.name(), subs));
  }
  return out;
}

}  // namespace

void add_documents(Command& program) {
  struct Arguments {
    std::string kind;
    std::filesystem::path page;
  };
  const auto arguments = std::make_shared<Arguments>();
  Command& command = *program.add_subcommand("documents", "Print the manual page or completions of a shell");
  command.hide();
  command.add_option("KIND", arguments->kind, "KIND", "Manual page, or shell")
      ->choices({"man", "bash", "zsh", "fish"})
      ->required();
  command.add_option("PAGE", arguments->page, "FILE", "Manual page without the commands");
  command.action([arguments, &program] {
    const std::string& kind = arguments->kind;
    if (kind == "man") {
      const std::vector<const Command*> commands = leaves_of(program);
      std::ifstream in(arguments->page);
      const std::string text(std::istreambuf_iterator<char>(in), {});
      const std::string page = base::replaced(text, "@SYNOPSIS@\n", mdoc_synopsis(commands));
      print_result(base::replaced(page, "@COMMANDS@\n", mdoc_commands(commands)));
    } else {
      print_result(kind == "bash"  ? bash_completion(program)
                   : kind == "zsh" ? zsh_completion(program)
                                   : fish_completion(program));
    }
    return 0;
  });
}

}  // namespace orrery::cli
