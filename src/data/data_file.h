// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "data/byte_source.h"
#include "data/table.h"

namespace orrery::data {

struct OpenOptions {
  std::optional<int> component = {};  ///< HDF5: particle type, N of /PartTypeN; default: the only one that is not empty
  std::filesystem::path topology = {};  ///< file that names the particles, see with_topology(); empty: none
  /// Maximum size of decompressed data, bytes. They are kept in memory while they are read.
  std::uint64_t decompressed_limit = std::uint64_t{16} << 30;

  /// Maximum memory for the atoms of PDB and mmCIF while they are parsed, and for the table of the frames of a text
  /// file, bytes; 0: no limit.
  std::uint64_t memory_limit = 0;

  /// Limits decompressed and parsed data to the memory that may be used, bytes; 0: no further limit.
  void limit_memory(std::uint64_t bytes) {
    if (bytes == 0) return;
    decompressed_limit = std::min(decompressed_limit, bytes);
    memory_limit = bytes;
  }
};

/// An opened data file. Not thread-safe; reading uses several threads where that pays.
class DataFile {
 public:
  virtual ~DataFile() = default;

  /// Name of the format, for messages: "LAMMPS dump".
  const char* format = "";
  /// The tables that read() returns view arrays, so that nothing is gained by keeping them.
  bool has_views = false;

  /// Returns the number of frames, at least 1; models of a PDB file are frames. May scan the file once.
  ///
  /// Errors     base::Error(kBadData), as for read()
  virtual int frame_count() = 0;
  /// Returns whether there is a frame, counted from 0, without searching for later ones.
  virtual bool has_frame(int frame) { return frame < frame_count(); }

  /// Describes a frame.
  ///
  /// Domain     0 <= frame < frame_count()
  /// Errors     base::Error(kBadData) with diagnostics: location and remedy; kIo
  virtual FrameInfo describe(int frame) = 0;

  /// Reads columns of a frame, each listed by describe(), in this order. Columns that are not requested cost no memory.
  ///
  /// Numbers may be NaN or infinite if the file contains such values.
  ///
  /// Errors     base::Error(kBadData) with diagnostics for truncated or malformed data; kIo
  /// Cost       memory in proportion to the rows in the file, not to a count that its header declares
  virtual Table read(int frame, const std::vector<std::string>& columns) = 0;

  /// Reads the bonds of a frame.
  ///
  /// `warnings` receives what was left out, and why
  /// Result     in ascending order, without duplicates; empty if the file has none
  /// Errors     base::Error(kBadData) with diagnostics: rows that do not exist, a row that is bonded to itself, too
  ///            many bonds of one row; kIo
  /// Cost       another pass over the file in text formats
  virtual std::vector<Bond> bonds(int frame, std::vector<std::string>& warnings) {
    static_cast<void>(frame);
    static_cast<void>(warnings);
    return {};
  }

  /// Memory that the file takes while it is open and read, bytes, in addition to the tables that are read.
  virtual std::uint64_t memory() const { return 0; }

  /// Returns the columns of a frame that will be read, by its description.
  using Expected = std::function<std::vector<std::string>(const FrameInfo&)>;

  /// Keeps the columns of a frame that are read, so that the file is parsed once. read() then returns views of numbers,
  /// which must not outlive the file.
  ///
  /// `expected`  what is read together with the first column
  virtual void keep(int frame, Expected expected) {
    static_cast<void>(frame);
    static_cast<void>(expected);
  }
};

/// Returns a file that decides whether names are elements, see FrameInfo::names_as_types, and that implements keep().
/// open() returns such a file.
std::unique_ptr<DataFile> settled(std::unique_ptr<DataFile> file);

/// Opens a data file. Its format is recognised by its content; CSV, TSV and plain XYZ, which have no signature, also by
/// the extension.
///
/// Errors     base::Error: kMissingInput, kIo; kBadData with a remedy for unknown formats, LAZ and ADIOS2; kNoMemory
std::unique_ptr<DataFile> open(const std::filesystem::path& file, const OpenOptions& options = {});

/// Returns whether open() recognises a file as a data file.
///
/// `head`     its first bytes: 64 KiB suffice
bool is_data_file(const std::filesystem::path& file, std::string_view head);

/// Returns a table in memory as a data file of one frame, equivalent to the PLY file that write_table() would write, or
/// to the NPY file if it has columns of strings, after settled(). Columns that are views stay views.
///
/// `name`     for messages
/// `box`      simulation box, which files of these formats do not have
/// Domain     columns with table.rows rows and distinct names
/// Errors     base::Error(kBadData): there are no columns x, y and z
std::unique_ptr<DataFile> open_table(const std::filesystem::path& name, std::shared_ptr<const Table> table,
                                     const std::optional<Box>& box = {});

}  // namespace orrery::data
