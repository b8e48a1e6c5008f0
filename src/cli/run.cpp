// SPDX-License-Identifier: Apache-2.0
#include "cli/run.h"

#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "app/version.h"
#include "base/error.h"
#include "base/exit_status.h"
#include "base/suggestion.h"
#include "cli/commands.h"

namespace orrery::cli {
namespace {

std::string versions_text() {
  std::string out = "orrery " + app::program_version() + "\n";
  for (const auto& [name, version] : app::library_versions()) out += "  " + name + " " + version + "\n";
  return out + "  CLI11 " CLI11_VERSION;
}

/// The command that argv has got into: the last one that was named.
const CLI::App& innermost(const CLI::App& program) {
  const auto chosen = program.get_subcommands();
  return chosen.empty() ? program : innermost(*chosen.front());
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

std::vector<std::string> command_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* sub : command.get_subcommands([](const CLI::App*) { return true; })) names.push_back(sub->get_name());
  return names;
}

/// CLI11 says that something is too much; people want to know what they should have typed.
std::string usage_message(const CLI::App& program, const CLI::ParseError& error, const std::vector<std::string>& words) {
  const CLI::App& command = innermost(program);
  for (const std::string& word : words) {
    const std::string flag = word.substr(0, word.find('='));
    const auto names = option_names(command);
    if (flag.rfind("--", 0) == 0 && flag.size() > 2 && std::find(names.begin(), names.end(), flag) == names.end()) {
      const std::string remedy = base::did_you_mean(flag, names);
      return "unknown flag " + flag + (remedy.empty() ? "" : "; " + remedy);
    }
  }
  const auto commands = command_names(command);
  if (!commands.empty() && !words.empty() && command.get_subcommands().empty()) {
    const std::string& word = &command == &program ? words.front() : words.back();
    if (word[0] != '-' && std::find(commands.begin(), commands.end(), word) == commands.end()) {
      const std::string remedy = base::did_you_mean(word, commands);
      return "unknown command " + word + "; " + (remedy.empty() ? "there are " + base::joined(commands) : remedy);
    }
  }
  return error.what();
}

int usage_error(const std::string& message) {
  std::fprintf(stderr, "orrery: %s\nTry orrery --help.\n", message.c_str());
  return base::exit_status(base::ErrorKind::kUsage);
}

int report(const base::Error& error) {
  for (const base::Finding& finding : error.findings()) std::fputs(base::formatted(finding).c_str(), stderr);
  std::fprintf(stderr, "orrery: %s\n", error.what());
  return base::exit_status(error.kind());
}

}  // namespace

int run(int argc, const char* const* argv) {
  CLI::App program("orrery renders scenes made of spheres, fast and right.", "orrery");
  Action action;
  program.set_version_flag("--version", versions_text());
  program.require_subcommand(1);
  program.get_formatter()->column_width(34);
  add_render(program, action);
  add_info(program, action);
  add_check(program, action);
  add_generate(program, action);
  add_develop(program, action);
  program.footer("orrery COMMAND --help tells more, with examples.");
  const std::vector<std::string> words(argv + (argc > 0 ? 1 : 0), argv + argc);
  try {
    program.parse(argc, argv);
    return action();
  } catch (const CLI::Success& success) {
    return program.exit(success);  // --help, --version
  } catch (const CLI::ParseError& error) {
    return usage_error(words.empty() ? "a command is missing" : usage_message(program, error, words));
  } catch (const base::Error& error) {
    return report(error);
  } catch (const std::bad_alloc&) {
    std::fputs("orrery: out of memory; orrery info SCENE tells how much a scene needs\n", stderr);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "orrery: internal failure: %s\n", error.what());
  }
  return base::exit_status(base::ErrorKind::kInternal);
}

}  // namespace orrery::cli
