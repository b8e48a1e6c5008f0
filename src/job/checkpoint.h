// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/stopwatch.h"
#include "compile/forward.h"
#include "display/forward.h"
#include "film/forward.h"
#include "image/header.h"
#include "image/sums_file.h"
#include "job/job.h"
#include "job/layers.h"
#include "job/scene_hash.h"
#include "load/read_scene.h"
#include "render/forward.h"

namespace orrery::job {

/// The provenance of a shard or checkpoint of this job: program version, scene, and every setting that its sums depend
/// on. It prevents merging or resuming incompatible files.
image::Provenance provenance_of(const Job& job, const load::ReadResult& read, const compile::CompiledScene& compiled,
                                const SceneHashes& hashes, const Layers& layers);

/// Hash of everything that determines the images of a job. An image with this stamp in its header is up to date.
///
/// `choice`   the display transform; empty if there is none
std::string stamp_of(const Job& job, const image::Provenance& provenance, const display::Settings& display,
                     const display::Choice& choice);

/// The stamp of an image whose target was missed. With Job::is_strict, such an image is not up to date.
std::string stamp_of_missed(const std::string& stamp);

/// A value of a provenance; empty if there is none.
std::string value_of(const image::Provenance& provenance, const std::string& key);

/// Describes the first difference between two provenances: "camera.vfov = 20, not 30"; empty: none.
///
/// `keys`     the keys to compare
std::string difference(const image::Provenance& a, const image::Provenance& b, const std::vector<std::string>& keys);

/// True if every pixel of a shard has all samples of the shard's range.
bool is_finished(const image::SumsFile& shard);

/// A half-open range of samples per pixel, stored as "0:500".
struct SampleRange {
  std::uint32_t begin = 0, end = 0;
};
SampleRange sample_range(const image::Provenance& provenance);

/// Maximum number of shards: more than is worth a process each.
inline constexpr int kMaxShards = 65536;

/// The pixel shard that a file contains; the count is 0 if its provenance is invalid.
render::PixelShard pixel_shard(const image::Provenance& provenance);

/// True if all files of a job exist, are intact, and equal those that it would write.
bool is_up_to_date(const Job& job, const compile::CompiledScene& compiled, const image::Provenance& provenance,
                   const std::string& stamp);

/// The checkpoint file of a job, named after its first output: shot.0007.checkpoint.exr for shot.0007.exr. Names that
/// would be too long are shortened.
std::filesystem::path checkpoint_file(const std::filesystem::path& first_output);

/// The checkpoint of one job: decides when it is due, reads, writes and removes it.
class Checkpoint {
 public:
  /// Writes sums to a file.
  using Write = std::function<void(const std::filesystem::path& file, const film::Sums& sums)>;

  /// Starts the first interval; no file is read or written yet.
  ///
  /// Domain     `job` outlives this
  Checkpoint(const Job& job, image::Provenance provenance, Write write);

  const std::filesystem::path& file() const { return file_; }

  /// Reads the checkpoint of an earlier run, if the job resumes and the file exists. Warns if it exists and the job
  /// does not resume, because a checkpoint of this run will replace it.
  ///
  /// Errors     base::Error(kBadData) if it is damaged or from another scene, setting or version
  std::optional<film::Sums> load(int width_px, int height_px);

  /// True once per interval, and when a signal requests a checkpoint. Thread-safe.
  bool is_due() const;

  /// Writes a checkpoint during rendering. A failure is only a warning, since the render can still succeed.
  void try_write(const film::Sums& sums);

  /// Writes a checkpoint when the render stops.
  ///
  /// Errors     base::Error: kCannotCreate, kIo
  void write(const film::Sums& sums);

  /// Removes the checkpoint if this job wrote it or resumed from it; writes it instead if the settings keep it. Call
  /// after the images are written.
  ///
  /// `sums`     of all samples
  /// Domain     with sums if the settings keep the checkpoint
  void finish(const std::optional<film::Sums>& sums);

 private:
  const CheckpointSettings& settings_;
  const Hooks& hooks_;
  std::filesystem::path file_;
  image::Provenance provenance_;
  Write write_;
  base::Stopwatch since_last_;  ///< checkpoint
  bool is_ours_ = false;
};

}  // namespace orrery::job
