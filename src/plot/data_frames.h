// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "data/forward.h"
#include "data/table.h"
#include "points/open_data.h"
#include "points/source_rows.h"
#include "scene/forward.h"

namespace orrery::plot {

struct DataOptions;
struct LoadedFrame;

/// The frames of a data file, or of a sequence of files.
class DataFrames {
 public:
  /// Opens the first frame.
  ///
  /// `folder`   to which the file of a colour map is relative
  /// Domain     `options` outlive it
  /// Errors     base::Error: those of particles::open(); kUsage for all frames of a sequence of files; kBadData for
  /// frames
  ///            that the file does not have
  DataFrames(const DataOptions& options, const std::filesystem::path& folder);
  ~DataFrames();

  data::Format format() const;
  /// The first of the frames, with derived columns.
  const data::FrameInfo& info() const { return info_; }
  /// Its number in the file, from 1.
  int described_frame() const { return described_; }
  bool is_sequence() const { return is_sequence_; }
  /// The number of frames of the file; nothing if it is not known: the file is large and would have to be read, or ends
  /// within a frame. 1 for a sequence of files.
  std::optional<int> frame_count() const;
  /// The frames to use; empty: one, without a number of its own.
  const std::vector<int>& numbers() const { return numbers_; }
  /// The frames to use; { 1 } if they have no numbers.
  std::vector<int> all() const { return numbers_.empty() ? std::vector<int>{1} : numbers_; }
  std::filesystem::path file_of(int frame) const;

  /// Reads the spheres of a frame.
  ///
  /// `keys`     what to read, and how
  /// `source`   see points::LoadRequest
  /// Errors     base::Error: those of points::load_points(); kBadData with its errors
  LoadedFrame load(int frame, const scene::Points& keys, points::SourceRows* source = nullptr) const;

 private:
  void require_frames() const;

  const DataOptions& options_;
  std::filesystem::path folder_;
  bool is_sequence_;
  points::OpenData open_ = points::open_once();
  std::unique_ptr<data::DataFile> file_;
  data::FrameInfo info_;
  int described_ = 1;
  std::vector<int> numbers_;
};

/// Sets the keys of a colour by its name in DataOptions::color_by.
///
/// Result     true if the colour map was chosen here, because the user chose none
/// Errors     base::Error(kUsage) if the user has set a map or a range that would have no effect
bool set_color(const DataOptions& options, const std::string& color_by, const data::FrameInfo& info,
               scene::PointsColor& color);

/// Widens the range of values that are coloured by a map by those of a frame, for one range in all frames.
void widen(std::optional<scene::Interval>& range, const scene::Points& points);

}  // namespace orrery::plot
