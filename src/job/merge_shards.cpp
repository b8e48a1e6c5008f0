// SPDX-License-Identifier: Apache-2.0
#include "job/merge_shards.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <set>
#include <sstream>
#include <utility>

#include "job/provenance.h"
#include "base/error.h"
#include "base/file_set.h"
#include "base/frames.h"
#include "base/text.h"

namespace orrery::job {
namespace {

using base::ErrorKind;

base::Diagnostic finding_of(const std::filesystem::path& file, std::string text, std::string remedy = {}) {
  base::Diagnostic diagnostic;
  diagnostic.severity = base::Severity::kError;
  diagnostic.file = file.string();
  diagnostic.text = std::move(text);
  diagnostic.remedy = std::move(remedy);
  return diagnostic;
}

/// What is wrong with a part as a warning: the picture is made without it.
base::Diagnostic as_left_out(base::Diagnostic diagnostic) {
  diagnostic.severity = base::Severity::kWarning;
  diagnostic.remedy = "left out";
  return diagnostic;
}

[[noreturn]] void refuse(ErrorKind kind, std::vector<base::Diagnostic> diagnostics) {
  const std::size_t count = diagnostics.size();
  throw base::Error(kind, "the parts cannot be joined: " + std::to_string(count) + (count == 1 ? " error" : " errors"),
                    std::move(diagnostics));
}

/// Which samples of which pixels are there already, and through whom.
class Coverage {
 public:
  Coverage(std::size_t pixels, int width) : to_(pixels), by_(pixels), width_(width) {}

  /// Adds the samples of a part, of which those before begin with no later sample.
  ///
  /// Result     what is wrong, or nothing
  std::string add(const std::vector<ShardFile>& parts, std::size_t part, std::uint32_t begin,
                  const std::vector<std::uint32_t>& counts) {
    for (std::size_t i = 0; i < to_.size(); ++i) {
      if (counts[i] == 0) continue;
      if (begin < to_[i])
        return "has samples that " + parts[by_[i]].file.string() + " has, too, first in pixel " +
               std::to_string(static_cast<int>(i) % width_) + ", " + std::to_string(static_cast<int>(i) / width_);
      if (begin > to_[i]) ++gaps_[{to_[i], begin}];
      to_[i] = begin + counts[i];
      by_[i] = static_cast<std::uint32_t>(part);
    }
    return {};
  }

  /// What is in no part, in words.
  std::string missing(std::uint32_t samples) {
    for (const std::uint32_t to : to_)
      if (to < samples) ++gaps_[{to, samples}];
    std::vector<std::string> words;
    for (const auto& [gap, pixels] : gaps_)
      words.push_back("samples " + std::to_string(gap.first) + ":" + std::to_string(gap.second) + " of " +
                      (pixels == to_.size() ? std::string("all") : std::to_string(pixels)) + " pixels");
    constexpr std::size_t kMost = 8;
    const std::size_t count = words.size();
    if (count > kMost) {
      words.resize(kMost);
      words.push_back(std::to_string(count - kMost) + " ranges more");
    }
    return words.empty() ? "" : base::joined(words);
  }

 private:
  std::vector<std::uint32_t> to_;  ///< by pixel: samples up to here are there, or known to be missing
  std::vector<std::uint32_t> by_;  ///< index of the part that had the last of them
  int width_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> gaps_;  ///< and of how many pixels
};

/// Tiles that no file is for, of those whose ranges have others: "--samples 0:100 --shard 2/3".
std::string missing_tiles(const std::vector<ShardFile>& parts) {
  std::map<std::pair<std::string, int>, std::set<int>> found;
  for (const ShardFile& part : parts) {
    const render::PixelShard tiles = pixel_shard(part.provenance);
    found[{part.provenance.at("samples"), tiles.count}].insert(tiles.index);
  }
  std::vector<std::string> words;
  for (const auto& [group, indices] : found)
    for (int i = 0; i < group.second; ++i)
      if (indices.count(i) == 0)
        words.push_back("--samples " + group.first + " --shard " + std::to_string(i + 1) + "/" +
                        std::to_string(group.second));
  constexpr std::size_t kMost = 20;
  if (words.size() > kMost) words.resize(kMost);
  return words.empty() ? "" : "there is no part with " + base::joined(words);
}

/// Layers name spheres, and a name that the scene has not would be looked up beyond its end.
bool names_known_spheres(const film::Partial& partial, std::size_t spheres) {
  const auto is_known = [spheres](std::uint32_t s) { return s == kernel::kNoSphere || s < spheres; };
  return std::all_of(partial.layers.begin(), partial.layers.end(), [&](const film::LayerPixel& p) {
    return is_known(p.sphere) && std::all_of(p.shares.begin(), p.shares.end(),
                                             [&](const film::SphereCoverage& s) { return is_known(s.sphere); });
  });
}

}  // namespace

std::vector<ShardFile> read_shards(const std::vector<std::filesystem::path>& files,
                                   const std::function<void(const base::Diagnostic&)>& on_left_out) {
  std::vector<ShardFile> parts;
  std::vector<base::Diagnostic> diagnostics, left_out;
  bool only_missing = true;
  base::FileSet seen;
  for (const std::filesystem::path& file : files) {
    if (!seen.add_input(file, "part")) throw base::Error(ErrorKind::kUsage, file.string() + " is given twice");
    try {
      parts.push_back({file, image::read_provenance(file)});
    } catch (const base::Error& error) {
      only_missing = only_missing && error.kind() == ErrorKind::kMissingInput;
      (on_left_out ? left_out : diagnostics).push_back(finding_of(file, error.what()));
      continue;
    }
    const ShardFile& part = parts.back();
    const SampleRange range = sample_range(part.provenance);
    const render::PixelShard tiles = pixel_shard(part.provenance);
    std::string wrong = difference(part.provenance, parts.front().provenance, keys_of_parts());
    if (!wrong.empty()) {
      wrong = "is of " + wrong + " as " + parts.front().file.string();
    } else if (range.begin >= range.end || tiles.count < 1 || tiles.index < 0 || tiles.index >= tiles.count) {
      wrong = "does not say which samples it has";
    } else if (part.provenance.at("noise") != "0" || part.provenance.at("time") != "no") {
      wrong = "is a render by --noise or --time, which has no parts";
    }
    if (wrong.empty()) continue;
    only_missing = false;
    diagnostics.push_back(finding_of(file, wrong));
  }
  if (parts.empty()) diagnostics = std::move(left_out);
  if (!diagnostics.empty())
    refuse(only_missing ? ErrorKind::kMissingInput : ErrorKind::kBadData, std::move(diagnostics));
  for (const base::Diagnostic& diagnostic : left_out) on_left_out(as_left_out(diagnostic));
  return parts;
}

void take_scene(const ShardFile& part, Job& job) {
  const auto value = [&](const char* key) {
    const auto found = part.provenance.find(key);
    return found == part.provenance.end() ? std::string() : found->second;
  };
  if (job.scene.file.empty()) job.scene.file = value("scene");
  std::istringstream lines(value("overrides"));
  for (std::string line; std::getline(lines, line);) job.scene.overrides.push_back(line);
  const std::string frame = value("frame");
  std::from_chars(frame.data(), frame.data() + frame.size(), job.scene.frame);
  for (ImageFile& output : job.outputs.images) output.path = base::with_frame(output.path.string(), job.scene.frame);
  if (!job.outputs.statistics.empty())
    job.outputs.statistics = base::with_frame(job.outputs.statistics.string(), job.scene.frame);
}

MergedShards merge_shards(std::vector<ShardFile> parts, int width_px, int height_px, std::uint32_t samples,
                          std::size_t spheres, bool allow_missing) {
  std::stable_sort(parts.begin(), parts.end(), [](const ShardFile& a, const ShardFile& b) {
    return sample_range(a.provenance).begin < sample_range(b.provenance).begin;
  });
  MergedShards out;
  out.partial = film::Partial(width_px, height_px);
  Coverage coverage(out.partial.pixel_count(), width_px);
  std::vector<base::Diagnostic> diagnostics;
  std::set<std::string> hosts;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    image::PartialFile file;
    try {
      file = image::read_partial(parts[i].file, width_px, height_px);
    } catch (const base::Error& error) {
      if (!allow_missing || error.kind() != ErrorKind::kBadData) throw;
      out.left_out.push_back(as_left_out(finding_of(parts[i].file, error.what())));
      continue;
    }
    const film::Partial& part = file.partial;
    const SampleRange range = sample_range(parts[i].provenance);
    const auto wrong = [&](std::string text, std::string remedy = {}) {
      diagnostics.push_back(finding_of(parts[i].file, std::move(text), std::move(remedy)));
    };
    if (part.has_halves()) {
      wrong("its sums are of another kind than its header says");
      continue;
    }
    if (!names_known_spheres(part, spheres) || range.end > samples) {
      wrong("has what its scene has not");
      continue;
    }
    const std::uint32_t most = *std::max_element(part.counts.begin(), part.counts.end());
    if (most > range.end - range.begin) {
      wrong("has more samples than it says");
      continue;
    }
    if (!allow_missing && !is_finished(file)) {
      wrong("is unfinished: its render was stopped", "render it again with --resume, or say --allow-missing");
      continue;
    }
    if (const std::string overlap = coverage.add(parts, i, range.begin, part.counts); !overlap.empty()) {
      wrong(overlap, "leave one of them out");
      continue;
    }
    out.partial.film.add(part.film);
    for (std::size_t p = 0; p < part.counts.size(); ++p) out.partial.counts[p] += part.counts[p];
    if (!part.layers.empty()) {
      out.partial.layers.resize(part.layers.size());
      for (std::size_t p = 0; p < part.layers.size(); ++p) out.partial.layers[p].add(part.layers[p]);
    }
    out.partial.work += part.work;
    hosts.insert(parts[i].provenance.count("host") > 0 ? parts[i].provenance.at("host") : "");
  }
  if (out.left_out.size() == parts.size()) diagnostics = out.left_out;
  if (!diagnostics.empty()) refuse(ErrorKind::kBadData, std::move(diagnostics));
  out.hosts.assign(hosts.begin(), hosts.end());
  out.missing = coverage.missing(samples);
  if (!out.missing.empty() && !allow_missing) {
    const std::string tiles = missing_tiles(parts);
    refuse(ErrorKind::kBadData, {finding_of("the parts", out.missing + " are in no part",
                                            tiles.empty() ? "render them, or say --allow-missing" : tiles)});
  }
  return out;
}

}  // namespace orrery::job
