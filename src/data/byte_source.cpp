// SPDX-License-Identifier: Apache-2.0
#include "data/byte_source.h"

#include <archive.h>
#include <archive_entry.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <vector>

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
      if (got < 0) throw base::Error(base::ErrorKind::kIo, "cannot read " + file().string() + ": " + reason());
      if (got == 0)
        throw base::Error(base::ErrorKind::kIo, file().string() + " has become shorter while it was being read");
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

bool has_compression_signature(std::string_view head) {
  using namespace std::string_view_literals;
  return head.starts_with("\x1f\x8b"sv) || head.starts_with("\x28\xb5\x2f\xfd"sv) || head.starts_with("BZh"sv) ||
         head.starts_with(
             "\xfd"
             "7zXZ\0"sv);
}

std::vector<char> decompressed(const std::filesystem::path& file, std::uint64_t limit) {
  const Archive in(archive_read_new(), &archive_read_free);
  if (!in) throw std::bad_alloc();
  Faults faults(file);
  const auto check = [&](la_ssize_t status) {
    if (status < ARCHIVE_OK) {
      const char* const why = archive_error_string(in.get());
      faults.fail(0, std::string("damaged compressed data: ") + (why != nullptr ? why : "unknown error"));
    }
    return status;
  };
  archive_read_support_filter_gzip(in.get());
  archive_read_support_filter_zstd(in.get());
  archive_read_support_filter_bzip2(in.get());
  archive_read_support_filter_xz(in.get());
  archive_read_support_format_raw(in.get());
  constexpr std::size_t kBlock = std::size_t{1} << 20;
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
    if (out.size() > limit)
      faults.fail(0, "decompresses to more than " + base::bytes_text(limit), "decompress the file first");
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
    throw base::Error(base::ErrorKind::kMissingInput, "cannot open " + file.string() + ": " + why);
  }
  auto plain = std::make_shared<const PlainFile>(file, descriptor, static_cast<std::uint64_t>(status.st_size));
  constexpr std::size_t kLongestSignature = 6;
  if (!has_compression_signature(plain->text(0, kLongestSignature))) return plain;
  return of_memory(file, decompressed(file, limit));
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
