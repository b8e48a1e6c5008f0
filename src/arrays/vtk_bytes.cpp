// SPDX-License-Identifier: Apache-2.0
#include "arrays/vtk_bytes.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <limits>
#include <new>
#include <span>
#include <type_traits>
#include <vector>

#include <fmt/core.h>

#include "base/text.h"
#include "data/byte_source.h"
#include "data/quoted_word.h"
#include "data/text_rows.h"

// Reference  vtk-formats
namespace orrery::arrays {

using namespace data;  // NOLINT(google-build-using-namespace)

namespace {

constexpr const char* kTruncated = "the data end too early";

/// Bytes that are read from the front.
class Stream {
 public:
  virtual ~Stream() = default;
  /// Appends exactly `count` bytes; false if there are fewer.
  virtual bool take(std::uint64_t count, std::vector<char>& out) = 0;
};

class RawStream final : public Stream {
 public:
  RawStream(const ByteSource& source, std::uint64_t at) : source_(source), at_(std::min(at, source.size())) {}

  bool take(std::uint64_t count, std::vector<char>& out) override {
    if (count > source_.size() - at_) return false;
    const std::size_t begin = out.size();
    out.resize(begin + static_cast<std::size_t>(count));
    source_.read(at_, static_cast<std::size_t>(count), out.data() + begin);
    at_ += count;
    return true;
  }
  std::uint64_t at() const { return at_; }

 private:
  const ByteSource& source_;
  std::uint64_t at_;
};

/// Value of a base64 digit; -1: none.
constexpr int base64_value(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

/// Decodes base64 in groups of four digits. A group may be padded anywhere: VTK encodes header and data separately.
class Base64Stream final : public Stream {
 public:
  explicit Base64Stream(std::string_view text) : text_(text) {}

  bool take(std::uint64_t count, std::vector<char>& out) override {
    for (;;) {
      const auto some = static_cast<std::size_t>(std::min<std::uint64_t>(count, decoded_ - used_));
      out.insert(out.end(), group_ + used_, group_ + used_ + some);
      used_ += some;
      count -= some;
      if (count == 0) return true;
      if (!decode_group()) return false;
    }
  }

 private:
  bool decode_group() {
    std::uint32_t bits = 0;
    std::size_t digits = 0, padding = 0;
    while (digits + padding < 4) {
      while (at_ < text_.size() &&
             (text_[at_] == ' ' || text_[at_] == '\n' || text_[at_] == '\r' || text_[at_] == '\t'))
        ++at_;
      if (at_ == text_.size()) return false;
      const char c = text_[at_++];
      const int value = base64_value(c);
      if (c == '=' && digits >= 2) {
        ++padding;
        bits <<= 6;
      } else if (value >= 0 && padding == 0) {
        ++digits;
        bits = bits << 6 | static_cast<std::uint32_t>(value);
      } else {
        return false;
      }
    }
    for (std::size_t i = 0; i < 3; ++i) group_[i] = static_cast<char>(bits >> (16 - 8 * i));
    decoded_ = digits - 1;
    used_ = 0;
    return true;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  char group_[3] = {};
  std::size_t decoded_ = 0, used_ = 0;  ///< bytes of the group
};

/// Takes an integer of the array's header.
bool take_length(Stream& stream, const VtkStorage& storage, std::uint64_t& out) {
  std::vector<char> bytes;
  if (!stream.take(storage.has_long_headers ? 8 : 4, bytes)) return false;
  out = storage.has_long_headers ? load<std::uint64_t>(bytes.data(), storage.is_big_endian)
                                 : load<std::uint32_t>(bytes.data(), storage.is_big_endian);
  return true;
}

/// Appends a zlib stream of `bytes` decompressed bytes; false if it is damaged.
bool append_inflated(const std::vector<char>& compressed, std::uint64_t bytes, ByteBlocks& out) {
  if (compressed.size() > std::numeric_limits<uInt>::max()) return false;
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) throw std::bad_alloc();
  stream.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(compressed.data()));
  stream.avail_in = static_cast<uInt>(compressed.size());
  int status = Z_OK;
  for (std::uint64_t left = bytes; status == Z_OK;) {
    // One byte more than there should be shows that there are too many.
    const std::span<char> room = out.room(left + 1);
    stream.next_out = reinterpret_cast<Bytef*>(room.data());
    stream.avail_out = static_cast<uInt>(room.size());
    status = inflate(&stream, Z_NO_FLUSH);
    const std::size_t got = room.size() - stream.avail_out;
    if (got > left) break;
    out.append(got);
    left -= got;
    if (status == Z_STREAM_END && left > 0) status = Z_DATA_ERROR;
  }
  inflateEnd(&stream);
  return status == Z_STREAM_END;
}

/// Decompresses an array: number of blocks, size of a block, size of the last one if it is smaller, compressed sizes,
/// blocks.
std::string decompress(Stream& stream, const VtkStorage& storage, ByteBlocks& out) {
  /// Maximum expansion of a zlib stream.
  constexpr std::uint64_t kMaxExpansion = 1040;
  constexpr const char* kBadHeader = "the header of the compressed data is wrong";
  std::uint64_t blocks = 0, block_bytes = 0, last_bytes = 0;
  if (!take_length(stream, storage, blocks) || !take_length(stream, storage, block_bytes) ||
      !take_length(stream, storage, last_bytes))
    return kTruncated;
  if (last_bytes == 0) last_bytes = block_bytes;
  if (last_bytes > block_bytes) return kBadHeader;
  std::vector<std::uint64_t> sizes;
  for (std::uint64_t i = 0; i < blocks; ++i) {
    sizes.emplace_back();
    if (!take_length(stream, storage, sizes.back())) return kTruncated;
  }
  std::vector<char> compressed;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const std::uint64_t bytes = i + 1 < sizes.size() ? block_bytes : last_bytes;
    compressed.clear();
    if (!stream.take(sizes[i], compressed)) return kTruncated;
    if (bytes > kMaxExpansion * (sizes[i] + 1)) return kBadHeader;
    if (bytes > storage.limit - std::min<std::uint64_t>(storage.limit, out.size()))
      return fmt::format("the array exceeds the limit of {} of decompressed data", base::bytes_text(storage.limit));
    if (!append_inflated(compressed, bytes, out)) return "the compressed data are damaged";
  }
  return {};
}

VtkBytes in_memory(const std::filesystem::path& file, ByteBlocks bytes, bool is_big_endian) {
  const std::uint64_t size = bytes.size();
  return {ByteSource::of_memory(file, std::move(bytes)), 0, size, is_big_endian};
}

template <class T>
bool append_number(std::string_view word, ByteBlocks& out) {
  T value{};
  if constexpr (std::is_floating_point_v<T>) {
    double number = 0;
    if (!parse_number(word, number)) return false;
    value = static_cast<T>(number);
  } else {
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) return false;
  }
  out.append(std::string_view(reinterpret_cast<const char*>(&value), sizeof(T)));
  return true;
}

}  // namespace

std::string find_vtk_raw(const std::shared_ptr<const ByteSource>& file, std::uint64_t offset, const VtkStorage& storage,
                         VtkBytes& out) {
  RawStream stream(*file, offset);
  if (storage.is_compressed) {
    ByteBlocks bytes;
    std::string fault = decompress(stream, storage, bytes);
    out = in_memory(file->file(), std::move(bytes), storage.is_big_endian);
    return fault;
  }
  std::uint64_t size = 0;
  if (!take_length(stream, storage, size) || size > file->size() - stream.at()) return kTruncated;
  out = {file, stream.at(), size, storage.is_big_endian};
  return {};
}

std::string decode_vtk_base64(const std::filesystem::path& file, std::string_view text, const VtkStorage& storage,
                              VtkBytes& out) {
  Base64Stream stream(text);
  ByteBlocks bytes;
  std::string fault;
  if (storage.is_compressed) {
    fault = decompress(stream, storage, bytes);
  } else {
    std::uint64_t size = 0;
    if (!take_length(stream, storage, size)) return kTruncated;
    constexpr std::uint64_t kStep = std::uint64_t{1} << 20;
    std::vector<char> some;
    for (; size > 0; size -= some.size()) {
      some.clear();
      if (!stream.take(std::min(size, kStep), some)) return kTruncated;
      bytes.append({some.data(), some.size()});
    }
  }
  out = in_memory(file, std::move(bytes), storage.is_big_endian);
  return fault;
}

std::string parse_vtk_ascii(const std::filesystem::path& file, std::string_view text, NumberType type, VtkBytes& out) {
  constexpr std::string_view kBlanks = " \t\r\n";
  ByteBlocks bytes;
  for (std::size_t at = text.find_first_not_of(kBlanks); at != std::string_view::npos;
       at = text.find_first_not_of(kBlanks, at)) {
    const std::size_t end = std::min(text.find_first_of(kBlanks, at), text.size());
    const std::string_view word = text.substr(at, end - at);
    const bool is_number = with_type(type, [&](auto number) { return append_number<decltype(number)>(word, bytes); });
    if (!is_number) return quoted_word(word) + " is not a number of its type";
    at = end;
  }
  out = in_memory(file, std::move(bytes), std::endian::native == std::endian::big);
  return {};
}

}  // namespace orrery::arrays
