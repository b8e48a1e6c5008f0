// SPDX-License-Identifier: Apache-2.0
// Snapshots of simulations in the layout of Gadget, SWIFT and AREPO: groups /PartTypeN with one dataset per quantity,
// possibly distributed over several files.
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include <fmt/core.h>

#include "arrays/hdf5_dataset.h"
#include "arrays/readers.h"
#include "data/byte_source.h"

#include "data/customary.h"
#include "data/faults.h"
#include "data/number_type.h"

namespace orrery::arrays {

using namespace data;  // NOLINT(google-build-using-namespace)

namespace {

constexpr const char* kPositions = "Coordinates";
constexpr const char* kIds = "ParticleIDs";
/// Upper bound of particle type numbers. Simulation codes use up to 7.
constexpr int kMaxTypes = 16;
/// Maximum number of components of a quantity that are read as columns.
constexpr std::uint64_t kMaxComponents = 64;

std::string group_name(int type) { return "PartType" + std::to_string(type); }

/// One file of a snapshot.
struct Part {
  std::filesystem::path file;
  std::array<std::uint64_t, kMaxTypes> rows{};  ///< by type
  std::array<bool, kMaxTypes> has_type{};
};

/// One column.
struct SourceColumn {
  ColumnInfo info;
  std::string dataset;
  std::uint64_t component = 0, components = 1;
};

class SnapshotReader final : public DataFile {
 public:
  SnapshotReader(const std::filesystem::path& file, const OpenOptions& options);

  Format format() const override { return Format::kHdf5; }
  int frame_count() override { return 1; }
  FrameInfo describe(int) override { return info_; }
  Table read(int frame, const std::vector<std::string>& columns) override;

 private:
  void find_parts(const std::filesystem::path& file, std::uint64_t count);
  void count_rows(Part& part) const;
  void choose_type(std::optional<int> wanted, const hdf5::Handle& header);
  void list_columns();
  std::uint64_t rows_of(int type) const;

  std::filesystem::path file_;
  std::uint64_t decompressed_limit_;
  std::vector<Part> parts_;
  int type_ = 0;
  std::vector<SourceColumn> sources_;
  FrameInfo info_;
};

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& text, const std::string& remedy = {}) {
  Faults(file).fail(0, text, remedy);
}

std::optional<Box> box_of(const hdf5::Handle& header) {
  std::vector<double> size = hdf5::attribute(header, "BoxSize");
  if (size.size() == 1) size.resize(3, size[0]);
  const auto is_length = [](double value) { return std::isfinite(value) && value > 0; };
  if (size.size() != 3 || !std::all_of(size.begin(), size.end(), is_length)) return std::nullopt;
  Box box;
  box.edges = {Vec3d{size[0], 0, 0}, Vec3d{0, size[1], 0}, Vec3d{0, 0, size[2]}};
  return box;
}

SnapshotReader::SnapshotReader(const std::filesystem::path& file, const OpenOptions& options)
    : file_(file), decompressed_limit_(options.decompressed_limit) {
  const hdf5::Handle root = hdf5::open_file(file);
  const hdf5::Handle header = hdf5::open_group(root, "Header");
  const std::vector<double> count = header ? hdf5::attribute(header, "NumFilesPerSnapshot") : std::vector<double>{};
  constexpr double kMaxParts = 100'000;
  if (!count.empty() && count[0] > 1)
    find_parts(file, static_cast<std::uint64_t>(std::min(count[0], kMaxParts)));
  else
    parts_.push_back({file, {}, {}});
  for (Part& part : parts_) count_rows(part);
  choose_type(options.component, header);
  if (header) info_.box = box_of(header);
  list_columns();
}

/// Finds the other files of a snapshot, which are numbered: snap.0.hdf5, snap.1.hdf5 ...
void SnapshotReader::find_parts(const std::filesystem::path& file, std::uint64_t count) {
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

void SnapshotReader::count_rows(Part& part) const {
  const hdf5::Handle root = hdf5::open_file(part.file);
  for (std::size_t type = 0; type < kMaxTypes; ++type) {
    const hdf5::Handle group = hdf5::open_group(root, group_name(static_cast<int>(type)));
    if (!group) continue;
    const hdf5::Dataset positions(group, kPositions);
    if (!positions) continue;
    if (positions.components() != 3)
      fail(part.file, fmt::format("{}/{} has {} components instead of 3", group_name(static_cast<int>(type)),
                                  kPositions, positions.components()));
    part.has_type[type] = true;
    part.rows[type] = positions.rows();
  }
}

std::uint64_t SnapshotReader::rows_of(int type) const {
  std::uint64_t rows = 0;
  for (const Part& part : parts_) rows += part.rows[static_cast<std::size_t>(type)];
  return rows;
}

void SnapshotReader::choose_type(std::optional<int> wanted, const hdf5::Handle& header) {
  std::vector<int> present, filled;
  std::string list;
  for (int type = 0; type < kMaxTypes; ++type) {
    if (std::none_of(parts_.begin(), parts_.end(),
                     [&](const Part& part) { return part.has_type[static_cast<std::size_t>(type)]; }))
      continue;
    present.push_back(type);
    if (rows_of(type) > 0) filled.push_back(type);
    list += fmt::format("{}{} ({} particles)", list.empty() ? "" : ", ", type, rows_of(type));
  }
  if (present.empty())
    fail(file_, "no group /PartTypeN with a dataset `Coordinates`",
         "of HDF5, only snapshots in the layout of Gadget, SWIFT and AREPO are supported; write other data as NPY or "
         "CSV, e.g. with h5py and numpy.save");
  if (wanted && std::find(present.begin(), present.end(), *wanted) == present.end())
    fail(file_, fmt::format("there is no component {}", *wanted), "the file has " + list);
  if (!wanted && filled.size() > 1)
    fail(file_, "the snapshot has several components", "select one with --component: " + list);
  type_ = wanted ? *wanted : filled.empty() ? present.front() : filled.front();

  // What the header declares, over all files. In older files, counts have 32 bits and an additional high word.
  info_.rows = rows_of(type_);
  const auto at = static_cast<std::size_t>(type_);
  const std::vector<double> low = header ? hdf5::attribute(header, "NumPart_Total") : std::vector<double>{};
  const std::vector<double> high = header ? hdf5::attribute(header, "NumPart_Total_HighWord") : std::vector<double>{};
  if (at >= low.size()) return;
  const double declared = low[at] + (at < high.size() ? high[at] * 4294967296.0 : 0);
  if (declared != static_cast<double>(info_.rows)) {
    std::string text = std::to_string(declared);
    fail(file_, fmt::format("the header declares {} particles of {}, but there are {}", text.substr(0, text.find('.')),
                            group_name(type_), info_.rows));
  }
}

void SnapshotReader::list_columns() {
  // Every file with particles of the type has the same datasets.
  const auto has_type = [this](const Part& part) { return part.has_type[static_cast<std::size_t>(type_)]; };
  const auto has_rows = [this](const Part& part) { return part.rows[static_cast<std::size_t>(type_)] > 0; };
  auto part = std::find_if(parts_.begin(), parts_.end(), has_rows);
  if (part == parts_.end()) part = std::find_if(parts_.begin(), parts_.end(), has_type);
  const hdf5::Handle root = hdf5::open_file(part->file), group = hdf5::open_group(root, group_name(type_));
  std::vector<std::string> names = hdf5::link_names(group);
  std::stable_partition(names.begin(), names.end(), [](const std::string& name) { return name == kPositions; });
  for (const std::string& name : names) {
    const hdf5::Dataset dataset(group, name);
    if (!dataset || dataset.rows() != part->rows[static_cast<std::size_t>(type_)]) continue;
    const std::uint64_t components = dataset.components();
    if (components == 0 || components > kMaxComponents) continue;
    const std::vector<std::string> columns = component_names(name, static_cast<std::size_t>(components), info_.columns);
    for (std::uint64_t i = 0; i < components; ++i) {
      info_.columns.push_back({columns[i], dataset.type()});
      sources_.push_back({info_.columns.back(), name, i, components});
    }
    if (name == kPositions) std::copy(columns.begin(), columns.end(), info_.roles.position.begin());
    if (name == kIds && components == 1) info_.roles.id = columns[0];
  }
}

Table SnapshotReader::read(int, const std::vector<std::string>& columns) {
  Table table;
  table.rows = static_cast<std::size_t>(info_.rows);
  std::vector<const SourceColumn*> wanted;
  for (const std::string& name : columns)
    for (const SourceColumn& source : sources_)
      if (source.info.name == name) {
        wanted.push_back(&source);
        table.columns.push_back({name, empty_values(source.info.type)});
      }
  for (const Part& part : parts_) {
    const std::uint64_t rows = part.rows[static_cast<std::size_t>(type_)];
    if (rows == 0) continue;
    Faults faults(part.file);
    const std::uint64_t file_size = std::filesystem::file_size(part.file);
    const hdf5::Handle root = hdf5::open_file(part.file), group = hdf5::open_group(root, group_name(type_));
    std::vector<bool> is_done(wanted.size());
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      if (is_done[i]) continue;
      const SourceColumn& source = *wanted[i];
      const hdf5::Dataset dataset(group, source.dataset);
      if (!dataset || dataset.rows() != rows || dataset.components() != source.components ||
          dataset.type() != source.info.type)
        faults.fail(0, fmt::format("{}/{} is missing or differs from that of the other files", group_name(type_),
                                   source.dataset));
      dataset.require_data(file_size, decompressed_limit_, faults);
      // All components of the dataset at once.
      std::vector<std::pair<std::uint64_t, Values*>> out;
      for (std::size_t j = i; j < wanted.size(); ++j) {
        if (wanted[j]->dataset != source.dataset) continue;
        out.emplace_back(wanted[j]->component, &table.columns[j].values);
        is_done[j] = true;
      }
      dataset.append(out, faults);
    }
  }
  return table;
}

}  // namespace

bool is_hdf5(const Signature& signature) {
  using namespace std::string_view_literals;
  // The signature may follow a user block.
  for (std::size_t at = 0; at < signature.head.size(); at = at == 0 ? 512 : 2 * at)
    if (std::string_view(signature.head).substr(at).starts_with("\x89HDF\r\n\x1a\n"sv)) return true;
  return false;
}

std::unique_ptr<DataFile> open_hdf5(const Bytes& bytes, const OpenOptions& options) {
  if (bytes->is_compressed())
    fail(bytes->file(), "a compressed HDF5 file cannot be read", "decompress it first, e.g. with `gunzip`");
  return std::make_unique<SnapshotReader>(bytes->file(), options);
}

}  // namespace orrery::arrays
