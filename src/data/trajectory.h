// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "data/data_file.h"
#include "data/records.h"

namespace orrery::data {

/// GROMACS computes in nanometres. Its files are read in ångström, the unit of PDB files and of the radii of elements.
inline constexpr float kAngstromPerNm = 10;

/// Columns in an array of a trajectory.
struct TrajectoryArray {
  RecordLayout layout;
  std::vector<RecordField> fields;
  float factor = 1;  ///< of the numbers in the file
};

/// A frame of a binary trajectory.
struct TrajectoryFrame {
  std::uint64_t end = 0;  ///< offset after the frame; may be beyond the end of the file
  std::uint64_t rows = 0;
  std::optional<double> step, time_ps;
  std::optional<Box> box;
  std::vector<TrajectoryArray> arrays;  ///< those of the positions first; all in the file if the frame is
};

/// A binary trajectory: frames of positions, without names of the particles. Frames are found on demand by their
/// headers, so that those in between are not read.
class TrajectoryFile : public DataFile {
 public:
  int frame_count() final;
  bool has_frame(int number) final;
  FrameInfo describe(int number) final;
  Table read(int number, const std::vector<std::string>& columns) override;
  std::uint64_t memory() const final { return bytes_->memory() + begins_.capacity() * sizeof(begins_[0]); }

 protected:
  explicit TrajectoryFile(Bytes bytes) : bytes_(std::move(bytes)) {}
  /// Sets the offset of the first frame; default: 0.
  void begin_at(std::uint64_t offset) { next_ = offset; }

  const ByteSource& bytes() const { return *bytes_; }
  /// Returns a frame that is complete.
  TrajectoryFrame frame(int number);
  [[noreturn]] void fail(int number, const std::string& text, const std::string& remedy = {}) const;
  /// Returns the next bytes of a header, and moves `at` behind them.
  std::string header_bytes(std::uint64_t& at, std::size_t count, int number) const;
  /// Returns the box with nine numbers, three vectors; none if all are 0.
  std::optional<Box> box_of(const std::vector<double>& edges, int number) const;

 private:
  /// Reads the header of a frame.
  ///
  /// `number`   from 0, for messages
  virtual TrajectoryFrame header(std::uint64_t begin, int number) const = 0;

  Bytes bytes_;
  std::vector<std::uint64_t> begins_;  ///< offsets of the frames found so far
  std::uint64_t next_ = 0;             ///< offset after the last of them
};

/// Returns a trajectory whose particles have the other columns, and the bonds, of a file that names them.
///
/// `topology`  has a frame with as many rows; its first one is used
/// Errors      base::Error(kBadData) for another number of rows, and for a file that names its particles
std::unique_ptr<DataFile> with_topology(std::unique_ptr<DataFile> trajectory, std::unique_ptr<DataFile> topology,
                                        const std::filesystem::path& trajectory_name,
                                        const std::filesystem::path& topology_name);

}  // namespace orrery::data
