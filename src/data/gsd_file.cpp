// SPDX-License-Identifier: Apache-2.0
#include "data/gsd_file.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

namespace orrery::data {
namespace {

constexpr std::size_t kHeaderBytes = 256;
constexpr std::size_t kEntryBytes = 32;
constexpr std::size_t kNameBytes = 64;
constexpr std::size_t kSchemaOffset = 112;

/// Sizes of the value types, by their codes; code 0 is not used.
constexpr std::array<std::uint64_t, 12> kTypeBytes = {0, 1, 2, 4, 8, 1, 2, 4, 8, 4, 8, 1};

/// Reads a little-endian number.
template <typename T>
T number(const std::string& bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// Reads one component of all rows, stored as T, as a vector of U.
template <typename T, typename U>
Values component_as(const ByteSource& bytes, const GsdChunk& chunk, std::uint32_t component) {
  constexpr std::size_t kBlockBytes = std::size_t{1} << 20;
  const std::size_t row_bytes = chunk.components * sizeof(T);
  const std::size_t block_rows = std::max<std::size_t>(1, kBlockBytes / row_bytes);
  const auto rows = static_cast<std::size_t>(chunk.rows);
  std::vector<U> values;
  values.reserve(rows);
  while (values.size() < rows) {
    const std::size_t begin = values.size(), count = std::min(block_rows, rows - begin);
    const std::string block = bytes.text(chunk.offset + begin * row_bytes, count * row_bytes);
    for (std::size_t i = 0; i < count; ++i)
      values.push_back(static_cast<U>(number<T>(block, i * row_bytes + component * sizeof(T))));
  }
  return values;
}

}  // namespace

std::uint64_t GsdChunk::bytes() const { return rows * components * kTypeBytes[type]; }

GsdFile::GsdFile(Bytes bytes) : bytes_(std::move(bytes)), faults_(bytes_->file()) {
  const std::string header = bytes_->text(0, kHeaderBytes);
  if (header.size() < kHeaderBytes) faults_.fail(0, "truncated: the header is incomplete");
  const auto index = number<std::uint64_t>(header, 8), entries = number<std::uint64_t>(header, 16);
  const auto names = number<std::uint64_t>(header, 24), name_blocks = number<std::uint64_t>(header, 32);
  const unsigned major_version = number<std::uint32_t>(header, 44) >> 16;
  if (major_version != 1 && major_version != 2)
    faults_.fail(0, "GSD version " + std::to_string(major_version) + " is not supported", "versions 1 and 2 are");
  schema_ = header.substr(kSchemaOffset, kNameBytes).c_str();
  const std::uint64_t size = bytes_->size();
  if (names > size || name_blocks > (size - names) / kNameBytes)
    faults_.fail(0, "truncated: the list of names is not in the file");
  if (index > size || entries > (size - index) / kEntryBytes)
    faults_.fail(0, "truncated: the index is not in the file");
  read_names(names, name_blocks * kNameBytes, major_version == 1);
  read_index(index, entries);
}

void GsdFile::read_names(std::uint64_t offset, std::uint64_t size, bool has_fixed_length) {
  const std::string text = bytes_->text(offset, static_cast<std::size_t>(size));
  for (std::size_t at = 0; at < text.size() && text[at] != '\0';) {
    const std::size_t end = std::min(text.find('\0', at), text.size());
    if (ids_.size() > std::numeric_limits<std::uint16_t>::max()) faults_.fail(0, "too many names");
    ids_.emplace(text.substr(at, end - at), static_cast<std::uint16_t>(ids_.size()));
    at = has_fixed_length ? at + kNameBytes : end + 1;
  }
}

void GsdFile::read_index(std::uint64_t offset, std::uint64_t count) {
  const std::string text = bytes_->text(offset, static_cast<std::size_t>(count * kEntryBytes));
  for (std::size_t at = 0; at < text.size(); at += kEntryBytes) {
    GsdChunk chunk;
    chunk.frame = number<std::uint64_t>(text, at);
    chunk.rows = number<std::uint64_t>(text, at + 8);
    chunk.offset = number<std::uint64_t>(text, at + 16);
    chunk.components = number<std::uint32_t>(text, at + 24);
    chunk.name = number<std::uint16_t>(text, at + 28);
    chunk.type = number<std::uint8_t>(text, at + 30);
    if (chunk.offset == 0) break;  // the rest of the index is unused
    const std::string entry = "entry " + std::to_string(at / kEntryBytes + 1) + " of the index ";
    if (chunk.type == 0 || chunk.type >= kTypeBytes.size())
      faults_.fail(0, entry + "has the unknown value type " + std::to_string(chunk.type));
    if (chunk.components == 0) faults_.fail(0, entry + "has no components");
    if (chunk.name >= ids_.size()) faults_.fail(0, entry + "has no name");
    if (!chunks_.empty() && chunk.frame < chunks_.back().frame) faults_.fail(0, entry + "is out of order");
    if (chunk.frame >= static_cast<std::uint64_t>(std::numeric_limits<int>::max()))
      faults_.fail(0, entry + "has the frame " + std::to_string(chunk.frame) + ", which is out of range");
    const std::uint64_t row_bytes = chunk.components * kTypeBytes[chunk.type];
    if (chunk.offset > bytes_->size() || chunk.rows > (bytes_->size() - chunk.offset) / row_bytes)
      faults_.fail(0, "truncated: " + entry + "refers to data beyond the end of the file");
    chunks_.push_back(chunk);
  }
}

const GsdChunk* GsdFile::find(std::uint64_t frame, const std::string& name) const {
  const auto id = ids_.find(name);
  if (id == ids_.end()) return nullptr;
  const auto less = [](const GsdChunk& chunk, std::uint64_t f) { return chunk.frame < f; };
  for (auto it = std::lower_bound(chunks_.begin(), chunks_.end(), frame, less);
       it != chunks_.end() && it->frame == frame; ++it)
    if (it->name == id->second) return &*it;
  return nullptr;
}

ColumnType GsdFile::column_type(const GsdChunk& chunk) {
  constexpr std::array<ColumnType, 12> kTypes = {ColumnType::kUint8,   ColumnType::kUint8,   ColumnType::kUint16,
                                                 ColumnType::kInt64,   ColumnType::kInt64,   ColumnType::kInt32,
                                                 ColumnType::kInt32,   ColumnType::kInt32,   ColumnType::kInt64,
                                                 ColumnType::kFloat32, ColumnType::kFloat64, ColumnType::kUint8};
  return kTypes[chunk.type];
}

Values GsdFile::component(const GsdChunk& chunk, std::uint32_t component) const {
  switch (chunk.type) {
    case 2: return component_as<std::uint16_t, std::uint16_t>(*bytes_, chunk, component);
    case 3: return component_as<std::uint32_t, std::int64_t>(*bytes_, chunk, component);
    case 4: return component_as<std::uint64_t, std::int64_t>(*bytes_, chunk, component);
    case 5: return component_as<std::int8_t, std::int32_t>(*bytes_, chunk, component);
    case 6: return component_as<std::int16_t, std::int32_t>(*bytes_, chunk, component);
    case 7: return component_as<std::int32_t, std::int32_t>(*bytes_, chunk, component);
    case 8: return component_as<std::int64_t, std::int64_t>(*bytes_, chunk, component);
    case 9: return component_as<float, float>(*bytes_, chunk, component);
    case 10: return component_as<double, double>(*bytes_, chunk, component);
    default: return component_as<std::uint8_t, std::uint8_t>(*bytes_, chunk, component);
  }
}

std::string GsdFile::raw(const GsdChunk& chunk) const {
  return bytes_->text(chunk.offset, static_cast<std::size_t>(chunk.bytes()));
}

}  // namespace orrery::data
