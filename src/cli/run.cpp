// SPDX-License-Identifier: Apache-2.0
#include "cli/run.h"

#include <cstdio>
#include <exception>
#include <new>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "base/error.h"
#include "cli/commands.h"
#include "cli/messages.h"
#include "cli/option_checks.h"
#include "cli/output.h"
#include "cli/signals.h"
#include "cli/usage.h"
#include "job/version.h"

namespace orrery::cli {
namespace {

std::string versions_text() {
  std::string out = fmt::format("orrery {}\n", job::program_version());
  for (const auto& [name, version] : job::library_versions()) out += fmt::format("  {} {}\n", name, version);
  return out + "  CLI11 " CLI11_VERSION;
}

void configure(CLI::App& program) {
  program.set_version_flag("--version", versions_text, "Print the versions of the program and its libraries and exit");
  program.set_help_flag("-h,--help", "Print this help message and exit");
  program.require_subcommand(1);
  program.get_formatter()->column_width(34);
  // Command::callback() refuses options that are given twice, with a better message. Flags may be repeated.
  program.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  program.footer("orrery COMMAND --help lists the options of a command, with examples.");
}

void add_commands(Command& program, Action& action) {
  program.heading("Render");
  add_render(program, action);
  add_plot(program, action);
  add_merge(program, action);
  add_submit(program, action);
  program.heading("Inspect");
  add_check(program, action);
  add_info(program, action);
  add_compare(program, action);
  program.heading("Measure");
  add_bench(program, action);
  add_study(program, action);
  program.heading("Scenes and data");
  add_generate(program, action);
  add_convert(program, action);
  program.heading("Images");
  add_develop(program, action);
  add_denoise(program, action);
  add_bake(program, action);
}

/// Prints the text of --help or --version.
int print_success(const CLI::App& program, const CLI::Success& success) {
  std::ostringstream text, nothing;
  program.exit(success, text, nothing);
  print_result(text.str());
  return 0;
}

int print_usage_error(const CLI::App& program, const CLI::ParseError& error, const std::vector<std::string>& words) {
  std::fprintf(stderr, "orrery: %s\nTry %s --help.\n", usage_message(program, error, words).c_str(),
               full_name(innermost(program)).c_str());
  return base::exit_status(base::ErrorKind::kUsage);
}

int parse_and_act(int argc, const char* const* argv) {
  const std::vector<std::string> words(argv + (argc > 0 ? 1 : 0), argv + argc);
  if (const std::string option = option_without_value(words); !option.empty())
    base::refuse(fmt::format("{} needs a value; none follows `{}=`", option, option));
  CLI::App program("orrery is a path tracer for scenes made of spheres.", "orrery");
  configure(program);
  Command commands(program);
  Action action;
  add_commands(commands, action);
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& success) {
    return print_success(program, success);
  } catch (const CLI::ParseError& error) {
    return print_usage_error(program, error, words);
  }
  return action();
}

}  // namespace

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
