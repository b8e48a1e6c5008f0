// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "data/data_file.h"
#include "data/table.h"
#include "scene/scene.h"
#include "scene/validate.h"

namespace orrery::points {

/// The data from which spheres were made.
struct SourceRows {
  data::FrameInfo info;             ///< of the frame
  data::Table table;                ///< all columns of the frame
  std::vector<std::uint32_t> rows;  ///< row of each sphere; copies of a particle have the same one
};

/// Opens a data file, as data::open() does.
using OpenData = std::function<std::unique_ptr<data::DataFile>(const std::filesystem::path&, const data::OpenOptions&)>;

struct LoadRequest {
  std::filesystem::path file;      ///< the data file
  std::filesystem::path folder;    ///< of the scene file, for the file of a colour map
  std::string key;                 ///< "points[0]", for diagnostics
  int frame = 1;                   ///< the rendered frame
  bool is_sequence = false;        ///< the rendered frame has chosen the file
  std::size_t materials = 0;       ///< number of materials of the scene
  SourceRows* source = nullptr;    ///< if not null, receives the rows of the spheres
  std::uint64_t memory_limit = 0;  ///< bytes that the spheres may take; 0: no limit
  OpenData open = {};              ///< replaces data::open(), except in a sequence of files
};

/// Reads the spheres of a data file into `points`, as its keys say: selects rows, determines radii and colours, copies
/// and transforms. The spheres are in the order of the particle ids, if the file has any, so that all frames have the
/// same order.
///
/// Result     diagnostics about keys of the scene file: unknown columns, missing radii, selections that match nothing;
///            `points` has no spheres if one of them is an error
/// Errors     base::Error: those of data::open and data::DataFile; kNoMemory
/// Cost       one read of the needed columns, or of all columns for `source`
std::vector<scene::SceneDiagnostic> load_points(const LoadRequest& request, scene::Points& points);

}  // namespace orrery::points
