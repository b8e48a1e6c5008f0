// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "data/faults.h"
#include "data/table.h"

/// Wrapper for the part of the HDF5 library that the snapshot reader uses; translates its errors.
namespace orrery::arrays::hdf5 {

/// Owns an HDF5 identifier.
class Handle {
 public:
  Handle() = default;
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }

  explicit operator bool() const { return id_ >= 0; }
  hid_t id() const { return id_; }

 private:
  hid_t id_ = -1;
  herr_t (*close_)(hid_t) = nullptr;
};

/// Opens a file for reading, without locking it: simulations may run, and some network file systems have no locks.
///
/// Errors     base::Error(kBadData)
Handle open_file(const std::filesystem::path& file);

/// Opens a group; an empty handle if there is none.
Handle open_group(const Handle& parent, const std::string& name);

/// Names of the links in a group.
std::vector<std::string> link_names(const Handle& group);

/// Returns the numbers of an attribute; empty if there is none, or if it is not numeric.
std::vector<double> attribute(const Handle& object, const char* name);

/// A dataset of numbers with rows of one or more components.
class Dataset {
 public:
  /// Opens a numeric dataset with one or two dimensions; empty if the group has none of this name.
  Dataset(const Handle& group, const std::string& name);

  explicit operator bool() const { return static_cast<bool>(handle_); }
  std::uint64_t rows() const { return rows_; }
  std::uint64_t components() const { return components_; }
  /// The column type that stores the values without loss. For uint64 it is int64, with the same bits.
  data::ColumnType type() const { return type_; }

  /// Checks that the rows are backed by data before memory is allocated for them.
  ///
  /// `limit`    maximum size after decompression, bytes
  /// Errors     base::Error(kBadData), thrown through `faults`
  void require_data(std::uint64_t file_size, std::uint64_t limit, data::Faults& faults) const;

  /// Appends some components of all rows to columns of the dataset's type.
  ///
  /// Errors     base::Error(kBadData), thrown through `faults`: damaged data
  /// Cost       one pass over the dataset, however many components are read
  void append(const std::vector<std::pair<std::uint64_t, data::Values*>>& columns, data::Faults& faults) const;

 private:
  template <typename T>
  void append_as(const std::vector<std::pair<std::uint64_t, data::Values*>>& columns, data::Faults& faults) const;
  /// Number of rows to read at a time: whole chunks, so that each is decompressed only once.
  std::uint64_t block_rows() const;

  std::string name_;
  Handle handle_;
  int dimensions_ = 0;
  std::uint64_t rows_ = 0, components_ = 1;
  std::size_t value_bytes_ = 0;
  data::ColumnType type_ = data::ColumnType::kFloat64;
  hid_t memory_type_ = -1;  ///< predefined, not owned
};

}  // namespace orrery::arrays::hdf5
