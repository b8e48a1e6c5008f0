// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <memory>
#include <string>

#include <fmt/core.h>

#include "app/denoise_file.h"
#include "base/diagnostic.h"
#include "base/text.h"
#include "cli/commands.h"
#include "cli/messages.h"
#include "cli/option_checks.h"
#include "cli/signals.h"

namespace orrery::cli {
namespace {

struct DenoiseOptions {
  app::Denoising denoising;
  bool quiet = false;
};

std::string text_of(const app::Denoising& denoising, const app::DenoisedFile& done) {
  const denoise::Report& report = done.report;
  std::string out =
      fmt::format("wrote {}: beauty and {} light layers\n", denoising.output.string(), report.layers.size());
  if (done.written.had_attributes)
    out += base::warning_line(
        fmt::format("{} was denoised already and has been filtered again", denoising.input.string()));
  if (!report.missing.empty())
    out += base::warning_line(
        fmt::format("{} lacks the layers {}: {}; render with --layers halves for the best result",
                    denoising.input.string(), base::joined(report.missing),
                    report.has_guides ? "noise was estimated from the beauty" : "only the beauty guided the filter"));
  if (report.bad_pixels > 0)
    out += base::warning_line(
        fmt::format("{} pixels have no samples, or values that are not finite or too large; they were not changed",
                    report.bad_pixels));
  if (!done.written.other_parts.empty())
    out +=
        base::warning_line(fmt::format("the parts {} have separate channels R, G and B and were copied unchanged; to "
                                       "denoise them, save them as separate files",
                                       base::joined(done.written.other_parts)));
  if (done.written.clamped > 0)
    out += base::warning_line(fmt::format("{} values were clamped to the range of half", done.written.clamped));
  return out;
}

int denoise(const DenoiseOptions& options) {
  end_on_signals();
  const app::DenoisedFile done = app::denoise_file(options.denoising);
  if (!options.quiet) print_message(text_of(options.denoising, done));
  return 0;
}

}  // namespace

void add_denoise(Command& program, Action& action) {
  const auto options = std::make_shared<DenoiseOptions>();
  Command& command = *program.add_subcommand("denoise", "Denoise an EXR image and its light layers");
  command.add_option("IN", options->denoising.input, "EXR image; best rendered with --layers halves")
      ->required()
      ->type_name("FILE");
  command.add_option("-o,--output", options->denoising.output, "EXR file to write")->required()->type_name("FILE");
  command
      .add_option("-t,--threads", options->denoising.threads,
                  "Number of threads; default: all CPUs available to the process")
      ->transform(whole_number(1, kMaxThreads))
      ->type_name("N");
  command.add_flag("-q,--quiet", options->quiet, "Print only errors");
  command.footer(
      "Examples:\n"
      "  orrery render scene.toml -o noisy.exr --samples 32 --layers halves,light_groups\n"
      "  orrery denoise noisy.exr -o clean.exr");
  command.callback([options, &action] { action = [options] { return denoise(*options); }; });
}

}  // namespace orrery::cli
