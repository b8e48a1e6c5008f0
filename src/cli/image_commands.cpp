// SPDX-License-Identifier: Apache-2.0
// The commands that work on image files: develop and denoise.
#include <memory>
#include <string>

#include <fmt/core.h>

#include "base/error.h"
#include "base/text.h"
#include "cli/commands.h"
#include "cli/messages.h"
#include "cli/options.h"
#include "display/settings.h"
#include "job/image_files.h"

namespace orrery::cli {
namespace {

struct DevelopOptions {
  job::Development development;
  bool quiet = false;
};

void develop(const DevelopOptions& options) {
  const job::DevelopReport report = job::develop_file(options.development);
  if (options.quiet) return;
  for (const std::string& warning : report.display.warnings) print_message(base::warning_line(warning));
  if (const std::uint64_t bad = report.bad_values.nan + report.bad_values.infinite; bad > 0)
    print_message(base::warning_line(
        fmt::format("{} values of {} are not finite and were written as 0", bad, options.development.input.string())));
}

struct DenoiseOptions {
  job::Denoising denoising;
  bool quiet = false;
};

std::string text_of(const job::Denoising& denoising, const job::DenoisedFile& done) {
  const denoise::Report& report = done.report;
  const std::string input = denoising.input.string();
  std::string out =
      fmt::format("wrote {}: beauty and {} light layers\n", denoising.output.string(), report.layers.size());
  const auto warn = [&out](bool is_so, const std::string& text) {
    if (is_so) out += base::warning_line(text);
  };
  warn(done.written.had_attributes, input + " was denoised already and has been filtered again");
  warn(!report.is_filtered,
       input +
           " was not filtered: one half of the samples is missing, so that the noise cannot be measured; render at "
           "least 2 samples per pixel");
  warn(report.bad_pixels > 0,
       fmt::format("{} pixels have no samples, or values that are not finite or too large; they were not changed",
                   report.bad_pixels));
  warn(!done.written.other_parts.empty(),
       fmt::format(
           "the parts {} have separate channels R, G and B and were copied unchanged; to denoise them, save them "
           "as separate files",
           base::joined(done.written.other_parts)));
  warn(done.written.clamped > 0, fmt::format("{} values were clamped to the range of half", done.written.clamped));
  return out;
}

}  // namespace

void add_develop(Command& program) {
  const auto options = std::make_shared<DevelopOptions>();
  job::Development& development = options->development;
  development.display.working_space.clear();
  Command& command = *program.add_subcommand("develop", "Apply an OCIO display transform to an EXR or HDR image");
  command.add_option("IN", development.input, "FILE", "Scene-linear image: EXR or HDR")->required();
  command
      .add_option("-o,--output", development.outputs, "FILE", "File to write: PNG, TIFF, JPEG or PPM; can be repeated")
      ->required()
      ->repeatable();
  add_display_options(command, development.display);
  add_bits_option(command, development.bits);
  command
      .add_option("--space", development.display.working_space, "NAME",
                  "Colour space of the input; default: from its header, otherwise lin_rec709")
      ->details("The header's is colorInteropID.");
  command.add_flag("-q,--quiet", options->quiet, "Print only errors");
  command.footer(
      "Examples:\n"
      "  orrery develop final.exr -o final.png --exposure 1\n"
      "  orrery develop final.exr -o book.tif --bits 16 --display \"Gamma 2.0 Rec.709\"");
  command.act([options] { develop(*options); });
}

void add_denoise(Command& program) {
  const auto options = std::make_shared<DenoiseOptions>();
  Command& command = *program.add_subcommand("denoise", "Denoise an EXR image and its light layers");
  command.add_option("IN", options->denoising.input, "FILE", "EXR image that was rendered with --layers halves")
      ->required();
  command.add_option("-o,--output", options->denoising.output, "FILE", "EXR file to write")->required();
  add_threads_option(command, options->denoising.threads);
  command.add_flag("-q,--quiet", options->quiet, "Print only errors");
  command.details(
      "The light layers are filtered with the same weights, so that they still add up to the beauty. Other channels, "
      "parts, attributes and pixel types are kept.");
  command.footer(
      "Examples:\n"
      "  orrery render scene.toml -o noisy.exr --samples 32 --layers halves,light_groups\n"
      "  orrery denoise noisy.exr -o clean.exr");
  command.act([options] {
    const job::DenoisedFile done = job::denoise_file(options->denoising);
    if (!options->quiet) print_message(text_of(options->denoising, done));
  });
}

}  // namespace orrery::cli
