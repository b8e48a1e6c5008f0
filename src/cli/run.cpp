// SPDX-License-Identifier: Apache-2.0
#include "cli/run.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <new>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include <fmt/core.h>

#include "base/error.h"
#include "base/text.h"
#include "cli/commands.h"
#include "cli/messages.h"
#include "cli/options.h"
#include "cli/signals.h"
#include "job/version.h"

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
  for (const CLI::App* sub : command.get_subcommands([](const CLI::App* sub) { return !sub->get_group().empty(); }))
    names.push_back(sub->get_name());
  return names;
}

/// Commands and options that were removed, and what to write instead.
constexpr std::pair<const char*, const char*> kRemoved[] = {
    {"orrery bake", "ociobakelut, as docs/output.md shows"},
    {"orrery compare --difference", "oiiotool A B --sub -o FILE"},
    {"orrery generate final --moving", "scenes/next-week/01-bouncing-spheres.toml"},
    {"orrery info --measure", "orrery study, which measures the cost of unused features"},
    {"orrery generate env", "scenes/light/studio.exr, or background.type = \"sky\" in the scene"},
    {"orrery generate planet", "scenes/next-week/planet.jpg"},
};

/// Options that users guess, separated by spaces, for commands with a certain option, and what to write instead. The
/// first row that fits counts.
struct Guess {
  std::string_view flags;
  const char *of_commands_with, *instead;
};
constexpr Guess kGuesses[] = {
    {"--view", "--look-from", "--look-from VIEW for the direction, --set color.view=NAME for the display transform"},
    {"--camera --rotate --azimuth --elevation", "--look-from", "--look-from VIEW, or AZIMUTH,ELEVATION"},
    {"--fov", "--perspective", "--perspective VFOV"},
    {"--size --res --resolution", "--width", "--width and --height, in pixels"},
    {"--spp", "--samples", "--samples N"},
    {"--bg", "--background", "--background COLOR"},
    {"--bg --background", "--set", "--set background.color=[R,G,B]"},
    {"--chain --resid --resname", "--select", "--select 'chain A and resid 20:30'"},
    {"--color", "--color-by", "--color-by COLUMN"},
    {"--cmap", "--map", "--map MAP"},
    {"--alpha", "--opacity", "--opacity X"},
    {"--movie --film", "--turntable", "-o FILE.mp4 with --frames or --turntable"},
    {"--diff", "--heat", "--heat FILE for the error of each pixel"},
    {"--ocio", "--set", "--set color.config=FILE, relative to the scene file"},
    {"--display", "--set", "--set color.display=NAME"},
    {"--view", "--set", "--set color.view=NAME"},
    {"--look", "--set", "--set color.look=NAME"},
    {"--exposure", "--set", "--set color.exposure=STOPS"},
    {"--fov", "--set", "--set camera.vfov=DEGREES"},
    {"--seed", "--set", "--set render.seed=N"},
    {"--max-depth", "--set", "--set render.max_depth=N"},
    {"--accelerator", "--set", "--set render.accelerator=NAME"},
    {"--isa", "--set", "the environment variable ORRERY_ISA=NAME"},
    {"--log", "--set", "2>> FILE, after the command"},
    {"--fail-fast", "--set", "one command for each frame or scene"}};

/// The message for a word that the command had; empty if it never had it.
std::string removed_message(const std::string& word, const CLI::App& command) {
  const std::string name = full_name(command) + " " + word;
  for (const auto& [removed, instead] : kRemoved)
    if (name == removed) return fmt::format("{} was removed; use {}", word, instead);
  return {};
}

std::string unknown_flag(const std::string& flag, const CLI::App& command) {
  if (std::string message = removed_message(flag, command); !message.empty()) return message;
  const std::vector<std::string> names = flag_names(command);
  for (const auto& [flags, of_commands_with, instead] : kGuesses)
    if (base::contains(names, of_commands_with) &&
        fmt::format(" {} ", flags).find(" " + flag + " ") != std::string::npos)
      return fmt::format("unknown option {}; use {}", flag, instead);
  const std::string remedy = base::did_you_mean(flag, names);
  return fmt::format("unknown option {}{}", flag, remedy.empty() ? "" : "; " + remedy);
}

/// The message for a word in place of a command.
std::string unknown_command(const std::string& word, const CLI::App& command) {
  if (std::string message = removed_message(word, command); !message.empty()) return message;
  const std::vector<std::string> commands = command_names(command);
  const std::string remedy = base::did_you_mean(word, commands);
  if (!remedy.empty()) return fmt::format("unknown command {}; {}", word, remedy);
  if (command.get_parent() == nullptr && word.ends_with(".toml"))
    return fmt::format("unknown command {0}; to render it: orrery render {0} -o image.png", base::shell_quoted(word));
  return fmt::format("unknown command {}; use one of {}", word, base::joined(commands));
}

std::string unexpected(const std::string& word, const CLI::App& command) {
  std::error_code unknown;
  if (word.starts_with('-') && std::filesystem::exists(word, unknown))
    return fmt::format("`{0}` is read as an option; for the file of this name, write ./{0}", word);
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

/// The message for an option whose value was left out, so that the next option would become the value; empty if there
/// is none. With `=` a value can begin with two dashes.
std::string option_before_option(const CLI::App& command, const std::vector<std::string>& words) {
  for (std::size_t i = 0; i + 1 < words.size() && words[i] != "--"; ++i) {
    const CLI::Option* const option = words[i].starts_with('-') ? command.get_option_no_throw(words[i]) : nullptr;
    if (option == nullptr || option->get_items_expected_max() == 0 || words[i + 1].size() < 3 ||
        !words[i + 1].starts_with("--"))
      continue;
    return fmt::format("{} needs a value, {}; {} follows", words[i], option->get_type_name(), words[i + 1]);
  }
  return {};
}

/// The innermost command that argv names; the program itself if it names none.
const CLI::App& innermost(const CLI::App& program) {
  const auto chosen = program.get_subcommands();
  return chosen.empty() ? program : innermost(*chosen.front());
}

std::string versions_text() {
  std::string out = fmt::format("orrery {}\n", job::program_version());
  for (const auto& [name, version] : job::library_versions()) out += fmt::format("  {} {}\n", name, version);
  return out + "  CLI11 " CLI11_VERSION;
}

/// Help without the type of positional arguments, which is their name.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option_opts(const CLI::Option* option) const override {
    if (!option->get_positional()) return Formatter::make_option_opts(option);
    return option->get_items_expected_max() > 1 ? " ..." : "";
  }

  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    return make_description(app) + make_usage(app, std::move(name)) + make_positionals(app) + options_text(app) +
           make_subcommands(app, mode) + "\n" + make_footer(app);
  }

 private:
  /// What to write comes first, since it is required, and options without a heading come last.
  std::string options_text(const CLI::App* app) const {
    std::vector<std::string> groups = app->get_groups();
    const auto place = [](const std::string& group) { return group == kImageOptions ? 0 : group == "Options" ? 2 : 1; };
    std::stable_sort(groups.begin(), groups.end(),
                     [&](const std::string& a, const std::string& b) { return place(a) < place(b); });
    std::string out;
    for (const std::string& group : groups) {
      const auto options = app->get_options([&](const CLI::Option* option) {
        return !group.empty() && option->get_group() == group && option->nonpositional();
      });
      if (!options.empty()) out += make_group(group, false, options);
    }
    return out;
  }
};

void configure(CLI::App& program) {
  program.formatter(std::make_shared<HelpFormatter>());
  program.set_version_flag("--version", versions_text, "Print the versions of the program and its libraries and exit");
  program.set_help_flag("-h,--help", "Print this help message and exit");
  program.require_subcommand(1);
  program.get_formatter()->column_width(34);
  // Command::run() refuses options that are given twice, with a better message. Flags may be repeated.
  program.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  program.footer(
      "Examples:\n"
      "  orrery plot melt.dump -o melt.png\n"
      "  orrery render scene.toml -o image.png\n\n"
      "orrery COMMAND --help lists the options of a command, with examples.");
}

void add_commands(Command& program) {
  program.heading("Render");
  add_render(program);
  add_plot(program);
  add_view(program);
  add_merge(program);
  add_submit(program);
  program.heading("Inspect");
  add_check(program);
  add_info(program);
  add_compare(program);
  program.heading("Measure");
  add_bench(program);
  add_study(program);
  program.heading("Scenes and data");
  add_generate(program);
  add_convert(program);
  program.heading("Images");
  add_develop(program);
  add_denoise(program);
  add_documents(program);
}

/// Prints the text of --help or --version.
int print_success(const CLI::App& program, const CLI::Success& success) {
  std::ostringstream text, nothing;
  program.exit(success, text, nothing);
  print_result(text.str());
  return 0;
}

int print_usage_error(const CLI::App& program, const CLI::ParseError& error, const std::vector<std::string>& words) {
  print_message(base::printable_lines(fmt::format("orrery: {}\nTry {} --help.\n", usage_message(program, error, words),
                                                  full_name(innermost(program)))));
  return base::exit_status(base::ErrorKind::kUsage);
}

/// Whether the words have --progress json. Looked for before they are parsed: errors in them are messages, too.
bool asks_for_json(const std::vector<std::string>& words) {
  for (std::size_t i = 0; i < words.size() && words[i] != "--"; ++i)
    if (words[i] == "--progress=json" || (words[i] == "--progress" && i + 1 < words.size() && words[i + 1] == "json"))
      return true;
  return false;
}

int parse_and_act(int argc, const char* const* argv) {
  const std::vector<std::string> words(argv + (argc > 0 ? 1 : 0), argv + argc);
  if (asks_for_json(words)) use_json_messages();
  if (const std::string option = option_without_value(words); !option.empty())
    base::refuse(fmt::format("{} needs a value; none follows `{}=`", option, option));
  CLI::App program("orrery is a path tracer for scenes made of spheres and rods.", "orrery");
  configure(program);
  Command commands(program);
  add_commands(commands);
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& success) {
    return print_success(program, success);
  } catch (const CLI::ParseError& error) {
    return print_usage_error(program, error, words);
  }
  if (const std::string left_out = option_before_option(innermost(program), words); !left_out.empty())
    base::refuse(left_out);
  return commands.run();
}

}  // namespace

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
  if (std::string left_out = option_before_option(command, words); !left_out.empty()) return left_out;
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

void parse_words(std::vector<std::string> words, const std::function<void(Command&)>& add_options,
                 const std::function<void()>& use) {
  CLI::App program("", "orrery view");
  configure(program);
  program.require_subcommand(0);
  Command command(program);
  add_options(command);
  const std::vector<std::string> typed = words;
  std::reverse(words.begin(), words.end());  // as CLI11 wants them
  try {
    program.parse(words);
  } catch (const CLI::ParseError& error) {
    base::refuse(usage_message(program, error, typed));
  }
  use();
}

int run(int argc, const char* const* argv) {
  prepare_signals();
  try {
    return parse_and_act(argc, argv);
  } catch (const base::Error& error) {
    return print_error(error);
  } catch (const std::bad_alloc&) {
    print_message("orrery: out of memory; end other programs, or raise the limit of the shell (ulimit -v)\n");
    return base::exit_status(base::ErrorKind::kNoMemory);
  } catch (const std::exception& error) {
    print_message(fmt::format("orrery: internal error: {}\n", error.what()));
  }
  return base::exit_status(base::ErrorKind::kInternal);
}

}  // namespace orrery::cli
