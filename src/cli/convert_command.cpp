// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>

#include <fmt/core.h>

#include "base/available_memory.h"
#include "base/error.h"
#include "base/text.h"
#include "cli/commands.h"
#include "cli/messages.h"
#include "cli/plot_options.h"
#include "plot/convert.h"

namespace orrery::cli {
namespace {

struct ConvertArguments {
  plot::ConvertOptions convert;
  DataArguments data;
  bool quiet = false;
};

void print_file(const plot::ConvertedFile& written, bool quiet) {
  std::string text;
  for (const base::Diagnostic& warning : written.warnings) text += base::formatted(warning);
  if (!quiet) {
    const std::string name = written.file.string();
    text += base::printable(fmt::format("wrote {}: {}; columns {}", name, base::counted(written.spheres, "sphere"),
                                        base::joined(written.columns))) +
            "\n";
    for (const std::string& note : written.notes)
      text += base::printable(fmt::format("note: {}: {}", name, note)) + "\n";
  }
  print_message(text);
}

void run_convert(ConvertArguments& arguments) {
  plot::ConvertOptions& convert = arguments.convert;
  arguments.data.read(convert);
  if (convert.color_by.empty() && (convert.has_map || convert.range.is_set))
    base::refuse("--map and --range need --color-by");
  convert.memory_limit = base::available_memory().value_or(0);
  plot::convert(convert, [&](const plot::ConvertedFile& written) { print_file(written, arguments.quiet); });
}

}  // namespace

void add_convert(Command& program) {
  const auto arguments = std::make_shared<ConvertArguments>();
  Command& command = *program.add_subcommand("convert", "Write the spheres of a data file as PLY, XYZ, NPY or CSV");
  plot::ConvertOptions& convert = arguments->convert;
  command.add_option("-o,--output", convert.output, "FILE", "File to write: .ply, .xyz (extended), .npy or .csv")
      ->details("PLY is binary, NPY a structured array.")
      ->required();
  command.add_flag("-q,--quiet", arguments->quiet, "Print only errors and warnings");
  arguments->data.add_to(command, convert);
  arguments->data.add_frames_to(command);
  command.details(
      "The spheres are selected, unwrapped, replicated and sliced. Colours are sRGB, 8 bits. Copies of a particle have "
      "the same values in the other columns. If the file has particle ids, they give the order. Columns that a format "
      "cannot store are omitted, with a note: strings in PLY; in XYZ, strings that are empty or contain spaces.");
  command.footer(
      "Columns: x, y, z; radius and red, green, blue if they are defined; then the other columns of the file.\n"
      "\n"
      "Examples:\n"
      "  orrery convert melt.dump -o melt.ply --select 'type == 2' --radius 0.5\n"
      "  orrery convert 1M4X.pdb -o virus.npy --assembly 1 --element-radii vdw\n"
      "  orrery convert pour.dump -o pour.####.ply --frames all --color-by speed --map viridis");
  command.act([arguments] { run_convert(*arguments); });
}

}  // namespace orrery::cli
