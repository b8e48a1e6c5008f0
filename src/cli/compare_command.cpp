// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <memory>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include "base/error.h"
#include "base/text.h"
#include "cli/commands.h"
#include "cli/messages.h"
#include "cli/options.h"
#include "cli/signals.h"
#include "compare/compare_files.h"

namespace orrery::cli {
namespace {

/// As diff(1): the comparison succeeded, and the images differ. Listed in docs/orrery.1.in.
constexpr int kDiffer = 1;

struct CompareOptions {
  std::filesystem::path picture, reference;
  std::vector<std::string> limits;
  std::string layer;
  compare::ComparisonPictures pictures;
  int threads = 0;
  bool json = false, quiet = false;
};

/// The metric and its maximum.
std::pair<std::string, double> limit_of(const std::string& text) {
  const auto refuse = [&](const std::string& reason) {
    base::refuse(fmt::format("--fail-above {}: {}", text, reason));
  };
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) refuse("write METRIC=VALUE, e.g. rmse=0.001");
  const std::string metric = text.substr(0, equals);
  const auto value = base::number_of<double>(std::string_view(text).substr(equals + 1));
  if (!value || !(*value >= 0)) refuse("the value must be a number, 0 or more");
  const std::vector<std::string>& known = compare::limitable_metrics();
  if (metric == "psnr" || metric == "ssim") refuse(metric + " decreases with the error; limit rmse or flip instead");
  if (!base::contains(known, metric)) {
    const std::string remedy = base::did_you_mean(metric, known);
    refuse("unknown metric; " + (remedy.empty() ? "use one of " + base::joined(known) : remedy));
  }
  return {metric, *value};
}

void warn_of_layers(const CompareOptions& options, const compare::Comparison& found) {
  if (options.quiet) return;
  const auto warn = [](const std::vector<std::string>& channels, const std::filesystem::path& file) {
    if (!channels.empty())
      print_message(
          base::warning_line(fmt::format("only in {}: {}", file.string(), base::joined(compare::layers_of(channels)))));
  };
  warn(found.only_in_picture, options.picture);
  warn(found.only_in_reference, options.reference);
}

int compare(const CompareOptions& options) {
  end_on_signals();
  std::vector<std::pair<std::string, double>> limits;
  for (const std::string& text : options.limits) limits.push_back(limit_of(text));
  const compare::Comparison found =
      compare::compare_files(options.picture, options.reference, options.layer, options.pictures, options.threads);
  if (!found.only_in_picture.empty() || !found.only_in_reference.empty()) warn_of_layers(options, found);
  if (!options.quiet) print_result(options.json ? compare::comparison_json(found) : compare::comparison_text(found));
  int status = 0;
  for (const auto& [metric, limit] : limits) {
    const double value = found.metric(metric);
    if (value <= limit) continue;
    std::fprintf(stderr, "orrery: %s is %g, above the limit of %g\n", metric.c_str(), value, limit);
    status = kDiffer;
  }
  if (!limits.empty() && found.errors.not_finite > 0) {
    std::fprintf(stderr, "orrery: %llu values are not finite and cannot be compared\n",
                 static_cast<unsigned long long>(found.errors.not_finite));
    status = kDiffer;
  }
  return status;
}

}  // namespace

void add_compare(Command& program) {
  const auto options = std::make_shared<CompareOptions>();
  Command& command = *program.add_subcommand("compare", "Compare two images with error metrics");
  command.add_option("A", options->picture, "FILE", "Image to compare")->required();
  command.add_option("B", options->reference, "FILE", "Reference image")->required();
  command
      .add_option(
          "--fail-above", options->limits, "METRIC=VALUE",
          "Exit with status 1 if a metric exceeds the value: rmse, relmse, mae, max, display, flip, bias or z; errors "
          "have other statuses; can be repeated")
      ->details("Also if a value is not finite. Images without common finite values are an error.")
      ->repeatable();
  command
      .add_option("--layer", options->layer, "NAME",
                  "Layer to compare; Cryptomattes are compared by coverage; default: the beauty")
      ->details(
          "Pixels without a hit (1e30 in Z and depth) in one of the images are excluded and counted. The coverage of a "
          "Cryptomatte, e.g. CryptoObject, is the fraction of each pixel that belongs to different objects.");
  command.add_option("--heat", options->pictures.heat, "FILE", "Write the display error as a heat map")
      ->details("From 0 to 0.1; an EXR holds the values.");
  command.add_option("--flip", options->pictures.flip, "FILE", "Write the FLIP error map")
      ->details("From 0 to 1; an EXR holds the values.");
  add_threads_option(command, options->threads);
  command.add_flag("--json", options->json, "Print JSON")->details("Schema orrery.compare/2.");
  command.add_flag("-q,--quiet", options->quiet, "Print only errors and exceeded limits");
  command.details(
      "Measures, in R, G and B: root mean square error, relative mean square error, mean absolute error, maximum error "
      "and its position, PSNR, display error (as for --noise), bias of the mean, SSIM, FLIP (HDR-FLIP for scene-linear "
      "images), and the number of different values in all common channels, or in those of --layer. If A has the layer "
      "variance, also the fraction of the error that is noise, and a z-test over blocks of 16 x 16 pixels with a false "
      "alarm probability of one per cent for the whole image. Both images must be scene-linear, or both "
      "display-encoded.");
  command.footer(
      "Examples:\n"
      "  orrery compare fast.exr exact.exr\n"
      "  orrery compare new.exr reference.exr --quiet --fail-above rmse=0.001 --fail-above max=0.1\n"
      "  orrery compare adaptive.exr reference.exr --heat heat.png --flip flip.png");
  command.action([options] { return compare(*options); });
}

}  // namespace orrery::cli
