// SPDX-License-Identifier: Apache-2.0
#include "image/digest.h"

#include <OpenImageIO/hash.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "base/error.h"
#include "base/input_file.h"

namespace orrery::image {
namespace {

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

constexpr char kPrefix[] = "\norrery seal sha1 ";
constexpr std::size_t kPrefixSize = sizeof(kPrefix) - 1;
constexpr std::size_t kLineSize = kPrefixSize + 40 + 1;  // digits, newline

/// Computes the line with the digest of the first `size` bytes of an open file.
///
/// Result     empty if they cannot be read
std::string digest_line(std::FILE* in, std::uint64_t size) {
  OIIO::SHA1 digest;
  std::vector<char> bytes(std::size_t{1} << 20);
  while (size > 0) {
    const std::size_t wanted = size < bytes.size() ? static_cast<std::size_t>(size) : bytes.size();
    if (std::fread(bytes.data(), 1, wanted, in) != wanted) return {};
    digest.append(bytes.data(), wanted);
    size -= wanted;
  }
  std::string text = fmt::format("{}{}\n", kPrefix, digest.digest());
  for (std::size_t i = kPrefixSize; i < text.size(); ++i)
    if (text[i] >= 'A' && text[i] <= 'F') text[i] = static_cast<char>(text[i] - 'A' + 'a');
  return text;
}

}  // namespace

void append_digest(const std::filesystem::path& file, const std::filesystem::path& name) {
  const auto fail = [&](int error) {
    throw base::Error(base::ErrorKind::kIo, fmt::format("writing {} failed: {}", name.string(), std::strerror(error)));
  };
  File in(std::fopen(file.c_str(), "rb"), &std::fclose);
  std::error_code failed;
  const std::uint64_t size = std::filesystem::file_size(file, failed);
  if (!in || failed) fail(errno);
  const std::string text = digest_line(in.get(), size);
  if (text.size() != kLineSize) fail(EIO);
  in.reset();
  std::FILE* const out = std::fopen(file.c_str(), "ab");
  if (out == nullptr) fail(errno);
  const bool written = std::fwrite(text.data(), 1, text.size(), out) == text.size();
  const int error = errno;
  if (std::fclose(out) != 0) fail(errno);
  if (!written) fail(error);
}

void require_digest(const std::filesystem::path& file) {
  base::require_readable(file);
  const File in(std::fopen(file.c_str(), "rb"), &std::fclose);
  if (!in)
    throw base::Error(base::ErrorKind::kMissingInput,
                      fmt::format("cannot open {}: {}", file.string(), std::strerror(errno)));
  const auto damaged = [&](const char* why) { throw base::Error(base::ErrorKind::kBadData, file.string() + why); };
  std::error_code failed;
  const std::uint64_t size = std::filesystem::file_size(file, failed);
  constexpr const char* kNoPartial =
      " is not a checkpoint or shard, or it is truncated; --resume, --sample-range A:B and --shard write such files";
  if (failed || size < kLineSize) damaged(kNoPartial);
  const std::string expected = digest_line(in.get(), size - kLineSize);
  char found[kLineSize];
  if (std::fread(found, 1, kLineSize, in.get()) != kLineSize || std::memcmp(found, kPrefix, kPrefixSize) != 0)
    damaged(kNoPartial);
  if (std::memcmp(found, expected.data(), kLineSize) != 0)
    damaged(" is damaged: its checksum does not match; delete it and render it again");
}

}  // namespace orrery::image
