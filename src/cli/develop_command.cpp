// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "app/develop_file.h"
#include "cli/commands.h"
#include "cli/display_options.h"
#include "cli/signals.h"

namespace orrery::cli {
namespace {

struct DevelopOptions {
  std::filesystem::path input;
  std::vector<std::filesystem::path> outputs;
  display::Settings display;
  int bits = 8;
};

}  // namespace

void add_develop(CLI::App& program, Action& action) {
  const auto options = std::make_shared<DevelopOptions>();
  CLI::App& command = *program.add_subcommand("develop", "Develop an EXR on disk for a display, through OCIO");
  command.add_option("IN", options->input, "Picture with scene-linear light")->required();
  command.add_option("-o,--output", options->outputs, "File to write: png, tiff, jpg or ppm; can be repeated")
      ->required()
      ->type_name("FILE")
      ->take_all()
      ->expected(1);
  add_display_options(command, options->display, options->bits);
  command.add_option("--space", options->display.working_space, "Colour space of the picture; default lin_rec709")->type_name("NAME");
  command.footer("Examples:\n"
                 "  orrery develop final.exr -o final.png --exposure 1\n"
                 "  orrery develop final.exr -o graded.tif --bits 16 --view \"ACES 1.0 SDR Video\"");
  command.callback([options, &action] {
    action = [options] {
      stop_on_signals();
      app::develop_file(options->input, options->outputs, options->display, options->bits);
      return 0;
    };
  });
}

}  // namespace orrery::cli
