// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>

#include "app/compare_files.h"
#include "base/error.h"
#include "base/suggestion.h"
#include "cli/commands.h"
#include "cli/option_checks.h"
#include "cli/output.h"

namespace orrery::cli {
namespace {

/// As diff has it: the comparison itself went well, and the files differ. docs/orrery.1 lists it.
constexpr int kDiffer = 1;

/// The largest value that a metric may have.
struct Limit {
  std::string metric;
  double value = 0;
};

struct CompareOptions {
  std::filesystem::path picture, reference;
  std::vector<std::string> limits;
  bool json = false, quiet = false;
};

/// The metrics that grow with the difference, so that a largest value makes sense.
const std::vector<std::string> kLimitable = {"rmse", "relmse", "max"};

Limit limit_of(const std::string& text) {
  const auto wrong = [&](const std::string& reason) {
    return base::Error(base::ErrorKind::kUsage, "--fail-above " + text + ": " + reason);
  };
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) throw wrong("write METRIC=VALUE, as in rmse=0.001");
  Limit limit{text.substr(0, equals), 0};
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data() + equals + 1, end, limit.value);
  if (error != std::errc() || stopped != end || !(limit.value >= 0))
    throw wrong("the value must be a number of 0 or more");
  if (limit.metric == "psnr") throw wrong("psnr falls as pictures differ more; limit rmse instead");
  if (std::find(kLimitable.begin(), kLimitable.end(), limit.metric) == kLimitable.end()) {
    const std::string remedy = base::did_you_mean(limit.metric, kLimitable);
    throw wrong("there is no such metric; " + (remedy.empty() ? "there are " + base::joined(kLimitable) : remedy));
  }
  return limit;
}

double value_of(const app::Comparison& comparison, const std::string& metric) {
  if (metric == "rmse") return comparison.rmse;
  return metric == "relmse" ? comparison.relative_mse : comparison.max;
}

int compare(const CompareOptions& options) {
  std::vector<Limit> limits;
  for (const std::string& text : options.limits) limits.push_back(limit_of(text));
  const app::Comparison found = app::compare_files(options.picture, options.reference);
  if (!options.quiet) print_result(options.json ? app::comparison_json(found) : app::comparison_text(found));
  int status = 0;
  for (const Limit& limit : limits) {
    const double value = value_of(found, limit.metric);
    if (value <= limit.value) continue;
    std::fprintf(stderr, "orrery: %s is %g, above %g\n", limit.metric.c_str(), value, limit.value);
    status = kDiffer;
  }
  if (!limits.empty() && found.not_finite > 0) {
    std::fprintf(stderr, "orrery: %llu values are not finite and cannot be compared\n",
                 static_cast<unsigned long long>(found.not_finite));
    status = kDiffer;
  }
  return status;
}

}  // namespace

void add_compare(CLI::App& program, Action& action) {
  const auto options = std::make_shared<CompareOptions>();
  CLI::App& command = *program.add_subcommand("compare", "Tell how much two pictures differ");
  command.add_option("A", options->picture, "Picture to judge")->required()->type_name("FILE");
  command.add_option("B", options->reference, "Picture to judge it by")->required()->type_name("FILE");
  repeatable(
      *command
           .add_option("--fail-above", options->limits, "Exit with 1 if rmse, relmse or max is larger; can be repeated")
           ->type_name("METRIC=VALUE"));
  command.add_flag("--json", options->json, "As JSON");
  command.add_flag("-q,--quiet", options->quiet, "Print nothing but errors and what is above its limit");
  command.footer(
      "Examples:\n"
      "  orrery compare fast.exr exact.exr\n"
      "  orrery compare new.exr reference.exr --quiet --fail-above rmse=0.001 --fail-above max=0.1");
  command.callback([options, &action] { action = [options] { return compare(*options); }; });
}

}  // namespace orrery::cli
