// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
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
  /// Maximum size of decompressed data, bytes. They are kept in memory while they are read.
  std::uint64_t decompressed_limit = std::uint64_t{16} << 30;

  /// Maximum size of a plain file of which a copy is kept in memory, bytes: each byte is then read only once.
  std::uint64_t kept_limit = 0;

  /// PDB, mmCIF: maximum memory for parsing the atoms, bytes; 0: no limit.
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

  /// Returns the number of frames, at least 1; models of a PDB file are frames. May scan the file once.
  ///
  /// Errors     base::Error(kBadData), as for read()
  virtual int frame_count() = 0;

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
  /// Result     in ascending order, without duplicates; empty if the file has none
  /// Errors     base::Error(kBadData) with diagnostics: rows that do not exist, a row that is bonded to itself, too
  ///            many bonds of one row; kIo
  /// Cost       another pass over the file in text formats
  virtual std::vector<Bond> bonds(int frame) {
    static_cast<void>(frame);
    return {};
  }

  /// Memory that the file takes while it is open and read, bytes, in addition to the tables that are read.
  virtual std::uint64_t memory() const { return 0; }
};

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
/// to the NPY file if it has columns of strings. Columns that are views stay views.
///
/// `name`     for messages
/// `box`      simulation box, which files of these formats do not have
/// Domain     columns with table.rows rows and distinct names
/// Errors     base::Error(kBadData): there are no columns x, y and z
std::unique_ptr<DataFile> open_table(const std::filesystem::path& name, std::shared_ptr<const Table> table,
                                     const std::optional<Box>& box = {});

}  // namespace orrery::data
