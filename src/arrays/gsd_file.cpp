// SPDX-License-Identifier: Apache-2.0
#include "arrays/gsd_file.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

#include <fmt/core.h>

#include "data/byte_source.h"
#include "data/faults.h"

#include "data/records.h"

namespace orrery::arrays {

using namespace data;  // NOLINT(google-build-using-namespace)

namespace {

constexpr std::size_t kHeaderBytes = 256;
constexpr std::size_t kEntryBytes = 32;
constexpr std::size_t kNameBytes = 64;
constexpr std::size_t kSchemaOffset = 112;

/// The value types by their codes; code 0 is not used, code 11 is text.
constexpr std::array<NumberType, 12> kTypes = {NumberType::kUint8,   NumberType::kUint8,   NumberType::kUint16,
                                               NumberType::kUint32,  NumberType::kUint64,  NumberType::kInt8,
                                               NumberType::kInt16,   NumberType::kInt32,   NumberType::kInt64,
                                               NumberType::kFloat32, NumberType::kFloat64, NumberType::kUint8};

/// Reads a little-endian number.
template <typename T>
T number(const std::string& bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

}  // namespace

std::uint64_t GsdChunk::row_bytes() const { return components * size_of(type); }

GsdFile::GsdFile(std::shared_ptr<const ByteSource> bytes) : bytes_(std::move(bytes)), faults_(bytes_->file()) {
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
      faults_.fail(0, fmt::format("{}has the frame {}, which is out of range", entry, chunk.frame));
    if (chunk.offset > bytes_->size() || chunk.rows > (bytes_->size() - chunk.offset) / chunk.row_bytes())
      faults_.fail(0, fmt::format("truncated: {}refers to data beyond the end of the file", entry));
    chunks_.push_back(chunk);
  }
}

const std::filesystem::path& GsdFile::path() const { return bytes_->file(); }
std::uint64_t GsdFile::memory() const { return bytes_->memory(); }

const GsdChunk* GsdFile::find(std::uint64_t frame, const std::string& name) const {
  const auto id = ids_.find(name);
  if (id == ids_.end()) return nullptr;
  const auto less = [](const GsdChunk& chunk, std::uint64_t f) { return chunk.frame < f; };
  for (auto it = std::lower_bound(chunks_.begin(), chunks_.end(), frame, less);
       it != chunks_.end() && it->frame == frame; ++it)
    if (it->name == id->second) return &*it;
  return nullptr;
}

Values GsdFile::component(const GsdChunk& chunk, std::uint32_t component) const {
  Faults faults(path());
  const RecordField field{{}, chunk.type, component * size_of(chunk.type)};
  std::vector<Values> values = read_records(*bytes_, {chunk.offset, chunk.row_bytes(), chunk.rows}, {field}, faults);
  faults.raise_if_any();
  return std::move(values.front());
}

std::string GsdFile::raw(const GsdChunk& chunk) const {
  return bytes_->text(chunk.offset, static_cast<std::size_t>(chunk.rows * chunk.row_bytes()));
}

}  // namespace orrery::arrays
