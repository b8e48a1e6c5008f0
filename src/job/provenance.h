// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "compile/forward.h"
#include "display/forward.h"
#include "format/forward.h"
#include "image/forward.h"
#include "image/provenance.h"
#include "render/forward.h"

namespace orrery::job {

struct Job;
struct Layers;
struct SceneHashes;

/// The provenance of a shard or checkpoint of this job: program version, scene, and every setting that its sums depend
/// on. It prevents merging or resuming incompatible files.
image::Provenance provenance_of(const Job& job, const format::ReadResult& read, const compile::CompiledScene& compiled,
                                const SceneHashes& hashes, const Layers& layers);

/// Hash of everything that determines the images of a job. An image with this stamp in its header is up to date.
///
/// `choice`   the display transform; empty if there is none
std::string stamp_of(const Job& job, const image::Provenance& provenance, const display::Settings& display,
                     const display::Choice& choice);

/// Describes the first difference between two provenances: "camera.vfov = 20, not 30"; empty: none.
///
/// `keys`     the keys to compare
std::string difference(const image::Provenance& a, const image::Provenance& b, const std::vector<std::string>& keys);

/// The keys whose values must match in all shards of an image, and in a finished file and the job that would write it.
const std::vector<std::string>& keys_of_shards();
const std::vector<std::string>& keys_of_files();

/// Describes why a job cannot continue from a checkpoint; empty: it can. It can have more samples than the checkpoint.
std::string difference_of_checkpoint(const image::Provenance& checkpoint, const image::Provenance& job);

/// True if every pixel of a shard has all samples of the shard's range.
bool is_finished(const image::PartialFile& shard);

/// A half-open range of samples per pixel, stored as "0:500".
struct SampleRange {
  std::uint32_t begin = 0, end = 0;
};
SampleRange sample_range(const image::Provenance& provenance);

/// Maximum number of shards: more than is worth a process each.
inline constexpr int kMaxShards = 65536;

/// The pixel shard that a file contains; the count is 0 if its provenance is invalid.
render::PixelShard pixel_shard(const image::Provenance& provenance);

}  // namespace orrery::job
