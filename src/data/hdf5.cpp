// SPDX-License-Identifier: Apache-2.0
#include <hdf5.h>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "base/stop_point.h"
#include "base/text.h"
#include "data/frames.h"
#include "data/readers.h"
#include "data/records.h"

// Snapshots of simulations in the layout of Gadget, SWIFT and AREPO: groups /PartTypeN with one dataset per quantity,
// possibly distributed over several files.
namespace orrery::data {

namespace {

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
  hid_t memory = -1;  ///< predefined, not owned
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

/// Opens a file for reading, without locking it: simulations may run, and some network file systems have no locks.
///
/// Errors     base::Error(kBadData)
Handle open_file(const std::filesystem::path& file) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // the library would print its errors
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_file_locking(access.id(), false, true);
  Handle handle(H5Fopen(file.c_str(), H5F_ACC_RDONLY, access.id()), H5Fclose);
  if (!handle) Faults(file).fail(0, "damaged HDF5 file: " + last_error());
  return handle;
}

/// Opens a group; an empty handle if there is none.
Handle open_group(const Handle& parent, const std::string& name) {
  return {H5Gopen2(parent.id(), name.c_str(), H5P_DEFAULT), H5Gclose};
}

/// Names of the links in a group.
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

/// Returns the numbers of an attribute; empty if there is none, if it is not numeric, or for an empty handle.
std::vector<double> attribute(const Handle& object, const char* name) {
  constexpr hssize_t kMaxValues = 64;
  if (!object || H5Aexists(object.id(), name) <= 0) return {};
  const Handle handle(H5Aopen(object.id(), name, H5P_DEFAULT), H5Aclose);
  const Handle space(H5Aget_space(handle.id()), H5Sclose);
  const hssize_t count = H5Sget_simple_extent_npoints(space.id());
  if (count <= 0 || count > kMaxValues) return {};
  std::vector<double> values(static_cast<std::size_t>(count));
  if (H5Aread(handle.id(), H5T_NATIVE_DOUBLE, values.data()) < 0) return {};
  return values;
}

/// A dataset of numbers with rows of one or more components.
class Dataset {
 public:
  /// Opens a numeric dataset with one or two dimensions; empty if the group has none of this name.
  Dataset(const Handle& group, const std::string& name) : name_(name) {
    Handle handle(H5Dopen2(group.id(), name.c_str(), H5P_DEFAULT), H5Dclose);
    if (!handle) return;
    const Handle space(H5Dget_space(handle.id()), H5Sclose), stored(H5Dget_type(handle.id()), H5Tclose);
    const int dimensions = H5Sget_simple_extent_ndims(space.id());
    if (dimensions != 1 && dimensions != 2) return;
    hsize_t extent[2] = {0, 1};
    H5Sget_simple_extent_dims(space.id(), extent, nullptr);
    const Types types = types_of(stored);
    if (types.memory < 0) return;
    rows_ = extent[0];
    components_ = extent[1];
    value_bytes_ = H5Tget_size(stored.id());
    types_ = types;
    handle_ = std::move(handle);
  }

  explicit operator bool() const { return static_cast<bool>(handle_); }
  std::uint64_t rows() const { return rows_; }
  std::uint64_t components() const { return components_; }
  /// The column type that stores the values without loss. For uint64 it is int64, with the same bits.
  ColumnType type() const { return types_.column; }

  /// Checks that the rows are backed by data before memory is allocated for them.
  ///
  /// `limit`    maximum size after decompression, bytes
  /// Errors     base::Error(kBadData), thrown through `faults`
  void require_data(std::uint64_t file_size, std::uint64_t limit, Faults& faults) const {
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

  /// Appends some components of all rows to columns of the dataset's type.
  ///
  /// `may_wrap`  unsigned numbers above the largest int64 become negative; otherwise, they are errors
  /// Errors     base::Error(kBadData), thrown through `faults`: damaged data
  /// Cost       one pass over the dataset, however many components are read
  void append(const std::vector<std::pair<std::uint64_t, Values*>>& columns, bool may_wrap, Faults& faults) const {
    if (rows_ == 0 || columns.empty()) return;
    std::visit(
        [&](const auto& first) {
          using Array = std::decay_t<decltype(first)>;
          if constexpr (requires { first.data(); }) append_as<typename Array::value_type>(columns, faults);
        },
        *columns.front().second);
    if (!may_wrap && H5Tequal(types_.memory, H5T_NATIVE_UINT64) > 0)
      for (const auto& [component, values] : columns)
        check_unsigned(name_, std::get<std::vector<std::int64_t>>(*values), faults);
    faults.raise_if_any();
  }

 private:
  template <typename T>
  void append_as(const std::vector<std::pair<std::uint64_t, Values*>>& columns, Faults& faults) const {
    const auto check = [&](herr_t status) {
      if (status < 0) faults.fail(0, fmt::format("cannot read `{}`: {}", name_, last_error()));
    };
    const std::size_t begin = std::get<std::vector<T>>(*columns.front().second).size();
    for (const auto& [component, values] : columns)
      std::get<std::vector<T>>(*values).resize(begin + static_cast<std::size_t>(rows_));
    if (components_ == 1) {
      for (const auto& [component, values] : columns) {
        T* const out = std::get<std::vector<T>>(*values).data() + begin;
        check(H5Dread(handle_.id(), types_.memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, out));
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
      check(H5Dread(handle_.id(), types_.memory, memory.id(), space.id(), H5P_DEFAULT, buffer.data()));
      for (const auto& [component, values] : columns) {
        T* const out = std::get<std::vector<T>>(*values).data() + begin + row;
        for (std::size_t i = 0; i < count[0]; ++i) out[i] = buffer[i * components_ + component];
      }
    }
  }

  /// Number of rows to read at a time: whole chunks, so that each is decompressed only once.
  std::uint64_t block_rows() const {
    constexpr std::uint64_t kBlockBytes = std::uint64_t{8} << 20;
    const std::uint64_t wanted = std::max<std::uint64_t>(1, kBlockBytes / (components_ * sizeof(double)));
    const Handle creation(H5Dget_create_plist(handle_.id()), H5Pclose);
    hsize_t chunk[2] = {1, 1};
    if (H5Pget_layout(creation.id()) != H5D_CHUNKED || H5Pget_chunk(creation.id(), 2, chunk) < 0 || chunk[0] == 0)
      return std::min(rows_, wanted);
    return std::min<std::uint64_t>(rows_, std::max<std::uint64_t>(1, wanted / chunk[0]) * chunk[0]);
  }

  std::string name_;
  Handle handle_;
  std::uint64_t rows_ = 0, components_ = 1;
  std::size_t value_bytes_ = 0;
  Types types_;
};

constexpr const char* kPositions = "Coordinates";
constexpr const char* kIds = "ParticleIDs";
/// Upper bound of particle type numbers. Simulation codes use up to 7.
constexpr std::size_t kMaxTypes = 16;
/// Maximum number of components of a quantity that are read as columns.
constexpr std::uint64_t kMaxComponents = 64;

std::string group_name(std::size_t type) { return "PartType" + std::to_string(type); }

/// One file of a snapshot.
struct Part {
  std::filesystem::path file;
  std::array<std::uint64_t, kMaxTypes> rows{};  ///< by type
  std::array<bool, kMaxTypes> has_type{};
};

/// A dataset of the chosen type.
struct Source {
  std::string dataset;
  ColumnType type = ColumnType::kFloat64;
  std::vector<std::string> columns;  ///< of its components
};

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& text, const std::string& remedy = {}) {
  Faults(file).fail(0, text, remedy);
}

std::optional<Box> box_of(const Handle& header) {
  std::vector<double> size = attribute(header, "BoxSize");
  if (size.size() == 1) size.resize(3, size[0]);
  const auto is_length = [](double value) { return std::isfinite(value) && value > 0; };
  if (size.size() != 3 || !std::all_of(size.begin(), size.end(), is_length)) return std::nullopt;
  Box box;
  box.edges = {Vec3d{size[0], 0, 0}, Vec3d{0, size[1], 0}, Vec3d{0, 0, size[2]}};
  return box;
}

class SnapshotReader final : public SingleFrame {
 public:
  SnapshotReader(const Bytes& bytes, const OpenOptions& options)
      : SingleFrame(bytes), decompressed_limit_(options.decompressed_limit) {
    const std::filesystem::path& file = bytes->file();
    if (bytes->is_in_memory())
      fail(file, "a compressed HDF5 file cannot be read", "decompress it first, e.g. with `gunzip`");
    const Handle root = open_file(file);
    const Handle header = open_group(root, "Header");
    const std::vector<double> count = attribute(header, "NumFilesPerSnapshot");
    constexpr double kMaxParts = 100'000;
    if (!count.empty() && count[0] > 1)
      find_parts(file, static_cast<std::uint64_t>(std::min(count[0], kMaxParts)));
    else
      parts_.push_back({file, {}, {}});
    for (Part& part : parts_) count_rows(part);
    choose_type(options.component, header);
    info_.has_components = true;
    info_.box = box_of(header);
    list_columns();
  }

  Table read(int, const std::vector<std::string>& columns) override {
    Table table = empty_table(columns);
    for (const Part& part : parts_) {
      const std::uint64_t rows = part.rows[type_];
      if (rows == 0) continue;
      Faults faults(part.file);
      const std::uint64_t file_size = std::filesystem::file_size(part.file);
      const Handle root = open_file(part.file), group = open_group(root, group_name(type_));
      for (const Source& source : sources_) {
        std::vector<std::pair<std::uint64_t, Values*>> out;
        for (std::size_t i = 0; i < source.columns.size(); ++i)
          if (Column* const column = table.find(source.columns[i])) out.emplace_back(i, &column->values);
        if (out.empty()) continue;
        const Dataset dataset(group, source.dataset);
        if (!dataset || dataset.rows() != rows || dataset.components() != source.columns.size() ||
            dataset.type() != source.type)
          faults.fail(0, fmt::format("{}/{} is missing or differs from that of the other files", group_name(type_),
                                     source.dataset));
        dataset.require_data(file_size, decompressed_limit_, faults);
        // AREPO and others set the highest bit of ids to mark particles. Ids only identify and order.
        dataset.append(out, source.dataset == kIds, faults);
      }
    }
    return table;
  }

 private:
  /// Finds the other files of a snapshot, which are numbered: snap.0.hdf5, snap.1.hdf5 ...
  void find_parts(const std::filesystem::path& file, std::uint64_t count) {
    const std::string extension = file.extension().string();
    const std::string stem = file.stem().string();
    const std::size_t dot = stem.rfind('.');
    const bool is_numbered = dot != std::string::npos && dot + 1 < stem.size() &&
                             std::all_of(stem.begin() + static_cast<std::ptrdiff_t>(dot) + 1, stem.end(),
                                         [](unsigned char c) { return std::isdigit(c) != 0; });
    if (!is_numbered)
      fail(file, fmt::format("the snapshot has {} files, but this file's name has no number", count),
           fmt::format("name them NAME.0{}, NAME.1{} and so on", extension, extension));
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::filesystem::path part =
          file.parent_path() / fmt::format("{}{}{}", stem.substr(0, dot + 1), i, extension);
      std::error_code ignored;
      if (!std::filesystem::exists(part, ignored))
        fail(file, fmt::format("the snapshot has {} files, but {} does not exist", count, part.string()),
             "put all of them into one folder");
      parts_.push_back({part, {}, {}});
    }
  }

  void count_rows(Part& part) const {
    const Handle root = open_file(part.file);
    for (std::size_t type = 0; type < kMaxTypes; ++type) {
      const Handle group = open_group(root, group_name(type));
      if (!group) continue;
      const Dataset positions(group, kPositions);
      if (!positions) continue;
      if (positions.components() != 3)
        fail(part.file,
             fmt::format("{}/{} has {} components instead of 3", group_name(type), kPositions, positions.components()));
      part.has_type[type] = true;
      part.rows[type] = positions.rows();
    }
  }

  void choose_type(std::optional<int> wanted, const Handle& header) {
    std::vector<std::size_t> present, filled;
    std::string list;
    for (std::size_t type = 0; type < kMaxTypes; ++type) {
      if (std::none_of(parts_.begin(), parts_.end(), [&](const Part& part) { return part.has_type[type]; })) continue;
      present.push_back(type);
      if (rows_of(type) > 0) filled.push_back(type);
      list += fmt::format("{}{} ({} particles)", list.empty() ? "" : ", ", type, rows_of(type));
    }
    if (present.empty())
      fail(bytes_->file(), "no group /PartTypeN with a dataset `Coordinates`",
           "of HDF5, only snapshots in the layout of Gadget, SWIFT and AREPO are supported; write other data as NPY or "
           "CSV, e.g. with h5py and numpy.save");
    if (wanted && std::find(present.begin(), present.end(), static_cast<std::size_t>(*wanted)) == present.end())
      fail(bytes_->file(), fmt::format("there is no component {}", *wanted), "the file has " + list);
    if (!wanted && filled.size() > 1)
      fail(bytes_->file(), "the snapshot has several components", "select one with --component: " + list);
    type_ = wanted ? static_cast<std::size_t>(*wanted) : filled.empty() ? present.front() : filled.front();

    // What the header declares, over all files. In older files, counts have 32 bits and an additional high word.
    info_.rows = rows_of(type_);
    const std::vector<double> low = attribute(header, "NumPart_Total");
    const std::vector<double> high = attribute(header, "NumPart_Total_HighWord");
    if (type_ >= low.size()) return;
    const double declared = low[type_] + (type_ < high.size() ? high[type_] * 4294967296.0 : 0);
    if (declared != static_cast<double>(info_.rows)) {
      std::string text = std::to_string(declared);
      fail(bytes_->file(), fmt::format("the header declares {} particles of {}, but there are {}",
                                       text.substr(0, text.find('.')), group_name(type_), info_.rows));
    }
  }

  void list_columns() {
    // Every file with particles of the type has the same datasets.
    const auto has_type = [this](const Part& part) { return part.has_type[type_]; };
    const auto has_rows = [this](const Part& part) { return part.rows[type_] > 0; };
    auto part = std::find_if(parts_.begin(), parts_.end(), has_rows);
    if (part == parts_.end()) part = std::find_if(parts_.begin(), parts_.end(), has_type);
    const Handle root = open_file(part->file), group = open_group(root, group_name(type_));
    std::vector<std::string> names = link_names(group);
    std::stable_partition(names.begin(), names.end(), [](const std::string& name) { return name == kPositions; });
    UniqueNames unique_names;
    for (const std::string& name : names) {
      const Dataset dataset(group, name);
      if (!dataset || dataset.rows() != part->rows[type_]) continue;
      const std::uint64_t components = dataset.components();
      if (components == 0 || components > kMaxComponents) continue;
      Source& source = sources_.emplace_back(Source{name, dataset.type(), {}});
      for (const std::string& column : component_names(name, static_cast<std::size_t>(components), info_.columns)) {
        source.columns.push_back(unique_names.add(column));
        info_.columns.push_back({source.columns.back(), source.type});
      }
      if (name == kPositions) std::copy(source.columns.begin(), source.columns.end(), info_.roles.position.begin());
      if (name == kIds && components == 1) info_.roles.id = source.columns[0];
    }
  }

  std::uint64_t rows_of(std::size_t type) const {
    std::uint64_t rows = 0;
    for (const Part& part : parts_) rows += part.rows[type];
    return rows;
  }

  std::uint64_t decompressed_limit_;
  std::vector<Part> parts_;
  std::size_t type_ = 0;
  std::vector<Source> sources_;
};

bool is_hdf5(const Signature& signature) {
  using namespace std::string_view_literals;
  // The signature may follow a user block.
  for (std::size_t at = 0; at < signature.head.size(); at = at == 0 ? 512 : 2 * at)
    if (std::string_view(signature.head).substr(at).starts_with("\x89HDF\r\n\x1a\n"sv)) return true;
  return false;
}

}  // namespace

const FormatReader kHdf5 = {"HDF5", is_hdf5, open_as<SnapshotReader>};

}  // namespace orrery::data
