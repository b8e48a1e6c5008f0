// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "plot/range.h"
#include "points/load_points.h"
#include "scene/forward.h"

namespace orrery::plot {

/// Options for reading a data file, common to all commands that turn particles into spheres.
struct DataOptions {
  std::filesystem::path file;  ///< data file, may contain a frame pattern
  std::vector<int> frames;     ///< empty: one frame
  bool all_frames = false;     ///< all frames of the file
  scene::PointsKeys points;    ///< that the user has set; `file` is not used, `frame` may be counted from the end, -1
  std::string color_by;        ///< "element", "type", "rgb", "none" or a column; empty: not set
  bool has_map = false;        ///< the user set `points.color.map`
  RangeChoice range;           ///< of the colour map, where `points.color.range` is not set
  /// Slice planes: axis 0, 1 or 2, and position. Spheres in front of any of them are removed.
  std::vector<std::pair<int, double>> slices = {};
  std::uint64_t memory_limit = 0;  ///< bytes; 0: no limit
  points::OpenData open = {};      ///< opens `file`; default: by its name
};

/// Spheres of a frame, and warnings about the data and the options.
struct LoadedFrame {
  scene::Points points;
  std::vector<scene::SceneDiagnostic> diagnostics;  ///< the warnings, with their keys
  std::vector<base::Diagnostic> warnings;
};

/// What DataFrames::measures() measures; 0: not requested, or 0 in all frames.
struct Measures {
  double spacing = 0;      ///< median distance between neighbours
  double mean_radius = 0;  ///< of the spheres
  double rms_vector = 0;   ///< root mean square length of the vectors
};

/// The frames of a data file, or of a sequence of files.
class DataFrames {
 public:
  /// Opens the first frame.
  ///
  /// `folder`   base folder of a colour-map file
  /// `kept`     columns of that frame to keep, so that several calls of load() read them once; empty: none are kept
  /// Domain     `options` outlive it
  /// Errors     base::Error: those of data::open(); kUsage for all frames of a sequence of files; kBadData for
  ///            frames that the file does not contain
  DataFrames(const DataOptions& options, const std::filesystem::path& folder,
             const data::DataFile::Expected& kept = {});

  const char* format() const;
  /// Opens data files: those that are open are not opened again.
  const points::OpenData& open_data() const { return open_; }
  /// Description of the first frame, including derived columns.
  const data::FrameInfo& info() const { return info_; }
  /// Number of that frame in the file, from 1.
  int described_frame() const { return described_; }
  bool is_sequence() const { return is_sequence_; }
  /// Whether there is more than one frame.
  bool has_several() const { return is_sequence_ || file_->has_frame(1); }
  /// DataOptions::points.frame, counted from the first.
  const std::optional<int>& fixed_frame() const { return fixed_frame_; }
  /// The number of frames of the file; 1 for a sequence of files. Empty if unknown: the file is large and would have to
  /// be read, or ends within a frame.
  std::optional<int> frame_count() const;
  /// The frames to use; empty: a single frame without a number. All frames of a file of which some are kept are known
  /// after visit(), and before it at most the first two.
  const std::vector<int>& numbers() const { return numbers_; }
  /// The frames to use; { 1 } for a single frame without a number.
  std::vector<int> all() const { return numbers_.empty() ? std::vector<int>{1} : numbers_; }
  /// Calls f(frame) for the frames to use that differ: a file with a single frame is the same in all. All frames of a
  /// file are found while they are visited, so that their rows are not read to count them.
  void visit(const std::function<void(int frame)>& f);
  /// Counts all frames of the file, if they are to be used, without visiting them.
  void count();
  std::filesystem::path file_of(int frame) const;

  /// Reads the spheres of a frame.
  ///
  /// `keys`     the scene's keys: what to read, and how
  /// `source`, `on_value`   see points::LoadRequest
  /// Errors     base::Error: those of points::load_points(); kBadData with its errors
  LoadedFrame load(int frame, const scene::PointsKeys& keys, points::SourceRows* source = nullptr,
                   const std::function<void(double)>& on_value = {}) const;

  /// Measures all particles, each value in the first frame in which it is not 0. The values depend on the file alone,
  /// not on which frame and which particles are used: all panels of a figure show a particle in one size. Of a sequence
  /// of files, the frames to use are measured.
  ///
  /// `keys`     the scene's keys, whose vectors are measured
  /// Errors     as load()
  /// Cost       one pass over these frames; another over a frame that has particles without a valid radius
  Measures measures(const scene::PointsKeys& keys, bool of_spacing, bool of_radii) const;
  /// The distinct values of a column in the frame that is described, as text.
  ///
  /// Errors     as load(); kBadData if there are more than 4096
  std::vector<std::string> distinct_values(const scene::PointsKeys& keys, const std::string& column) const;
  /// The mean number of atoms that are as close to an atom as covalent bonds are long, in the first frame; of more than
  /// 100,000 atoms, that of 20,000 around one of them.
  ///
  /// Result     0 for elements without a covalent radius, and for more such atoms than find_bonds() accepts
  double mean_coordination(const scene::PointsKeys& keys) const;

 private:
  void require_frames() const;

  const DataOptions& options_;
  std::filesystem::path folder_;
  bool is_sequence_;
  points::OpenData open_;
  std::shared_ptr<data::DataFile> file_;
  data::FrameInfo info_;
  std::optional<int> fixed_frame_;
  int described_ = 1;
  std::vector<int> numbers_;
  bool are_counted_ = true;  ///< `numbers_` is complete
};

/// Returns the condition that all conditions are met; empty if there are none.
///
/// Errors     base::Error(kBadData) if one of several is not closed
std::string all_of(const std::vector<std::string>& conditions);

}  // namespace orrery::plot
