// SPDX-License-Identifier: Apache-2.0
#include "job/provenance.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include <fmt/core.h>

#include "compile/compiled_scene.h"
#include "display/settings.h"
#include "film/layer_film.h"
#include "image/partial_file.h"
#include "job/job.h"
#include "job/layers.h"
#include "job/scene_hash.h"
#include "job/version.h"
#include "render/sampling_limits.h"

namespace orrery::job {
namespace {

/// Channels of all layers, and everything that they depend on in addition to the scene hash.
std::string layers_text(const Layers& layers) {
  std::string out;
  for (const film::Plane& plane : film::planes_of(layers.request)) out += (out.empty() ? "" : " ") + plane.name;
  if (layers.request.coverage) out += " coverage";
  if (layers.request.deep) out += " deep";
  for (const MatteNames& matte : layers.mattes)
    for (const auto& [name, id] : matte.things) out += fmt::format(" {:08x}", id);
  // A hash replaces the rest of a long list, such as that of a matte with ten thousand names.
  constexpr std::size_t kLongest = 200;
  if (out.size() > kLongest) out = fmt::format("{}... {}", out.substr(0, kLongest), text_hash(out));
  return out;
}

}  // namespace

image::Provenance provenance_of(const Job& job, const compile::CompiledScene& compiled, const Layers& layers) {
  const std::uint32_t end =
      job.sampling.sample_end > 0 ? job.sampling.sample_end : static_cast<std::uint32_t>(compiled.samples);
  image::Provenance out;
  out["version"] = program_version();
  out["sceneHash"] = scene_hash(compiled);
  out["samples"] = fmt::format("{}:{}", job.sampling.sample_begin, end);
  out["shard"] = fmt::format("{}/{}", job.sampling.shard.index + 1, job.sampling.shard.count);
  out["noise"] = fmt::format("{}", job.sampling.noise);  // shortest text that reads back exactly
  out["time"] = job.sampling.seconds > 0 ? "yes" : "no";
  out["limit"] = is_limited(job) ? "yes" : "no";
  out["layers"] = layers_text(layers);
  out["scene"] = std::filesystem::absolute(job.scene.file).lexically_normal().string();
  std::string& overrides = out["overrides"];
  for (const format::KeyValue& set : job.scene.overrides.values()) overrides += set.text + "\n";
  out["frame"] = std::to_string(job.scene.frame);
  char host[256] = "";
  gethostname(host, sizeof(host) - 1);
  out["host"] = host;
  return out;
}

std::string stamp_of(const Job& job, const image::Provenance& provenance, const display::Settings& display,
                     const display::Choice& choice) {
  std::string all;
  for (const std::string& key : keys_of_checkpoints()) all += fmt::format("{} {}\n", key, provenance.at(key));
  all += fmt::format("{:.17g} s, frame {}, {} bits, float {:d}, multipart {:d}, reproducible {:d}, exposure {:.17g}\n",
                     job.sampling.seconds, job.scene.frame, job.outputs.bits, job.outputs.exr.as_float,
                     job.outputs.exr.multipart, job.outputs.reproducible, display.exposure.value_or(0));
  if (job.denoise) all += "denoised\n";
  for (const std::string& word : {job.outputs.exr.compression, display.config, choice.config_id, choice.transform_id,
                                  display.display, display.view, display.look, display.working_space})
    all += word + "\n";
  for (const format::KeyValue& set : job.scene.overrides.values())
    if (set.key != "render.accelerator" && set.key != "render.traversal")  // they change no bits
      all += set.text + "\n";
  return text_hash(all);
}

std::string difference(const image::Provenance& a, const image::Provenance& b, const std::vector<std::string>& keys) {
  const auto value = [](const image::Provenance& p, const std::string& key) {
    const auto found = p.find(key);
    return found == p.end() ? std::string() : found->second;
  };
  static const std::vector<std::pair<std::string, std::string>> names = {
      {"version", "orrery version "}, {"sceneHash", "scene hash "}, {"samples", "--sample-range "},
      {"shard", "--shard "},          {"noise", "--noise "},        {"time", "time budget: "},
      {"limit", "sample limit: "},    {"layers", "layers "}};
  for (const auto& [key, name] : names) {
    if (std::find(keys.begin(), keys.end(), key) == keys.end() || value(a, key) == value(b, key)) continue;
    return fmt::format("{}{}, not {}", name, value(a, key).empty() ? "none" : value(a, key),
                       value(b, key).empty() ? "none" : value(b, key));
  }
  return {};
}

const std::vector<std::string>& keys_of_shards() {
  static const std::vector<std::string> keys = {"version", "sceneHash", "noise", "time", "layers"};
  return keys;
}

const std::vector<std::string>& keys_of_checkpoints() {
  static const std::vector<std::string> keys = {"version", "sceneHash", "samples", "shard",
                                                "noise",   "time",      "limit",   "layers"};
  return keys;
}

bool is_finished(const image::PartialFile& shard) {
  const SampleRange range = sample_range(shard.provenance);
  const std::vector<bool> owned =
      render::pixels_of(pixel_shard(shard.provenance), shard.partial.film.width(), shard.partial.film.height());
  for (std::size_t i = 0; i < owned.size(); ++i)
    if (owned[i] && shard.partial.counts[i] != range.end - range.begin) return false;
  return true;
}

SampleRange sample_range(const image::Provenance& provenance) {
  SampleRange out;
  const auto found = provenance.find("samples");
  if (found != provenance.end()) std::sscanf(found->second.c_str(), "%u:%u", &out.begin, &out.end);
  return out;
}

render::PixelShard pixel_shard(const image::Provenance& provenance) {
  render::PixelShard out;
  const auto found = provenance.find("shard");
  if (found != provenance.end() && std::sscanf(found->second.c_str(), "%d/%d", &out.index, &out.count) == 2)
    --out.index;
  if (out.count > kMaxShards) out.count = 0;  // not written by orrery
  return out;
}

}  // namespace orrery::job
