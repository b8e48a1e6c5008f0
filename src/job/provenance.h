// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "job/job.h"
#include "job/layers.h"
#include "compile/compiled_scene.h"
#include "image/partial_file.h"

namespace orrery::job {

/// What a partial of this job says of itself: the program's version, the scene, and every setting that its sums depend
/// on, so that nothing is joined or gone on with that does not belong together.
image::Provenance provenance_of(const Job& job, const compile::CompiledScene& compiled, const Layers& layers);

/// A name for the files of a job: whoever finds it in a picture's header knows that it would come out as it is.
std::string stamp_of(const Job& job, const image::Provenance& provenance, const display::Settings& display);

/// Why something of one provenance does not belong to the other: "scene hash 1234, not 5678"; empty where it does.
///
/// `keys`     what must be the same
std::string difference(const image::Provenance& a, const image::Provenance& b, const std::vector<std::string>& keys);

/// What must be the same for parts of one picture, and for a render that goes on.
const std::vector<std::string>& keys_of_parts();
const std::vector<std::string>& keys_of_checkpoints();

/// True where each pixel of a part's share has all the samples of its range.
bool is_finished(const image::PartialFile& part);

/// "0:500" as numbers.
struct SampleRange {
  std::uint32_t begin = 0, end = 0;
};
SampleRange sample_range(const image::Provenance& provenance);
render::PixelShard pixel_shard(const image::Provenance& provenance);

}  // namespace orrery::job
