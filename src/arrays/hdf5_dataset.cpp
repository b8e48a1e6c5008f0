// SPDX-License-Identifier: Apache-2.0
#include "arrays/hdf5_dataset.h"

#include <algorithm>

#include <fmt/core.h>

#include "base/stop_point.h"
#include "base/text.h"
#include "data/byte_source.h"
#include "data/faults.h"
#include "data/records.h"

namespace orrery::arrays::hdf5 {

using namespace data;  // NOLINT(google-build-using-namespace)

namespace {

/// The innermost message on the library's stack of errors.
std::string last_error() {
  std::string text;
  const auto take = [](unsigned level, const H5E_error2_t* error, void* out) -> herr_t {
    if (level == 0 && error->desc != nullptr) *static_cast<std::string*>(out) = error->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take, &text);
  return text.empty() ? "unknown error" : text;
}

/// Column type and in-memory type of stored numbers; the latter is negative for unsupported types.
struct Types {
  ColumnType column = ColumnType::kFloat64;
  hid_t memory = -1;
};

Types types_of(const Handle& stored) {
  const std::size_t bytes = H5Tget_size(stored.id());
  const H5T_class_t kind = H5Tget_class(stored.id());
  if (kind == H5T_FLOAT)
    return bytes <= 4 ? Types{ColumnType::kFloat32, H5T_NATIVE_FLOAT} : Types{ColumnType::kFloat64, H5T_NATIVE_DOUBLE};
  if (kind != H5T_INTEGER || bytes > 8) return {};
  if (H5Tget_sign(stored.id()) == H5T_SGN_2)
    return bytes <= 4 ? Types{ColumnType::kInt32, H5T_NATIVE_INT32} : Types{ColumnType::kInt64, H5T_NATIVE_INT64};
  if (bytes == 1) return {ColumnType::kUint8, H5T_NATIVE_UINT8};
  if (bytes == 2) return {ColumnType::kUint16, H5T_NATIVE_UINT16};
  return {ColumnType::kInt64, H5T_NATIVE_UINT64};
}

}  // namespace

Handle open_file(const std::filesystem::path& file) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // the library would print its errors
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_file_locking(access.id(), false, true);
  Handle handle(H5Fopen(file.c_str(), H5F_ACC_RDONLY, access.id()), H5Fclose);
  if (!handle) Faults(file).fail(0, "damaged HDF5 file: " + last_error());
  return handle;
}

Handle open_group(const Handle& parent, const std::string& name) {
  return {H5Gopen2(parent.id(), name.c_str(), H5P_DEFAULT), H5Gclose};
}

std::vector<std::string> link_names(const Handle& group) {
  std::vector<std::string> names;
  H5G_info_t info{};
  if (H5Gget_info(group.id(), &info) < 0) return names;
  for (hsize_t i = 0; i < info.nlinks; ++i) {
    const auto name_at = [&](char* out, std::size_t size) {
      return H5Lget_name_by_idx(group.id(), ".", H5_INDEX_NAME, H5_ITER_INC, i, out, size, H5P_DEFAULT);
    };
    const ssize_t length = name_at(nullptr, 0);
    if (length < 0) return names;
    std::string name(static_cast<std::size_t>(length), '\0');
    name_at(name.data(), name.size() + 1);
    names.push_back(std::move(name));
  }
  return names;
}

std::vector<double> attribute(const Handle& object, const char* name) {
  constexpr hssize_t kMaxValues = 64;
  if (H5Aexists(object.id(), name) <= 0) return {};
  const Handle handle(H5Aopen(object.id(), name, H5P_DEFAULT), H5Aclose);
  const Handle space(H5Aget_space(handle.id()), H5Sclose);
  const hssize_t count = H5Sget_simple_extent_npoints(space.id());
  if (count <= 0 || count > kMaxValues) return {};
  std::vector<double> values(static_cast<std::size_t>(count));
  if (H5Aread(handle.id(), H5T_NATIVE_DOUBLE, values.data()) < 0) return {};
  return values;
}

Dataset::Dataset(const Handle& group, const std::string& name) : name_(name) {
  Handle handle(H5Dopen2(group.id(), name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!handle) return;
  const Handle space(H5Dget_space(handle.id()), H5Sclose), stored(H5Dget_type(handle.id()), H5Tclose);
  dimensions_ = H5Sget_simple_extent_ndims(space.id());
  if (dimensions_ != 1 && dimensions_ != 2) return;
  hsize_t extent[2] = {0, 1};
  H5Sget_simple_extent_dims(space.id(), extent, nullptr);
  const Types types = types_of(stored);
  if (types.memory < 0) return;
  rows_ = extent[0];
  components_ = extent[1];
  value_bytes_ = H5Tget_size(stored.id());
  type_ = types.column;
  memory_type_ = types.memory;
  handle_ = std::move(handle);
}

void Dataset::require_data(std::uint64_t file_size, std::uint64_t limit, Faults& faults) const {
  const Handle creation(H5Dget_create_plist(handle_.id()), H5Pclose);
  const std::uint64_t stored = H5Dget_storage_size(handle_.id());
  // In floating point: the product may overflow.
  const double bytes =
      static_cast<double>(rows_) * static_cast<double>(components_) * static_cast<double>(value_bytes_);
  const std::string declared = fmt::format("`{}` declares {} rows, but ", name_, rows_);
  if (H5Pget_external_count(creation.id()) > 0)
    faults.fail(0, fmt::format("`{}` is stored in another file, which is not supported", name_));
  const bool is_virtual = H5Pget_layout(creation.id()) == H5D_VIRTUAL;
  if (!is_virtual && rows_ > 0 && stored == 0) faults.fail(0, declared + "has no data");
  if (!is_virtual && stored > file_size)
    faults.fail(0, fmt::format("{}the file has only {}: it may be truncated", declared, base::bytes_text(file_size)));
  if (static_cast<double>(stored) < bytes && bytes > static_cast<double>(limit))
    faults.fail(0, fmt::format("`{}` decompresses to more than {}", name_, base::bytes_text(limit)));
}

std::uint64_t Dataset::block_rows() const {
  constexpr std::uint64_t kBlockBytes = std::uint64_t{8} << 20;
  const std::uint64_t wanted = std::max<std::uint64_t>(1, kBlockBytes / (components_ * sizeof(double)));
  const Handle creation(H5Dget_create_plist(handle_.id()), H5Pclose);
  hsize_t chunk[2] = {1, 1};
  if (H5Pget_layout(creation.id()) != H5D_CHUNKED || H5Pget_chunk(creation.id(), 2, chunk) < 0 || chunk[0] == 0)
    return std::min(rows_, wanted);
  return std::min<std::uint64_t>(rows_, std::max<std::uint64_t>(1, wanted / chunk[0]) * chunk[0]);
}

template <typename T>
void Dataset::append_as(const std::vector<std::pair<std::uint64_t, Values*>>& columns, Faults& faults) const {
  const auto check = [&](herr_t status) {
    if (status < 0) faults.fail(0, fmt::format("cannot read `{}`: {}", name_, last_error()));
  };
  const std::size_t begin = std::get<std::vector<T>>(*columns.front().second).size();
  for (const auto& [component, values] : columns)
    std::get<std::vector<T>>(*values).resize(begin + static_cast<std::size_t>(rows_));
  if (components_ == 1) {
    for (const auto& [component, values] : columns) {
      T* const out = std::get<std::vector<T>>(*values).data() + begin;
      check(H5Dread(handle_.id(), memory_type_, H5S_ALL, H5S_ALL, H5P_DEFAULT, out));
    }
    return;
  }
  const std::uint64_t block = block_rows();
  std::vector<T> buffer(static_cast<std::size_t>(block * components_));
  const Handle space(H5Dget_space(handle_.id()), H5Sclose);
  const base::StopPoint stop;
  for (std::uint64_t row = 0; row < rows_; row += block) {
    stop.check();
    const hsize_t offset[2] = {row, 0}, count[2] = {std::min(block, rows_ - row), components_};
    const Handle memory(H5Screate_simple(2, count, nullptr), H5Sclose);
    check(H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, offset, nullptr, count, nullptr));
    check(H5Dread(handle_.id(), memory_type_, memory.id(), space.id(), H5P_DEFAULT, buffer.data()));
    for (const auto& [component, values] : columns) {
      T* const out = std::get<std::vector<T>>(*values).data() + begin + row;
      for (std::size_t i = 0; i < count[0]; ++i) out[i] = buffer[i * components_ + component];
    }
  }
}

void Dataset::append(const std::vector<std::pair<std::uint64_t, Values*>>& columns, Faults& faults) const {
  if (rows_ == 0 || columns.empty()) return;
  switch (type_) {
    case ColumnType::kFloat64: return append_as<double>(columns, faults);
    case ColumnType::kFloat32: return append_as<float>(columns, faults);
    case ColumnType::kInt64:
      append_as<std::int64_t>(columns, faults);
      if (H5Tequal(memory_type_, H5T_NATIVE_UINT64) > 0)
        for (const auto& [component, values] : columns)
          check_unsigned(name_, std::get<std::vector<std::int64_t>>(*values), faults);
      faults.raise_if_any();
      return;
    case ColumnType::kInt32: return append_as<std::int32_t>(columns, faults);
    case ColumnType::kUint16: return append_as<std::uint16_t>(columns, faults);
    case ColumnType::kUint8: return append_as<std::uint8_t>(columns, faults);
    case ColumnType::kText: return;
  }
}

}  // namespace orrery::arrays::hdf5
