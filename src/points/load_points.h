// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "data/data_file.h"
#include "scene/diagnostic.h"
#include "scene/scene.h"

namespace orrery::points {

/// Opens a data file, as data::open() does.
using OpenData = std::function<std::shared_ptr<data::DataFile>(const std::filesystem::path&, const data::OpenOptions&)>;

/// The data from which spheres were made.
struct SourceRows {
  data::FrameInfo info;             ///< description of the frame
  data::Table table;                ///< all columns of the frame
  std::vector<std::uint32_t> rows;  ///< row of each sphere; copies of a particle have the same one
  std::vector<scene::SphereBond> bond_pairs;
  std::vector<scene::BondStub> bond_stubs;
};

/// The spheres of a frame, for the next call of load_points(): it takes them if its keys are the same, and else drops
/// them.
struct LoadedPoints {
  int frame = 1;
  scene::Points points;
  std::vector<scene::SceneDiagnostic> diagnostics;
};

struct LoadRequest {
  std::filesystem::path file;                               ///< the data file
  std::filesystem::path topology = {};                      ///< see data::OpenOptions
  std::filesystem::path folder;                             ///< folder of the scene file, for the file of a colour map
  std::string key;                                          ///< "points[0]", for diagnostics
  int frame = 1;                                            ///< the rendered frame
  const std::vector<scene::Material>* materials = nullptr;  ///< of the scene; null: none
  SourceRows* source = nullptr;                             ///< if not null, receives the rows of the spheres
  std::function<void(double)> on_value;       ///< receives the values that a continuous colour map shows; may be empty
  std::uint64_t memory_limit = 0;             ///< maximum memory of the spheres, bytes; 0: no limit
  OpenData open = {};                         ///< replaces data::open(), except in a sequence of files
  std::shared_ptr<LoadedPoints> loaded = {};  ///< spheres that were read before; may be null
  /// If spheres move, see scene::PointsKeys::motion: the time of their centres, frames relative to the frame. None:
  /// they rest.
  std::optional<double> moves_from = {};
  bool has_previous = false;  ///< they also need PointsSpheres::to_previous
};

/// Reads the spheres of a data file into `points` according to its keys: selects rows, determines radii and colours,
/// copies and transforms. The spheres are ordered by particle id if the file has ids, so that all frames have the same
/// order.
///
/// Result     diagnostics about keys of the scene file: unknown columns, missing radii, selections that match nothing;
///            `points` has no spheres if one of them is an error
/// Errors     base::Error: those of data::open and data::DataFile; kNoMemory
/// Cost       one read of the needed columns, or of all columns for `source`; nothing for LoadRequest::loaded
std::vector<scene::SceneDiagnostic> load_points(const LoadRequest& request, scene::Points& points);

/// Reads the rods of a data file, one per row: ends from the columns x0, y0, z0, x1, y1, z1, radii from `radius`,
/// unless the scene file sets it.
///
/// Result     diagnostics about keys of the scene file: missing columns; `rods` has none if one of them is an error
/// Errors     base::Error: those of data::open and data::DataFile; kNoMemory
std::vector<scene::SceneDiagnostic> load_rods(const LoadRequest& request, scene::RodFile& rods);

/// Returns the frame of the file, from 1, that load_points() would read.
///
/// Result     beyond the last frame if the file does not have the requested one
/// Errors     those of data::open
/// Cost       opens the file if it may have several frames; counting them may read all of it
int chosen_frame(const LoadRequest& request, const scene::PointsKeys& points);

/// Returns a function that opens data files for several frames. It keeps the most recent files open, so that each frame
/// is searched from the end of the previous one and compressed data are decompressed only once. A file that has changed
/// is reopened.
///
/// Result     not thread-safe; copies share the open files
/// Errors     those of data::open()
OpenData open_once();

/// Returns a function that opens a file by `open`, but only the first time: the file is closed after its first use.
OpenData handed_over(OpenData open);

}  // namespace orrery::points
