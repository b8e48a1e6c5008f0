// SPDX-License-Identifier: Apache-2.0
#include "job/checkpoint.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <sstream>
#include <utility>

#include <fmt/core.h>

#include "base/error.h"
#include "base/file_name.h"
#include "base/hash.h"
#include "base/text.h"
#include "compile/compiled_scene.h"
#include "display/settings.h"
#include "film/layer_planes.h"
#include "film/sums.h"
#include "image/read.h"
#include "job/picture_header.h"
#include "job/version.h"
#include "load/read_scene.h"
#include "render/settings.h"

namespace orrery::job {
namespace {

/// The hash of what has moved in the frames before and after.
std::string text_of(const film::NeighborFrames& neighbors) {
  base::Hash hash;
  for (const auto& frame : neighbors)
    if (frame != nullptr) add_motion(hash, frame->sphere_motion, frame->rod_motion, frame->camera);
  return hash.text();
}

/// Channels of all layers, and everything that they depend on in addition to the scene hash.
std::string layers_text(const Layers& layers) {
  std::string out;
  film::LayerRequest visible = layers.request;
  visible.halves = false;  // --denoise requests them; their sixteen channels would say nothing to its user
  for (const film::Plane& plane : film::planes_of(visible)) out += (out.empty() ? "" : " ") + plane.name;
  if (layers.request.halves) out += out.empty() ? "halves, as for --denoise" : " halves, as for --denoise";
  if (layers.request.coverage) out += " coverage";
  if (layers.request.deep) out += " deep";
  if (layers.request.vector) out += " " + text_of(layers.request.neighbors);
  for (const MatteNames& matte : layers.mattes)
    for (const auto& [name, id] : matte.things) out += fmt::format(" {:08x}", id);
  // A hash replaces the rest of a long list, such as that of a matte with ten thousand names.
  constexpr std::size_t kLongest = 200;
  if (out.size() > kLongest) out = fmt::format("{}... {}", out.substr(0, kLongest), base::text_hash(out));
  return out;
}

/// Settings that are lines "key = value", by key.
std::map<std::string, std::string> settings_of(const image::Provenance& provenance) {
  std::map<std::string, std::string> out;
  std::istringstream lines(value_of(provenance, "settings"));
  constexpr std::string_view kEquals = " = ";
  for (std::string line; std::getline(lines, line);)
    if (const std::size_t equals = line.find(kEquals); equals != std::string::npos)
      out[line.substr(0, equals)] = line.substr(equals + kEquals.size());
  return out;
}

/// True if a setting changes no sample: what is written of them, and how they are displayed.
bool is_of_output(const std::string& key) {
  static const std::vector<std::string> keys = {"color.config", "color.display",  "color.view",
                                                "color.look",   "color.exposure", "render.traversal"};
  return key.starts_with("output.") || base::contains(keys, key);
}

/// The keys whose values must match in a finished file and the job that would write it.
const std::vector<std::string>& keys_of_files() {
  static const std::vector<std::string> keys = {"version", "sceneHash", "samples", "shard",
                                                "noise",   "time",      "limit",   "layers"};
  return keys;
}

/// Names the settings in which two scenes of different hashes differ.
///
/// `counts`   the number of samples is a difference
std::string scene_difference(const image::Provenance& a, const image::Provenance& b, bool counts) {
  const std::map<std::string, std::string> mine = settings_of(a);
  std::string out;
  for (const auto& [key, other] : settings_of(b)) {
    const auto found = mine.find(key);
    if (found == mine.end() || found->second == other || is_of_output(key) || (!counts && key == "render.samples"))
      continue;
    out += fmt::format("{}{} = {}, not {}", out.empty() ? "" : "; ", key, found->second, other);
  }
  return out.empty() ? "other spheres, materials, lights or images" : out;
}

/// Describes why a job cannot continue from a checkpoint; empty: it can. It can have more samples than the checkpoint.
std::string difference_of_checkpoint(const image::Provenance& checkpoint, const image::Provenance& job) {
  // The sums count samples, so that they do not depend on how many there will be, unless `total` says so.
  static const std::vector<std::string> keys = {"version", "sampleHash", "total", "shard",
                                                "noise",   "time",       "limit", "layers"};
  std::string out = difference(checkpoint, job, keys);
  const SampleRange begun = sample_range(checkpoint), wanted = sample_range(job);
  if (out.empty() && (begun.begin != wanted.begin || begun.end > wanted.end))
    out = difference(checkpoint, job, {"samples"});
  return out;
}

}  // namespace

std::string value_of(const image::Provenance& provenance, const std::string& key) {
  const auto found = provenance.find(key);
  return found == provenance.end() ? std::string() : found->second;
}

image::Provenance provenance_of(const Job& job, const load::ReadResult& read, const compile::CompiledScene& compiled,
                                const SceneHashes& hashes, const Layers& layers) {
  const std::uint32_t end =
      job.settings.sample_end > 0 ? job.settings.sample_end : static_cast<std::uint32_t>(compiled.samples);
  image::Provenance out;
  out["version"] = program_version();
  out["sceneHash"] = hashes.of_image;
  out["sampleHash"] = hashes.of_samples;
  out["settings"] = settings_lines(read, true);
  const bool depends_on_total =
      job.settings.is_adaptive() || layers.request.guides() || compiled.sampler.kind == kernel::SamplerKind::kBlueNoise;
  out["total"] = depends_on_total ? std::to_string(compiled.samples) : "any";
  out["samples"] = fmt::format("{}:{}", job.settings.sample_begin, end);
  out["shard"] = fmt::format("{}/{}", job.settings.shard.index + 1, job.settings.shard.count);
  out["noise"] = fmt::format("{}", job.settings.noise);  // shortest text that reads back exactly
  out["time"] = job.settings.time_budget_s > 0 ? "yes" : "no";
  out["limit"] = job.settings.is_adaptive() && is_limited(job) ? "yes" : "no";
  out["layers"] = layers_text(layers);
  out["scene"] = std::filesystem::absolute(job.scene.file).lexically_normal().string();
  std::string& overrides = out["overrides"];
  for (const load::KeyValue& set : job.scene.overrides.values()) overrides += set.text + "\n";
  out["frame"] = std::to_string(job.scene.frame);
  char host[256] = "";
  gethostname(host, sizeof(host) - 1);
  out["host"] = host;
  return out;
}

std::string stamp_of(const Job& job, const image::Provenance& provenance, const display::Settings& display,
                     const display::Choice& choice) {
  std::string all;
  for (const std::string& key : keys_of_files()) all += fmt::format("{} {}\n", key, provenance.at(key));
  all += fmt::format("{:.17g} s, frame {}, {} bits, float {:d}, multipart {:d}, reproducible {:d}, exposure {:.17g}\n",
                     job.settings.time_budget_s, job.scene.frame, job.outputs.bits, job.outputs.exr.as_float,
                     job.outputs.exr.multipart, job.outputs.reproducible, display.exposure.value_or(0));
  if (job.denoise) all += "denoised\n";
  for (const std::string& word : {job.outputs.exr.compression, display.config, choice.config_id, choice.transform_id,
                                  display.display, display.view, display.look, display.working_space})
    all += word + "\n";
  for (const load::KeyValue& set : job.scene.overrides.values())
    if (set.key != "render.accelerator" && set.key != "render.traversal")  // they change no bits
      all += set.text + "\n";
  return base::text_hash(all);
}

std::string stamp_of_missed(const std::string& stamp) { return stamp + "-missed"; }

std::string difference(const image::Provenance& a, const image::Provenance& b, const std::vector<std::string>& keys) {
  static const std::vector<std::pair<std::string, std::string>> names = {
      {"version", "orrery version "},  {"sceneHash", ""},           {"sampleHash", ""},
      {"samples", "samples "},         {"shard", "--shard "},       {"noise", "--noise "},
      {"time", "time budget: "},       {"limit", "sample limit: "}, {"layers", "layers "},
      {"total", "samples per pixel: "}};
  for (const auto& [key, name] : names) {
    if (!base::contains(keys, key) || value_of(a, key) == value_of(b, key)) continue;
    if (name.empty()) return scene_difference(a, b, key == "sceneHash");
    return fmt::format("{}{}, not {}", name, value_of(a, key).empty() ? "none" : value_of(a, key),
                       value_of(b, key).empty() ? "none" : value_of(b, key));
  }
  return {};
}

bool is_finished(const image::SumsFile& shard) {
  const SampleRange range = sample_range(shard.provenance);
  const std::vector<bool> owned = render::pixels_of(pixel_shard(shard.provenance), shard.sums.width, shard.sums.height);
  for (std::size_t i = 0; i < owned.size(); ++i)
    if (owned[i] && shard.sums.counts[i] != range.end - range.begin) return false;
  return true;
}

SampleRange sample_range(const image::Provenance& provenance) {
  SampleRange out;
  std::sscanf(value_of(provenance, "samples").c_str(), "%u:%u", &out.begin, &out.end);
  return out;
}

render::PixelShard pixel_shard(const image::Provenance& provenance) {
  render::PixelShard out;
  if (std::sscanf(value_of(provenance, "shard").c_str(), "%d/%d", &out.index, &out.count) == 2) --out.index;
  if (out.count > kMaxShards) out.count = 0;  // not written by orrery
  return out;
}

bool is_up_to_date(const Job& job, const compile::CompiledScene& compiled, const image::Provenance& provenance,
                   const std::string& stamp) {
  if (is_shard(job)) {
    try {
      const image::SumsFile shard = image::read_sums(job.outputs.images.front().path, compiled.width, compiled.height);
      return difference(shard.provenance, provenance, keys_of_files()).empty() && is_finished(shard);
    } catch (const base::Error&) {
      return false;
    }
  }
  const auto is_same = [&](const std::filesystem::path& file) {
    const std::string found = image::verified_stamp(file);
    return found == stamp || (!job.is_strict && found == stamp_of_missed(stamp));
  };
  return std::all_of(job.outputs.images.begin(), job.outputs.images.end(),
                     [&](const ImageFile& image) { return is_same(image.path); }) &&
         (job.outputs.deep.empty() || is_same(job.outputs.deep));
}

std::filesystem::path checkpoint_file(const std::filesystem::path& first_output) {
  return first_output.parent_path() / base::companion_name(first_output.stem().string(), ".checkpoint.exr");
}

Checkpoint::Checkpoint(const Job& job, image::Provenance provenance, Write write)
    : settings_(job.checkpoint),
      hooks_(job.hooks),
      file_(checkpoint_file(job.outputs.images.front().path)),
      provenance_(std::move(provenance)),
      write_(std::move(write)) {}

std::optional<film::Sums> Checkpoint::load(int width_px, int height_px) {
  if (!std::filesystem::exists(file_)) return {};
  if (!settings_.resume) {
    hooks_.warn(base::file_diagnostic(base::Severity::kWarning, file_.string(),
                                      "checkpoint of an earlier render, replaced if this one is stopped; "
                                      "--resume continues from it"));
    return {};
  }
  try {
    const auto check = [&](const image::Provenance& found) {
      if (const std::string wrong = difference_of_checkpoint(found, provenance_); !wrong.empty())
        throw base::Error(
            base::ErrorKind::kBadData,
            fmt::format("{} has {}; delete it, or render without --resume to start again", file_.string(), wrong));
    };
    image::SumsFile file = image::read_sums(file_, width_px, height_px, check);
    is_ours_ = true;
    return std::move(file.sums);
  } catch (const base::Error&) {
    // Another process that renders the same image may have finished and removed the checkpoint.
    if (!std::filesystem::exists(file_)) return {};
    throw;
  }
}

bool Checkpoint::is_due() const {
  if (hooks_.checkpoint_request != nullptr && hooks_.checkpoint_request->load(std::memory_order_relaxed)) return true;
  return settings_.interval_s > 0 && since_last_.seconds() >= settings_.interval_s;
}

void Checkpoint::try_write(const film::Sums& sums) {
  const bool was_requested = hooks_.checkpoint_request != nullptr && hooks_.checkpoint_request->exchange(false);
  try {
    write(sums);
    if (was_requested && hooks_.on_note) hooks_.on_note("wrote " + file_.string());
  } catch (const base::Error& error) {
    hooks_.warn(base::file_diagnostic(base::Severity::kWarning, file_.string(),
                                      std::string("checkpoint not written: ") + error.what()));
  }
  since_last_.lap();
}

void Checkpoint::write(const film::Sums& sums) {
  write_(file_, sums);
  is_ours_ = true;
}

void Checkpoint::finish(const std::optional<film::Sums>& sums) {
  if (settings_.keep) return try_write(*sums);
  std::error_code ignored;
  if (is_ours_) std::filesystem::remove(file_, ignored);
}

}  // namespace orrery::job
