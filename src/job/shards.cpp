// SPDX-License-Identifier: Apache-2.0
#include "job/shards.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "base/error.h"
#include "base/file_set.h"
#include "base/stop_point.h"
#include "base/text.h"
#include "film/sums.h"
#include "image/sums_file.h"
#include "job/batch.h"
#include "job/checkpoint.h"
#include "job/prepare_job.h"
#include "math/pixels.h"
#include "render/render.h"
#include "render/result.h"

namespace orrery::job {
namespace {

using base::ErrorKind;

base::Diagnostic error_in(const std::filesystem::path& file, std::string text, std::string remedy = {}) {
  return base::file_diagnostic(base::Severity::kError, file.string(), std::move(text), std::move(remedy));
}

/// A shard's error as a warning: the image is made without the shard.
base::Diagnostic as_left_out(base::Diagnostic diagnostic) {
  diagnostic.severity = base::Severity::kWarning;
  diagnostic.remedy = "left out";
  return diagnostic;
}

[[noreturn]] void refuse(ErrorKind kind, std::vector<base::Diagnostic> diagnostics) {
  const std::size_t count = diagnostics.size();
  throw base::Error(kind, "the shards cannot be merged: " + base::counted(count, "error"), std::move(diagnostics));
}

/// The samples that each pixel has so far, and the shards they came from.
class Coverage {
 public:
  Coverage(std::size_t pixels, int width) : to_(pixels), by_(pixels), width_(width) {}

  /// Adds the samples of a shard.
  ///
  /// Domain     called in ascending order of `begin`
  /// Result     the error; empty: none
  std::string add(const std::vector<ShardFile>& shards, std::size_t shard, std::uint32_t begin,
                  std::span<const std::uint32_t> counts) {
    for (std::size_t i = 0; i < to_.size(); ++i) {
      if (counts[i] == 0) continue;
      if (begin < to_[i])
        return fmt::format("has samples that {} has too, first in pixel {}, {}", shards[by_[i]].file.string(),
                           static_cast<int>(i) % width_, static_cast<int>(i) / width_);
      if (begin > to_[i]) ++gaps_[{to_[i], begin}];
      to_[i] = begin + counts[i];
      by_[i] = static_cast<std::uint32_t>(shard);
    }
    return {};
  }

  /// The samples that no shard has, as text.
  std::string missing(std::uint32_t samples) {
    for (const std::uint32_t to : to_)
      if (to < samples) ++gaps_[{to, samples}];
    std::vector<std::string> ranges;
    for (const auto& [gap, pixels] : gaps_)
      ranges.push_back(fmt::format("samples {}:{} of {} pixels", gap.first, gap.second,
                                   pixels == to_.size() ? "all" : std::to_string(pixels)));
    constexpr std::size_t kMax = 8;
    const std::size_t count = ranges.size();
    if (count > kMax) {
      ranges.resize(kMax);
      ranges.push_back(fmt::format("{} more ranges", count - kMax));
    }
    return ranges.empty() ? "" : base::joined(ranges);
  }

 private:
  std::vector<std::uint32_t> to_;  ///< per pixel: end of the samples that are present or known to be missing
  std::vector<std::uint32_t> by_;  ///< per pixel: index of the shard with the last of them
  int width_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> gaps_;  ///< number of pixels by missing range
};

/// The options of missing shards, for sample ranges of which some shard is present: "--sample-range 0:100 --shard 2/3".
std::string missing_shards(const std::vector<ShardFile>& shards) {
  std::map<std::pair<std::string, int>, std::set<int>> found;
  for (const ShardFile& shard : shards) {
    const render::PixelShard pixels = pixel_shard(shard.provenance);
    found[{shard.provenance.at("samples"), pixels.count}].insert(pixels.index);
  }
  std::vector<std::string> missing;
  for (const auto& [group, indices] : found)
    for (int i = 0; i < group.second; ++i)
      if (indices.count(i) == 0)
        missing.push_back(fmt::format("--sample-range {} --shard {}/{}", group.first, i + 1, group.second));
  constexpr std::size_t kMax = 20;
  if (missing.size() > kMax) missing.resize(kMax);
  return missing.empty() ? "" : "there is no shard with " + base::joined(missing);
}

/// Adds the sums of a job's shards, and reports which samples are missing and which machines rendered the others.
film::Sums sum_of_shards(const PreparedJob& prepared, JobReport& report) {
  const Job& job = prepared.job;
  const compile::CompiledScene& compiled = prepared.compiled();
  const bool allow_missing = job.merge.allow_missing;
  const auto samples = static_cast<std::uint32_t>(compiled.samples);
  std::vector<ShardFile> shards = job.merge.shards;
  std::stable_sort(shards.begin(), shards.end(), [](const ShardFile& a, const ShardFile& b) {
    return sample_range(a.provenance).begin < sample_range(b.provenance).begin;
  });
  std::optional<film::Sums> sum;
  Coverage coverage(math::pixel_count(compiled.width, compiled.height), compiled.width);
  std::vector<base::Diagnostic> diagnostics, left_out;
  std::set<std::string> hosts;
  const base::StopPoint stop;
  for (std::size_t i = 0; i < shards.size(); ++i) {
    stop.check();
    std::optional<image::SumsFile> file;
    try {
      file = image::read_sums(shards[i].file, compiled.width, compiled.height);
    } catch (const base::Error& error) {
      if (error.kind() != ErrorKind::kBadData) throw;
      (allow_missing ? left_out : diagnostics).push_back(error_in(shards[i].file, error.what()));
      continue;
    }
    film::Sums& shard = file->sums;
    const SampleRange range = sample_range(shards[i].provenance);
    const auto wrong = [&](std::string text, std::string remedy = {}) {
      diagnostics.push_back(error_in(shards[i].file, std::move(text), std::move(remedy)));
    };
    const std::uint32_t most = *std::max_element(shard.counts.begin(), shard.counts.end());
    if (shard.is_adaptive()) {
      wrong("holds the sums of adaptive sampling, contrary to its header");
    } else if (!shard.has_known_spheres(compiled.object_materials.size()) || range.end > samples) {
      wrong("has spheres or samples that its scene does not have");
    } else if (sum && !(shard.has_arrays_of(*sum) && sum->has_arrays_of(shard))) {
      wrong("holds the sums of other layers than its header declares");
    } else if (most > range.end - range.begin) {
      wrong("has more samples than its header declares");
    } else if (!allow_missing && !is_finished(*file)) {
      wrong("is unfinished: its render was stopped", "finish it with --resume, or add --allow-missing");
    } else if (const std::string overlap = coverage.add(shards, i, range.begin, shard.counts); !overlap.empty()) {
      wrong(overlap, "remove one of them");
    } else {
      if (sum)
        sum->add(shard);
      else
        sum = std::move(shard);
      hosts.insert(value_of(shards[i].provenance, "host"));
    }
  }
  if (left_out.size() == shards.size()) diagnostics = left_out;
  if (!diagnostics.empty()) refuse(ErrorKind::kBadData, std::move(diagnostics));
  report.hosts.assign(hosts.begin(), hosts.end());
  report.missing = coverage.missing(samples);
  if (!report.missing.empty() && !allow_missing) {
    const std::string absent = missing_shards(shards);
    refuse(ErrorKind::kBadData, {error_in("the shards", report.missing + " are in no shard",
                                          absent.empty() ? "render them, or add --allow-missing" : absent)});
  }
  for (const base::Diagnostic& diagnostic : left_out) job.hooks.warn(as_left_out(diagnostic));
  return std::move(*sum);
}

/// Requires that a shard has these properties of the scene.
void require_same(const PreparedJob& prepared, const std::vector<std::string>& keys) {
  const ShardFile& first = prepared.job.merge.shards.front();
  if (const std::string wrong = difference(first.provenance, prepared.provenance, keys); !wrong.empty())
    throw base::Error(ErrorKind::kBadData,
                      fmt::format("{} has {} as {}; the scene has changed, or --scene names another one",
                                  first.file.string(), wrong, prepared.job.scene.file.string()));
}

/// Requires that the sums have the layers of the image.
void require_layers(const PreparedJob& prepared, const film::Sums& sum) {
  const film::LayerRequest& layers = prepared.layers.request;
  const auto fail = [](const std::string& text) { throw base::Error(ErrorKind::kBadData, text); };
  const bool has_guides = !sum.guides[0].empty();
  if (prepared.job.denoise && !has_guides)
    fail("the shards have no halves to denoise from; render them with --denoise or --layers halves");
  if (prepared.job.outputs.has_exr()) {  // other formats do not hold the layers that the shards may have
    if (has_guides && !layers.guides()) fail("the shards were rendered with --denoise; merge them with --denoise");
    require_same(prepared, {"layers"});
  }
  if (!sum.has_arrays_of(film::Sums(sum.width, sum.height, layers)))
    fail("the shards were rendered without the requested layers");
}

}  // namespace

std::vector<ShardFile> read_shards(const std::vector<std::filesystem::path>& files,
                                   const std::function<void(const base::Diagnostic&)>& on_left_out) {
  // The values that all shards of an image share.
  static const std::vector<std::string> keys = {"version", "sceneHash", "noise", "time", "layers"};
  std::vector<ShardFile> shards;
  std::vector<base::Diagnostic> diagnostics, left_out;
  bool only_missing = true;
  base::FileSet seen;
  const base::StopPoint stop;
  for (const std::filesystem::path& file : files) {
    stop.check();
    if (!seen.add_input(file, "shard")) base::refuse(file.string() + " is given twice");
    try {
      shards.push_back({file, image::read_provenance(file)});
    } catch (const base::Error& error) {
      only_missing = only_missing && error.kind() == ErrorKind::kMissingInput;
      (on_left_out ? left_out : diagnostics).push_back(error_in(file, error.what()));
      continue;
    }
    const ShardFile& shard = shards.back();
    const SampleRange range = sample_range(shard.provenance);
    const render::PixelShard pixels = pixel_shard(shard.provenance);
    std::string wrong = difference(shard.provenance, shards.front().provenance, keys);
    if (!wrong.empty()) {
      wrong = fmt::format("has {} as {}", wrong, shards.front().file.string());
    } else if (range.begin >= range.end || pixels.count < 1 || pixels.index < 0 || pixels.index >= pixels.count) {
      wrong = "does not state its range of samples";
    } else if (!shard.provenance.count("noise") || !shard.provenance.count("time")) {
      wrong = "does not state its sampling method";
    } else if (shard.provenance.at("noise") != "0" || shard.provenance.at("time") != "no") {
      wrong = "is a checkpoint of a render with --noise or --time, which has no shards";
    }
    if (wrong.empty()) continue;
    only_missing = false;
    diagnostics.push_back(error_in(file, wrong));
  }
  if (shards.empty() && on_left_out) diagnostics = std::move(left_out);
  if (!diagnostics.empty())
    refuse(only_missing ? ErrorKind::kMissingInput : ErrorKind::kBadData, std::move(diagnostics));
  for (const base::Diagnostic& diagnostic : left_out) on_left_out(as_left_out(diagnostic));
  return shards;
}

void take_scene(const ShardFile& shard, Job& job) {
  if (job.scene.file.empty()) job.scene.file = value_of(shard.provenance, "scene");
  std::istringstream lines(value_of(shard.provenance, "overrides"));
  for (std::string line; std::getline(lines, line);) job.scene.overrides.add(line);
  job.scene.frame = base::number_of<int>(value_of(shard.provenance, "frame")).value_or(job.scene.frame);
  each_named(job.outputs, [&](std::filesystem::path& name, const char*) {
    name = output_name(name, job.scene.file, job.scene.frame);
  });
}

render::Result merge_shards(const PreparedJob& prepared, int threads, JobReport& report) {
  require_same(prepared, {"version", "sceneHash"});
  const film::Sums sum = sum_of_shards(prepared, report);
  require_layers(prepared, sum);
  render::Result result = render::finished(prepared.compiled(), prepared.layers.request, sum, threads);
  const auto [fewest, most] = std::minmax_element(sum.counts.begin(), sum.counts.end());
  result.statistics = {};
  result.statistics.min_samples = *fewest;
  result.statistics.max_samples = *most;
  result.statistics.set(sum.work);
  result.statistics.ended_by = "samples";
  return result;
}

}  // namespace orrery::job
