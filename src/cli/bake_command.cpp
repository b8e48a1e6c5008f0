// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "app/bake_file.h"
#include "cli/commands.h"
#include "cli/display_options.h"
#include "cli/option_checks.h"
#include "cli/signals.h"
#include "display/settings.h"

namespace orrery::cli {
namespace {

/// Smaller cubes are too coarse for a view; other programs do not read larger ones.
constexpr std::uint64_t kSmallestCube = 2, kLargestCube = 129;

struct BakeOptions {
  display::Settings display;
  std::filesystem::path output;
  int size = display::kDefaultCubeSize;
};

}  // namespace

void add_bake(Command& program, Action& action) {
  const auto options = std::make_shared<BakeOptions>();
  Command& command = *program.add_subcommand("bake", "Write a display transform as a look-up table for other programs");
  command
      .add_option("-o,--output", options->output,
                  "File to write: .cube (sampled 3D LUT) or .clf (exact if CLF supports every op of the transform)")
      ->required()
      ->type_name("FILE");
  add_view_options(command, options->display, DisplayDefaults::kOfConfig);
  command.add_option("--space", options->display.working_space, "Input colour space; default: lin_rec709")
      ->type_name("NAME");
  command.add_option("--size", options->size, "3D LUT grid points per axis; default: 65")
      ->transform(whole_number(kSmallestCube, kLargestCube))
      ->type_name("N");
  command.footer(
      "Examples:\n"
      "  orrery bake -o film.cube --view \"ACES 1.0 SDR Video\"\n"
      "  orrery bake -o book.clf --display \"Gamma 2.0 Rec.709\"");
  command.callback([options, &action] {
    action = [options] {
      end_on_signals();
      app::bake_file(options->display, options->size, options->output);
      return 0;
    };
  });
}

}  // namespace orrery::cli
