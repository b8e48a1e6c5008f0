// SPDX-License-Identifier: Apache-2.0
#include "data/byte_source.h"

#include <archive.h>
#include <archive_entry.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>

#include <fmt/core.h>

#include "base/error.h"
#include "base/input_file.h"
#include "base/read_progress.h"
#include "base/stop_point.h"
#include "base/text.h"
#include "data/faults.h"

namespace orrery::data {

namespace {

constexpr std::size_t kBlock = std::size_t{1} << 20;

std::string reason() { return std::strerror(errno); }

constexpr std::size_t kLongestSignature = 6;  // of compressed data
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// A plain file.
class PlainFile final : public ByteSource {
 public:
  PlainFile(const std::filesystem::path& file, int descriptor, std::uint64_t size)
      : ByteSource(file, size, false), descriptor_(descriptor) {}
  ~PlainFile() override { ::close(descriptor_); }
  PlainFile(const PlainFile&) = delete;
  PlainFile& operator=(const PlainFile&) = delete;

  void read(std::uint64_t offset, std::size_t count, char* out) const override {
    for (std::size_t done = 0; done < count;) {
      const ssize_t got = ::pread(descriptor_, out + done, count - done, static_cast<off_t>(begin() + offset + done));
      if (got < 0 && errno == EINTR) continue;
      if (got < 0)
        throw base::Error(base::ErrorKind::kIo, fmt::format("cannot read {}: {}", file().string(), reason()));
      if (got == 0) throw base::Error(base::ErrorKind::kIo, file().string() + " was truncated while it was being read");
      done += static_cast<std::size_t>(got);
    }
    if (progress_) *progress_ = static_cast<double>(offset + count) / static_cast<double>(size());
  }

 private:
  int descriptor_;
  const std::shared_ptr<base::ReadProgress> progress_ = base::ReadProgressScope::current();
};

class BytesInMemory final : public ByteSource {
 public:
  BytesInMemory(const std::filesystem::path& file, ByteBlocks bytes)
      : ByteSource(file, bytes.size(), true), bytes_(std::move(bytes)) {}

  void read(std::uint64_t offset, std::size_t count, char* out) const override {
    bytes_.read(begin() + offset, count, out);
  }

 private:
  ByteBlocks bytes_;
};

using Archive = std::unique_ptr<archive, decltype(&archive_read_free)>;

Archive new_archive() {
  Archive out(archive_read_new(), &archive_read_free);
  if (!out) throw std::bad_alloc();
  return out;
}

std::string error_of(const Archive& archive) {
  const char* const why = archive_error_string(archive.get());
  return why != nullptr ? why : "unknown error";
}

bool is_gzip(std::string_view head) { return head.starts_with("\x1f\x8b"); }

bool is_of_archive_library(std::string_view head) {
  using namespace std::string_view_literals;
  return head.starts_with("\x28\xb5\x2f\xfd"sv) || head.starts_with("BZh"sv) ||
         head.starts_with(
             "\xfd"
             "7zXZ\0"sv);
}

[[noreturn]] void fail_as_damaged(const std::filesystem::path& file, const std::string& why) {
  Faults(file).fail(0, "damaged compressed data: " + why,
                    "`gzip -t`, `zstd -t`, `bzip2 -t` or `xz -t` checks the file");
}

void check_limit(const std::filesystem::path& file, std::uint64_t size, std::uint64_t limit) {
  if (size > limit)
    Faults(file).fail(0, "decompresses to more than " + base::bytes_text(limit), "decompress the file first");
}

/// Room for the next bytes up to the limit, and one more, which shows that there are more. Grows only by what was
/// decompressed: a header may declare any size.
std::span<char> room_below(ByteBlocks& out, std::uint64_t limit) {
  return out.room(std::min<std::uint64_t>(limit - out.size(), kBlock) + 1);
}

/// Decompresses the members of a gzip file. By zlib's inflate(), since libarchive does not verify their checksums, and
/// gzread() ignores what follows a member, so that a damaged member would be lost.
class GzipFile {
 public:
  explicit GzipFile(const ByteSource& bytes) : bytes_(bytes) {
    constexpr int kGzip = 16;
    if (inflateInit2(&stream_, kGzip + MAX_WBITS) != Z_OK) throw std::bad_alloc();
  }
  GzipFile(const GzipFile&) = delete;
  GzipFile& operator=(const GzipFile&) = delete;
  ~GzipFile() { inflateEnd(&stream_); }

  ByteBlocks read(std::uint64_t limit) {
    ByteBlocks out;
    const base::StopPoint stop;
    for (bool ends = false; !ends;) {
      stop.check();
      const std::span<char> room = room_below(out, limit);
      stream_.next_out = reinterpret_cast<Bytef*>(room.data());
      stream_.avail_out = static_cast<uInt>(room.size());
      while (stream_.avail_out > 0 && !ends) ends = !step();
      out.append(room.size() - stream_.avail_out);
      check_limit(bytes_.file(), out.size(), limit);
    }
    return out;
  }

 private:
  /// Result     false at the end of the last member
  bool step() {
    if (stream_.avail_in == 0) fill();
    const int status = inflate(&stream_, Z_NO_FLUSH);
    if (status == Z_BUF_ERROR) fail_as_damaged(bytes_.file(), "the file is truncated");
    if (status != Z_OK && status != Z_STREAM_END)
      fail_as_damaged(bytes_.file(), stream_.msg != nullptr ? stream_.msg : "unknown error");
    if (status == Z_OK) return true;
    // Members follow each other; zeros may pad the last one.
    for (;; ++stream_.next_in, --stream_.avail_in) {
      if (stream_.avail_in == 0) fill();
      if (stream_.avail_in == 0) return false;
      if (*stream_.next_in != 0) break;
    }
    inflateReset(&stream_);
    return true;
  }

  void fill() {
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(buffer_.size(), bytes_.size() - offset_));
    bytes_.read(offset_, count, buffer_.data());
    offset_ += count;
    stream_.next_in = reinterpret_cast<Bytef*>(buffer_.data());
    stream_.avail_in = static_cast<uInt>(count);
  }

  const ByteSource& bytes_;
  std::uint64_t offset_ = 0;
  std::vector<char> buffer_ = std::vector<char>(kBlock);
  z_stream stream_{};
};

ByteBlocks decompressed(const std::filesystem::path& file, std::uint64_t limit) {
  const Archive in = new_archive();
  const auto check = [&](la_ssize_t status) {
    if (status < ARCHIVE_OK) fail_as_damaged(file, error_of(in));
    return status;
  };
  archive_read_support_filter_zstd(in.get());
  archive_read_support_filter_bzip2(in.get());
  archive_read_support_filter_xz(in.get());
  archive_read_support_format_raw(in.get());
  archive_read_support_format_empty(in.get());
  check(archive_read_open_filename(in.get(), file.c_str(), kBlock));
  archive_entry* entry = nullptr;
  if (check(archive_read_next_header(in.get(), &entry)) == ARCHIVE_EOF) return {};
  ByteBlocks out;
  const base::StopPoint stop;
  for (;;) {
    stop.check();
    const std::span<char> room = room_below(out, limit);
    const auto got = static_cast<std::size_t>(check(archive_read_data(in.get(), room.data(), room.size())));
    if (got == 0) return out;
    out.append(got);
    check_limit(file, out.size(), limit);
  }
}

}  // namespace

std::span<char> ByteBlocks::room(std::uint64_t most) {
  const auto used = static_cast<std::size_t>(size_ % kBlock);
  if (size_ == blocks_.size() * kBlock) blocks_.push_back(std::make_unique_for_overwrite<char[]>(kBlock));
  return {blocks_.back().get() + used, static_cast<std::size_t>(std::min<std::uint64_t>(kBlock - used, most))};
}

void ByteBlocks::append(std::string_view bytes) {
  while (!bytes.empty()) {
    const std::span<char> to = room(bytes.size());
    std::memcpy(to.data(), bytes.data(), to.size());
    append(to.size());
    bytes.remove_prefix(to.size());
  }
}

void ByteBlocks::read(std::uint64_t offset, std::size_t count, char* out) const {
  while (count > 0) {
    const auto block = static_cast<std::size_t>(offset / kBlock), at = static_cast<std::size_t>(offset % kBlock);
    const std::size_t some = std::min(count, kBlock - at);
    std::memcpy(out, blocks_[block].get() + at, some);
    out += some;
    offset += some;
    count -= some;
  }
}

std::shared_ptr<const ByteSource> ByteSource::open(const std::filesystem::path& file, std::uint64_t limit) {
  base::require_readable(file);
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat status {};
  if (descriptor < 0 || ::fstat(descriptor, &status) != 0) {
    const std::string why = reason();
    if (descriptor >= 0) ::close(descriptor);
    throw base::Error(base::ErrorKind::kMissingInput, fmt::format("cannot open {}: {}", file.string(), why));
  }
  std::shared_ptr<ByteSource> out =
      std::make_shared<PlainFile>(file, descriptor, static_cast<std::uint64_t>(status.st_size));
  const std::string head = out->text(0, kLongestSignature);
  if (is_gzip(head))
    out = std::make_shared<BytesInMemory>(file, GzipFile(*out).read(limit));
  else if (is_of_archive_library(head))
    out = std::make_shared<BytesInMemory>(file, decompressed(file, limit));
  if (out->text(0, kByteOrderMark.size()) == kByteOrderMark) {
    out->begin_ += kByteOrderMark.size();
    out->size_ -= kByteOrderMark.size();
  }
  return out;
}

std::shared_ptr<const ByteSource> ByteSource::of_memory(const std::filesystem::path& file, ByteBlocks bytes) {
  return std::make_shared<const BytesInMemory>(file, std::move(bytes));
}

std::shared_ptr<const ByteSource> ByteSource::of_memory(const std::filesystem::path& file, std::string_view bytes) {
  ByteBlocks blocks;
  blocks.append(bytes);
  return of_memory(file, std::move(blocks));
}

std::string ByteSource::text(std::uint64_t offset, std::size_t count) const {
  if (offset >= size_) return {};
  std::string out(static_cast<std::size_t>(std::min<std::uint64_t>(count, size_ - offset)), '\0');
  read(offset, out.size(), out.data());
  return out;
}

bool is_compressed(std::string_view head) { return is_gzip(head) || is_of_archive_library(head); }

/// Connects libarchive to a byte source.
struct ZipReader::State {
  explicit State(const ByteSource& source) : bytes(source) {}

  /// Raises libarchive's error, or the exception that stopped a callback.
  la_ssize_t check(la_ssize_t status) {
    if (failure) std::rethrow_exception(failure);
    if (status >= ARCHIVE_OK) return status;
    Faults(bytes.file()).fail(0, "damaged ZIP archive: " + error_of(in));
  }

  static la_ssize_t read(archive*, void* data, const void** out) {
    State& state = *static_cast<State*>(data);
    try {
      state.block = state.bytes.text(state.at, kBlock);
    } catch (...) {
      state.failure = std::current_exception();
      return ARCHIVE_FATAL;
    }
    state.at += state.block.size();
    *out = state.block.data();
    return static_cast<la_ssize_t>(state.block.size());
  }
  static la_int64_t skip(archive*, void* data, la_int64_t count) {
    State& state = *static_cast<State*>(data);
    const std::uint64_t skipped =
        std::min(static_cast<std::uint64_t>(std::max<la_int64_t>(count, 0)), state.bytes.size() - state.at);
    state.at += skipped;
    return static_cast<la_int64_t>(skipped);
  }
  static la_int64_t seek(archive*, void* data, la_int64_t offset, int whence) {
    State& state = *static_cast<State*>(data);
    const auto size = static_cast<la_int64_t>(state.bytes.size());
    const la_int64_t base = whence == SEEK_SET ? 0 : whence == SEEK_CUR ? static_cast<la_int64_t>(state.at) : size;
    if (offset < -base) return ARCHIVE_FATAL;
    state.at = static_cast<std::uint64_t>(std::min(base + std::min(offset, size), size));
    return static_cast<la_int64_t>(state.at);
  }

  const ByteSource& bytes;
  Archive in = new_archive();
  std::uint64_t at = 0;
  std::string block;
  std::exception_ptr failure;
};

ZipReader::ZipReader(const ByteSource& bytes) : state_(std::make_unique<State>(bytes)) {
  archive* const in = state_->in.get();
  archive_read_support_format_zip(in);
  archive_read_set_read_callback(in, &State::read);
  archive_read_set_skip_callback(in, &State::skip);
  archive_read_set_seek_callback(in, &State::seek);
  archive_read_set_callback_data(in, state_.get());
  state_->check(archive_read_open1(in));
}

ZipReader::~ZipReader() = default;

bool ZipReader::next() {
  archive_entry* entry = nullptr;
  const int status = archive_read_next_header(state_->in.get(), &entry);
  // A warning is about the name, e.g. its encoding.
  if (status != ARCHIVE_WARN && state_->check(status) == ARCHIVE_EOF) return false;
  const char* const name = archive_entry_pathname(entry);
  name_ = name != nullptr ? name : "";
  return true;
}

ByteBlocks ZipReader::read(std::uint64_t count) {
  const base::StopPoint stop;
  ByteBlocks out;
  while (out.size() < count) {
    stop.check();
    // Grows only by what was decompressed: the headers may declare any size.
    const std::span<char> room = out.room(count - out.size());
    const la_ssize_t got = state_->check(archive_read_data(state_->in.get(), room.data(), room.size()));
    if (got == 0) break;
    out.append(static_cast<std::size_t>(got));
  }
  return out;
}

std::string ZipReader::read_text(std::size_t count) {
  const ByteBlocks bytes = read(count);
  std::string out(static_cast<std::size_t>(bytes.size()), '\0');
  bytes.read(0, out.size(), out.data());
  return out;
}

}  // namespace orrery::data
