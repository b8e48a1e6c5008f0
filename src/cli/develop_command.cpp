// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include <fmt/core.h>

#include "app/develop_file.h"
#include "base/diagnostic.h"
#include "cli/commands.h"
#include "cli/display_options.h"
#include "cli/messages.h"
#include "cli/option_checks.h"
#include "cli/signals.h"

namespace orrery::cli {
namespace {

struct DevelopOptions {
  app::Development development;
  bool quiet = false;
};

int develop(const DevelopOptions& options) {
  end_on_signals();
  const app::DevelopReport report = app::develop_file(options.development);
  if (options.quiet) return 0;
  for (const std::string& warning : report.display.warnings) print_message(base::warning_line(warning));
  if (const std::uint64_t bad = report.bad_values.nan + report.bad_values.infinite; bad > 0)
    print_message(base::warning_line(
        fmt::format("{} values of {} are not finite and were written as 0", bad, options.development.input.string())));
  return 0;
}

}  // namespace

void add_develop(Command& program, Action& action) {
  const auto options = std::make_shared<DevelopOptions>();
  app::Development& development = options->development;
  development.display.working_space.clear();
  Command& command = *program.add_subcommand("develop", "Apply an OCIO display transform to an EXR or HDR image");
  command.add_option("IN", development.input, "Scene-linear image: EXR or HDR")->required()->type_name("FILE");
  command.add_option("-o,--output", development.outputs, "File to write: PNG, TIFF, JPEG or PPM; can be repeated")
      ->required()
      ->type_name("FILE")
      ->repeatable();
  add_display_options(command, development.display, development.bits, DisplayDefaults::kOfConfig);
  command
      .add_option("--space", development.display.working_space,
                  "Colour space of the input; default: from its header, otherwise lin_rec709")
      ->type_name("NAME");
  command.add_flag("-q,--quiet", options->quiet, "Print only errors");
  command.footer(
      "Examples:\n"
      "  orrery develop final.exr -o final.png --exposure 1\n"
      "  orrery develop final.exr -o book.tif --bits 16 --display \"Gamma 2.0 Rec.709\"");
  command.callback([options, &action] { action = [options] { return develop(*options); }; });
}

}  // namespace orrery::cli
