// SPDX-License-Identifier: Apache-2.0
#include "job/memory.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "job/text.h"
#include "base/error.h"
#include "film/layer_film.h"
#include "film/layer_pixel.h"
#include "kernel/pixel_sum.h"
#include "kernel/sphere.h"

namespace orrery::job {
namespace {

/// Embree's user geometry while it is built, one primitive a sphere, on top of the sphere itself. Measured on clouds of
/// one and three million: peak_memory_bytes of --stats with embree less that with list.
constexpr std::uint64_t kAcceleratorBytesPerSphere = 130;

/// A sphere, and the index of its material.
constexpr std::uint64_t kBytesPerSphere = sizeof(kernel::Sphere) + sizeof(std::uint32_t);

/// A pixel's sum, and the four floats of the finished picture.
constexpr std::uint64_t kFilmBytesPerPixel = sizeof(kernel::PixelSum) + 4 * sizeof(float);

/// A layer's value, and its copy that is handed to the encoder.
constexpr std::uint64_t kBytesPerLayerPlane = 2 * sizeof(float);

/// The number after a line's key, in a file of "key number unit" lines; of a file of one number: `key` is empty.
std::optional<std::uint64_t> number_in(const std::filesystem::path& file, const std::string& key) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string word = key;
    std::uint64_t number = 0;
    if (!key.empty()) words >> word;
    if (word == key && words >> number) return number;
  }
  return {};
}

/// What one control group still grants; nothing where it has no limit.
std::optional<std::uint64_t> granted_by(const std::filesystem::path& group) {
  const auto limit = number_in(group / "memory.max", "");  // "max" is no number
  const auto used = number_in(group / "memory.current", "");
  if (!limit || !used) return {};
  // Files that were read count as used, and go as soon as somebody needs the memory.
  const std::uint64_t files = number_in(group / "memory.stat", "inactive_file").value_or(0);
  const std::uint64_t held = *used - std::min(files, *used);
  return *limit - std::min(held, *limit);
}

}  // namespace

MemoryEstimate estimate_memory(const MemoryNeeds& needs) {
  // The picture; a sample count and a goal; with layers the sums of the pixel's paths; with adaptive sampling a second
  // sum and seven numbers for the noise estimate.
  const std::uint64_t a_pixel = kFilmBytesPerPixel + needs.layer_planes * kBytesPerLayerPlane +
                                2 * sizeof(std::uint32_t) + (needs.layers ? sizeof(film::LayerPixel) : 0) +
                                (needs.in_rounds ? sizeof(kernel::PixelSum) + 7 * sizeof(float) : 0);
  MemoryEstimate m;
  m.film = static_cast<std::uint64_t>(needs.width) * static_cast<std::uint64_t>(needs.height) * a_pixel;
  m.spheres = needs.spheres * kBytesPerSphere;
  m.accelerator = needs.embree ? needs.spheres * kAcceleratorBytesPerSphere : 0;
  return m;
}

MemoryNeeds memory_needs(const compile::CompiledScene& compiled, const film::LayerRequest& layers, bool in_rounds) {
  MemoryNeeds needs;
  needs.width = compiled.width;
  needs.height = compiled.height;
  needs.spheres = compiled.spheres.size();
  needs.layer_planes = film::planes_of(layers).size();
  needs.layers = layers.any();
  needs.embree = compiled.accelerator == compile::Accelerator::kEmbree;
  needs.in_rounds = in_rounds;
  return needs;
}

std::optional<std::uint64_t> available_memory(const std::filesystem::path& root) {
  std::optional<std::uint64_t> least;
  const auto at_most = [&](std::optional<std::uint64_t> bytes) {
    if (bytes && (!least || *bytes < *least)) least = bytes;
  };
  if (const auto kib = number_in(root / "proc/meminfo", "MemAvailable:")) at_most(*kib * 1024);

  // "0::/a/b": this process is in /a/b, and in every group above it.
  std::ifstream groups(root / "proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    if (line.rfind("0::/", 0) != 0) continue;
    const std::filesystem::path top = root / "sys/fs/cgroup";
    std::filesystem::path group = line.substr(4);
    for (at_most(granted_by(top / group)); !group.empty(); at_most(granted_by(top / group)))
      group = group.parent_path();
  }
  return least;
}

void require_memory(const MemoryEstimate& needed, std::uint64_t limit) {
  const std::uint64_t allowed = limit > 0 ? limit : available_memory().value_or(needed.total());
  if (needed.total() <= allowed) return;
  std::string text;
  base::append(text, "the render needs about %s (spheres %s, accelerator %s, film %s), and %s %s; ",
               base::bytes_text(needed.total()).c_str(), base::bytes_text(needed.spheres).c_str(),
               base::bytes_text(needed.accelerator).c_str(), base::bytes_text(needed.film).c_str(),
               base::bytes_text(allowed).c_str(), limit > 0 ? "is what --memory-limit allows" : "is free");
  text += limit > 0 ? "allow more" : "free some, or say --memory-limit to try nevertheless";
  throw base::Error(base::ErrorKind::kNoMemory, text);
}

}  // namespace orrery::job
