// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <limits>
#include <string>
#include <unordered_map>
#include <vector>

#include <fmt/core.h>

#include "data/bonds.h"
#include "data/dictionary.h"
#include "data/readers.h"
#include "data/records.h"

// GSD files of HOOMD-blue: the schema `hoomd` on top of the file layer.
namespace orrery::data {

namespace {

/// A named array of a frame: `rows` times `components` values of one type, row by row.
struct GsdChunk {
  std::uint64_t frame = 0;
  std::uint64_t rows = 0;
  std::uint64_t offset = 0;
  std::uint32_t components = 0;
  std::uint16_t name = 0;  ///< index into the file's list of names
  NumberType type = NumberType::kUint8;

  std::uint64_t row_bytes() const { return components * size_of(type); }
};

constexpr std::size_t kHeaderBytes = 256;
constexpr std::size_t kEntryBytes = 32;
constexpr std::size_t kNameBytes = 64;
constexpr std::size_t kSchemaOffset = 112;

/// The value types by their codes; code 0 is not used, code 11 is text.
constexpr std::array<NumberType, 12> kTypes = {NumberType::kUint8,   NumberType::kUint8,   NumberType::kUint16,
                                               NumberType::kUint32,  NumberType::kUint64,  NumberType::kInt8,
                                               NumberType::kInt16,   NumberType::kInt32,   NumberType::kInt64,
                                               NumberType::kFloat32, NumberType::kFloat64, NumberType::kUint8};

template <typename T>
T number(const std::string& bytes, std::size_t at) {
  return load<T>(bytes.data() + at, false);
}

/// The file layer of GSD, versions 1 and 2: finds chunks by frame and name.
///
/// Reference  gsd-format
class GsdFile {
 public:
  /// Reads header, index and list of names.
  ///
  /// Errors     base::Error(kBadData): damaged header, index or list of names; chunks beyond the end of the file
  explicit GsdFile(Bytes bytes) : bytes_(std::move(bytes)), faults_(bytes_->file()) {
    const std::string header = bytes_->text(0, kHeaderBytes);
    if (header.size() < kHeaderBytes) faults_.fail(0, "truncated: the header is incomplete");
    const auto index = number<std::uint64_t>(header, 8), entries = number<std::uint64_t>(header, 16);
    const auto names = number<std::uint64_t>(header, 24), name_blocks = number<std::uint64_t>(header, 32);
    const unsigned major_version = number<std::uint32_t>(header, 44) >> 16;
    if (major_version != 1 && major_version != 2)
      faults_.fail(0, fmt::format("GSD version {} is not supported", major_version), "versions 1 and 2 are");
    schema_ = header.substr(kSchemaOffset, kNameBytes).c_str();
    const std::uint64_t size = bytes_->size();
    if (names > size || name_blocks > (size - names) / kNameBytes)
      faults_.fail(0, "truncated: the list of names is not in the file");
    if (index > size || entries > (size - index) / kEntryBytes)
      faults_.fail(0, "truncated: the index is not in the file");
    read_names(names, name_blocks * kNameBytes, major_version == 1);
    read_index(index, entries);
  }

  const std::filesystem::path& path() const { return bytes_->file(); }

  std::uint64_t memory() const { return bytes_->memory(); }

  const std::string& schema() const { return schema_; }
  std::uint64_t frame_count() const { return chunks_.empty() ? 0 : chunks_.back().frame + 1; }

  /// Whether a chunk of this name has rows, in any frame.
  bool has_rows(const std::string& name) const {
    const auto id = ids_.find(name);
    return id != ids_.end() && std::any_of(chunks_.begin(), chunks_.end(), [&](const GsdChunk& chunk) {
             return chunk.name == id->second && chunk.rows > 0;
           });
  }

  /// Returns the chunk of this name; null if the frame has none.
  const GsdChunk* find(std::uint64_t frame, const std::string& name) const {
    const auto id = ids_.find(name);
    if (id == ids_.end()) return nullptr;
    const auto less = [](const GsdChunk& chunk, std::uint64_t f) { return chunk.frame < f; };
    for (auto it = std::lower_bound(chunks_.begin(), chunks_.end(), frame, less);
         it != chunks_.end() && it->frame == frame; ++it)
      if (it->name == id->second) return &*it;
    return nullptr;
  }

  /// The same, else the chunk of frame 0, which applies to later frames.
  const GsdChunk* find_or_first(std::uint64_t frame, const std::string& name) const {
    const GsdChunk* const chunk = find(frame, name);
    return chunk != nullptr ? chunk : find(0, name);
  }

  /// Reads one component of all rows.
  Values component(const GsdChunk& chunk, std::uint32_t component) const {
    Faults faults(path());
    const RecordField field{{}, chunk.type, component * size_of(chunk.type)};
    std::vector<Column> read = read_records(*bytes_, {chunk.offset, chunk.row_bytes(), chunk.rows}, {field}, faults);
    faults.raise_if_any();
    return std::move(read.front().values);
  }

  /// Reads all bytes of a chunk.
  std::string raw(const GsdChunk& chunk) const {
    return bytes_->text(chunk.offset, static_cast<std::size_t>(chunk.rows * chunk.row_bytes()));
  }

 private:
  void read_names(std::uint64_t offset, std::uint64_t size, bool has_fixed_length) {
    const std::string text = bytes_->text(offset, static_cast<std::size_t>(size));
    for (std::size_t at = 0; at < text.size() && text[at] != '\0';) {
      const std::size_t end = std::min(text.find('\0', at), text.size());
      if (ids_.size() > std::numeric_limits<std::uint16_t>::max()) faults_.fail(0, "too many names");
      ids_.emplace(text.substr(at, end - at), static_cast<std::uint16_t>(ids_.size()));
      at = has_fixed_length ? at + kNameBytes : end + 1;
    }
  }

  void read_index(std::uint64_t offset, std::uint64_t count) {
    const std::string text = bytes_->text(offset, static_cast<std::size_t>(count * kEntryBytes));
    for (std::size_t at = 0; at < text.size(); at += kEntryBytes) {
      GsdChunk chunk;
      chunk.frame = number<std::uint64_t>(text, at);
      chunk.rows = number<std::uint64_t>(text, at + 8);
      chunk.offset = number<std::uint64_t>(text, at + 16);
      chunk.components = number<std::uint32_t>(text, at + 24);
      chunk.name = number<std::uint16_t>(text, at + 28);
      const unsigned type = number<std::uint8_t>(text, at + 30);
      if (chunk.offset == 0) break;  // the rest of the index is unused
      const std::string entry = fmt::format("entry {} of the index ", at / kEntryBytes + 1);
      if (type == 0 || type >= kTypes.size())
        faults_.fail(0, fmt::format("{}has the unknown value type {}", entry, type));
      chunk.type = kTypes[type];
      if (chunk.components == 0) faults_.fail(0, entry + "has no components");
      if (chunk.name >= ids_.size()) faults_.fail(0, entry + "has no name");
      if (!chunks_.empty() && chunk.frame < chunks_.back().frame) faults_.fail(0, entry + "is out of order");
      if (chunk.frame >= static_cast<std::uint64_t>(std::numeric_limits<int>::max()))
        faults_.fail(0, fmt::format("{}has the frame {}, which is out of range", entry, chunk.frame + 1));
      if (chunk.offset > bytes_->size() || chunk.rows > (bytes_->size() - chunk.offset) / chunk.row_bytes())
        faults_.fail(0, fmt::format("truncated: {}refers to data beyond the end of the file", entry));
      chunks_.push_back(chunk);
    }
  }

  Bytes bytes_;
  Faults faults_;
  std::string schema_;
  std::unordered_map<std::string, std::uint16_t> ids_;
  std::vector<GsdChunk> chunks_;  ///< ordered by frame
};

/// Columns from a chunk of the schema.
struct ChunkColumns {
  const char* chunk;
  std::uint32_t components;
  std::array<const char*, 3> columns;
};

/// Only the first two, and types, are listed when a file lacks them.
constexpr ChunkColumns kColumns[] = {
    {"particles/position", 3, {"x", "y", "z"}},
    {"particles/diameter", 1, {"diameter"}},
    {"particles/velocity", 3, {"velocity[1]", "velocity[2]", "velocity[3]"}},
    {"particles/image", 3, {"image[1]", "image[2]", "image[3]"}},
    {"particles/mass", 1, {"mass"}},
    {"particles/charge", 1, {"charge"}},
    {"particles/body", 1, {"body"}},
};
constexpr std::size_t kAlwaysListed = 2;
constexpr const char* kTypeId = "particles/typeid";
/// Default diameter of particles, as defined by the schema.
constexpr float kDefaultDiameter = 1;

class GsdReader final : public DataFile {
 public:
  explicit GsdReader(const Bytes& bytes) : file_(bytes) {
    if (file_.schema() != "hoomd")
      fail(fmt::format("the schema of this GSD file is `{}`", file_.schema()), "only the schema `hoomd` is supported");
    if (file_.frame_count() == 0) fail("the file has no frames");
  }

  int frame_count() override { return static_cast<int>(file_.frame_count()); }

  FrameInfo describe(int index) override {
    const auto frame = static_cast<std::uint64_t>(index);
    FrameInfo info;
    info.rows = rows_of(frame);
    for (std::size_t c = 0; c < std::size(kColumns); ++c) {
      const ChunkColumns& source = kColumns[c];
      if (c == kAlwaysListed) info.columns.push_back({"type", ColumnType::kText});
      const GsdChunk* const chunk = chunk_of(frame, source.chunk, source.components);
      if (chunk == nullptr && c >= kAlwaysListed) continue;
      for (std::uint32_t i = 0; i < source.components; ++i)
        info.columns.push_back({source.columns[i], chunk != nullptr ? column_type(chunk->type) : ColumnType::kFloat32});
      if (source.chunk == std::string("particles/image"))
        std::copy(source.columns.begin(), source.columns.end(), info.roles.image.begin());
    }
    info.roles.position = {"x", "y", "z"};
    info.roles.radius = "diameter";
    info.roles.radius_scale = 0.5;
    info.roles.type = "type";
    info.box = box_of(frame);
    const std::vector<double> step = setting(frame, "configuration/step", 1);
    info.step = step.empty() ? 0 : step[0];
    if (const GsdChunk* const bonds = bonds_of(frame)) info.bonds = bonds->rows;
    info.has_bonds = file_.has_rows("bonds/group");
    return info;
  }

  std::uint64_t memory() const override { return file_.memory(); }

  Table read(int index, const std::vector<std::string>& columns) override {
    const auto frame = static_cast<std::uint64_t>(index);
    Table table;
    table.rows = static_cast<std::size_t>(rows_of(frame));
    for (const std::string& name : columns) {
      if (name == "type") table.columns.push_back({name, types_of(frame, table.rows)});
      for (const ChunkColumns& source : kColumns)
        for (std::uint32_t i = 0; i < source.components; ++i) {
          if (name != source.columns[i]) continue;
          const GsdChunk* const chunk = chunk_of(frame, source.chunk, source.components);
          // Without a chunk, there are no particles, or they have the default diameter.
          table.columns.push_back({name, chunk != nullptr ? file_.component(*chunk, i)
                                                          : Values(std::vector<float>(table.rows, kDefaultDiameter))});
        }
    }
    return table;
  }

  std::vector<Bond> bonds(int index, std::vector<std::string>&) override {
    const auto frame = static_cast<std::uint64_t>(index);
    const GsdChunk* const chunk = bonds_of(frame);
    if (chunk == nullptr) return {};
    const std::uint64_t rows = rows_of(frame);
    const Column first{"a", file_.component(*chunk, 0)}, second{"b", file_.component(*chunk, 1)};
    Faults faults(file_.path());
    std::vector<Bond> out;
    out.reserve(first.size());
    for (std::size_t i = 0; i < first.size(); ++i) {
      const double ends[] = {first.number(i), second.number(i)};
      const auto is_missing = [&](double end) { return !(end >= 0 && end < static_cast<double>(rows)); };
      const double* const missing = std::find_if(std::begin(ends), std::end(ends), is_missing);
      if (missing != std::end(ends))
        faults.add_of_many(0, fmt::format("frame {}: bond {} has the particle {:.0f}; there are {}, counted from 0",
                                          frame + 1, i, *missing, rows));
      else if (ends[0] == ends[1])
        faults.add_of_many(0, fmt::format("frame {}: bond {} joins particle {:.0f} to itself", frame + 1, i, ends[0]));
      else
        out.push_back(ordered_bond(static_cast<std::uint64_t>(ends[0]), static_cast<std::uint64_t>(ends[1])));
    }
    finish_bonds(out, faults);
    return out;
  }

 private:
  [[noreturn]] void fail(const std::string& text, const std::string& remedy = {}) const {
    Faults(file_.path()).fail(0, text, remedy);
  }

  /// Returns a number of particles or bonds, 0 if there is none.
  std::uint64_t count_of(std::uint64_t frame, const char* name) {
    const std::vector<double> count = setting(frame, name, 1);
    constexpr double kMaxCount = 1e15;
    if (!count.empty() && !(count[0] >= 0 && count[0] < kMaxCount))
      fail(fmt::format("frame {}: `{}` is out of range", frame + 1, name));
    return count.empty() ? 0 : static_cast<std::uint64_t>(count[0]);
  }

  /// Returns the number of particles. Positions for all of them exist, so that memory can be allocated safely.
  std::uint64_t rows_of(std::uint64_t frame) {
    const std::uint64_t rows = count_of(frame, "particles/N");
    if (rows > 0) {
      const GsdChunk* const position = file_.find_or_first(frame, kColumns[0].chunk);
      if (position == nullptr || position->rows != rows)
        fail(fmt::format("frame {} has {} particles, but {} positions", frame + 1, rows,
                         position == nullptr ? 0 : position->rows));
    }
    return rows;
  }

  /// Returns the pairs of particles that are bonded; null if there are none.
  const GsdChunk* bonds_of(std::uint64_t frame) {
    const std::uint64_t count = count_of(frame, "bonds/N");
    if (count == 0) return nullptr;
    const char* const name = "bonds/group";
    const GsdChunk* const chunk = file_.find_or_first(frame, name);
    if (chunk == nullptr || chunk->rows != count || chunk->components != 2)
      fail(fmt::format("frame {}: `bonds/N` is {}, but `{}` has {} rows of {} values", frame + 1, count, name,
                       chunk == nullptr ? 0 : chunk->rows, chunk == nullptr ? 0 : chunk->components));
    return chunk;
  }

  /// Returns the values of a chunk that does not belong to particles; empty if neither the frame nor frame 0 has it.
  std::vector<double> setting(std::uint64_t frame, const char* name, std::size_t size) {
    const GsdChunk* const chunk = file_.find_or_first(frame, name);
    if (chunk == nullptr) return {};
    const std::uint64_t values = chunk->rows * chunk->components;
    if (values != size) fail(fmt::format("frame {}: `{}` has {} values instead of {}", frame + 1, name, values, size));
    std::vector<double> out;
    for (std::uint32_t i = 0; i < chunk->components; ++i) {
      const Column column{name, file_.component(*chunk, i)};
      for (std::size_t row = 0; row < column.size(); ++row) out.push_back(column.number(row));
    }
    return out;
  }

  /// Returns a chunk with one row per particle: the frame's, else frame 0's if it has as many particles; else null.
  const GsdChunk* chunk_of(std::uint64_t frame, const char* name, std::uint32_t components) {
    const std::uint64_t rows = rows_of(frame);
    const GsdChunk* chunk = file_.find(frame, name);
    if (chunk == nullptr && rows_of(0) == rows) chunk = file_.find(0, name);
    if (chunk != nullptr && (chunk->rows != rows || chunk->components != components))
      fail(fmt::format("frame {}: `{}` has {} rows of {} values instead of {} rows of {}", frame + 1, name, chunk->rows,
                       chunk->components, rows, components));
    return chunk;
  }

  /// Names of the types: rows of characters, padded by null characters.
  std::vector<std::string> type_names(std::uint64_t frame) {
    const GsdChunk* const chunk = file_.find_or_first(frame, "particles/types");
    if (chunk == nullptr) return {"A"};
    if (size_of(chunk->type) != 1) fail("`particles/types` is not text");
    const std::string text = file_.raw(*chunk);
    std::vector<std::string> names;
    for (std::size_t at = 0; at < text.size(); at += chunk->components)
      names.emplace_back(text.substr(at, chunk->components).c_str());
    return names;
  }

  std::optional<Box> box_of(std::uint64_t frame) {
    const std::vector<double> b = setting(frame, "configuration/box", 6);
    if (b.empty()) return std::nullopt;
    for (const double value : b)
      if (!std::isfinite(value)) fail(fmt::format("frame {}: the box has values that are not finite", frame + 1));
    const std::vector<double> dimensions = setting(frame, "configuration/dimensions", 1);
    const bool is_flat = !dimensions.empty() && dimensions[0] == 2;
    // Lengths x, y, z, then tilt factors xy, xz, yz. The box is centred at the origin.
    const double height = is_flat && b[2] == 0 ? 1 : b[2];
    Box box;
    box.edges = {Vec3d{b[0], 0, 0}, Vec3d{b[3] * b[1], b[1], 0}, Vec3d{b[4] * height, b[5] * height, height}};
    box.origin = -0.5 * (box.edges[0] + box.edges[1] + box.edges[2]);
    box.periodic = {true, true, !is_flat};
    return box;
  }

  Words types_of(std::uint64_t frame, std::uint64_t rows) {
    const std::vector<std::string> names = type_names(frame);
    const GsdChunk* chunk = chunk_of(frame, kTypeId, 1);
    Column ids{"type", std::vector<std::uint8_t>(chunk == nullptr ? static_cast<std::size_t>(rows) : 0)};
    if (chunk != nullptr) ids.values = file_.component(*chunk, 0);
    Dictionary words;  // two types may have one name
    std::vector<std::uint32_t> word_of, index;
    for (const std::string& name : names) word_of.push_back(words.index_of(name));
    index.reserve(ids.size());
    for (std::size_t row = 0; row < ids.size(); ++row) {
      const double id = ids.number(row);
      if (!(id >= 0 && id < static_cast<double>(names.size())))
        fail(fmt::format("frame {}: particle {} has a type without a name; there are {} types", frame + 1, row + 1,
                         names.size()));
      index.push_back(word_of[static_cast<std::size_t>(id)]);
    }
    return words_at(words.words(), index);
  }

  GsdFile file_;
};

bool is_gsd(const Signature& signature) { return signature.head.starts_with("\xdf\x65\xdf\x65\xdf\x65\xdf\x65"); }

}  // namespace

const FormatReader kGsd = {"GSD", is_gsd, open_as<GsdReader>};

}  // namespace orrery::data
