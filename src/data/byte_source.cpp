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
#include <cstring>
#include <vector>

#include <fmt/core.h>

#include "base/error.h"
#include "base/input_file.h"
#include "base/stop_point.h"
#include "base/text.h"
#include "data/faults.h"

namespace orrery::data {
namespace {

std::string reason() { return std::strerror(errno); }

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
      const ssize_t got = ::pread(descriptor_, out + done, count - done, static_cast<off_t>(offset + done));
      if (got < 0 && errno == EINTR) continue;
      if (got < 0)
        throw base::Error(base::ErrorKind::kIo, fmt::format("cannot read {}: {}", file().string(), reason()));
      if (got == 0) throw base::Error(base::ErrorKind::kIo, file().string() + " was truncated while it was being read");
      done += static_cast<std::size_t>(got);
    }
  }

 private:
  int descriptor_;
};

class BytesInMemory final : public ByteSource {
 public:
  BytesInMemory(const std::filesystem::path& file, std::vector<char> bytes)
      : ByteSource(file, bytes.size(), true), bytes_(std::move(bytes)) {}

  void read(std::uint64_t offset, std::size_t count, char* out) const override {
    std::memcpy(out, bytes_.data() + offset, count);
  }

 private:
  std::vector<char> bytes_;
};

using Archive = std::unique_ptr<archive, decltype(&archive_read_free)>;

bool is_gzip(std::string_view head) { return head.starts_with("\x1f\x8b"); }

bool is_of_archive_library(std::string_view head) {
  using namespace std::string_view_literals;
  return head.starts_with("\x28\xb5\x2f\xfd"sv) || head.starts_with("BZh"sv) ||
         head.starts_with(
             "\xfd"
             "7zXZ\0"sv);
}

constexpr std::size_t kBlock = std::size_t{1} << 20;

[[noreturn]] void fail_as_damaged(const std::filesystem::path& file, const std::string& why) {
  Faults(file).fail(0, "damaged compressed data: " + why,
                    "`gzip -t`, `zstd -t`, `bzip2 -t` or `xz -t` checks the file");
}

void check_limit(const std::filesystem::path& file, std::uint64_t size, std::uint64_t limit) {
  if (size > limit)
    Faults(file).fail(0, "decompresses to more than " + base::bytes_text(limit), "decompress the file first");
}

/// Decompresses the members of a gzip file. By zlib, since libarchive does not verify their checksums.
class GzipFile {
 public:
  explicit GzipFile(const ByteSource& bytes) : bytes_(bytes) {
    constexpr int kGzip = 16;
    if (inflateInit2(&stream_, kGzip + MAX_WBITS) != Z_OK) throw std::bad_alloc();
  }
  GzipFile(const GzipFile&) = delete;
  GzipFile& operator=(const GzipFile&) = delete;
  ~GzipFile() { inflateEnd(&stream_); }

  std::vector<char> read(std::uint64_t limit) {
    std::vector<char> out;
    const base::StopPoint stop;
    for (bool ends = false; !ends;) {
      stop.check();
      const std::size_t at = out.size();
      // Grows only by what was decompressed: a header may declare any size.
      out.resize(at + kBlock);
      stream_.next_out = reinterpret_cast<Bytef*>(out.data() + at);
      stream_.avail_out = kBlock;
      while (stream_.avail_out > 0 && !ends) ends = !step();
      out.resize(out.size() - stream_.avail_out);
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

std::vector<char> decompressed(const std::filesystem::path& file, std::uint64_t limit) {
  const Archive in(archive_read_new(), &archive_read_free);
  if (!in) throw std::bad_alloc();
  const auto check = [&](la_ssize_t status) {
    if (status < ARCHIVE_OK) {
      const char* const why = archive_error_string(in.get());
      fail_as_damaged(file, why != nullptr ? why : "unknown error");
    }
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
  std::vector<char> out;
  const base::StopPoint stop;
  for (;;) {
    stop.check();
    const std::size_t at = out.size();
    // Grows only by what was decompressed: the header of a compressed file may declare any size.
    out.resize(at + kBlock);
    const auto got = static_cast<std::size_t>(check(archive_read_data(in.get(), out.data() + at, kBlock)));
    out.resize(at + got);
    if (got == 0) return out;
    check_limit(file, out.size(), limit);
  }
}

}  // namespace

std::shared_ptr<const ByteSource> ByteSource::open(const std::filesystem::path& file, std::uint64_t limit) {
  base::require_readable(file);
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat status {};
  if (descriptor < 0 || ::fstat(descriptor, &status) != 0) {
    const std::string why = reason();
    if (descriptor >= 0) ::close(descriptor);
    throw base::Error(base::ErrorKind::kMissingInput, fmt::format("cannot open {}: {}", file.string(), why));
  }
  auto plain = std::make_shared<const PlainFile>(file, descriptor, static_cast<std::uint64_t>(status.st_size));
  constexpr std::size_t kLongestSignature = 6;
  const std::string head = plain->text(0, kLongestSignature);
  if (is_gzip(head)) return of_memory(file, GzipFile(*plain).read(limit));
  if (is_of_archive_library(head)) return of_memory(file, decompressed(file, limit));
  return plain;
}

std::shared_ptr<const ByteSource> ByteSource::of_memory(const std::filesystem::path& file, std::vector<char> bytes) {
  return std::make_shared<const BytesInMemory>(file, std::move(bytes));
}

std::string ByteSource::text(std::uint64_t offset, std::size_t count) const {
  if (offset >= size_) return {};
  std::string out(static_cast<std::size_t>(std::min<std::uint64_t>(count, size_ - offset)), '\0');
  read(offset, out.size(), out.data());
  return out;
}

}  // namespace orrery::data
