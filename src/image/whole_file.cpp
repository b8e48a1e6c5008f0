// SPDX-License-Identifier: Apache-2.0
#include "image/whole_file.h"

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include <OpenImageIO/hash.h>
#include <fmt/core.h>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/input_file.h"
#include "base/text.h"
#include "image/checked_file.h"
#include "image/input.h"
#include "image/library.h"

namespace orrery::image {
namespace {

[[noreturn]] void io_failed(const std::filesystem::path& file, const std::string& reason) {
  throw base::Error(base::ErrorKind::kIo, fmt::format("writing {} failed: {}", file.string(), reason));
}

/// Keeps OpenImageIO from writing the current date and time into a part that has no date.
void keep_without_date(OIIO::ImageSpec& spec) {
  if (!spec.get_string_attribute("DateTime").empty()) return;
  // OpenImageIO adds the date if there is no such attribute, and drops an attribute that is not a string.
  const std::uint8_t no_text = 0;
  spec.attribute("DateTime", OIIO::TypeDesc::UINT8, &no_text);
}

/// Encodes all parts with OpenImageIO.
///
/// Result     OpenImageIO's error message, or empty. Errors are always fetched, since OpenImageIO prints pending ones.
std::string encode(OIIO::ImageOutput& out, const std::string& name, OIIO::TypeDesc type,
                   const std::vector<WholePart>& parts) {
  const auto error_message = [&](const char* step) {
    const std::string text = out.geterror();
    return text.empty() ? std::string(step) + " failed" : text;
  };
  std::vector<OIIO::ImageSpec> specs;
  for (const WholePart& part : parts) keep_without_date(specs.emplace_back(part.spec));
  if (!out.open(name, static_cast<int>(specs.size()), specs.data())) return error_message("opening");
  std::string first_error;
  for (std::size_t i = 0; i < parts.size() && first_error.empty(); ++i) {
    if (i > 0 && !out.open(name, specs[i], OIIO::ImageOutput::AppendSubimage)) return error_message("opening a part");
    const bool written = parts[i].deep != nullptr ? out.write_deep_image(*parts[i].deep)
                                                  : out.write_image(parts[i].type.value_or(type), parts[i].pixels);
    if (!written) first_error = error_message("encoding");
  }
  if (!out.close() && first_error.empty()) return error_message("closing");
  out.geterror();
  return first_error;
}

/// Reopens the file and decodes the last row of every part.
///
/// Result     what is wrong, or empty
std::string read_back(const std::string& name, const std::string& format, const std::vector<WholePart>& parts) {
  Input input{OIIO::ImageInput::create(format), {}, 0};
  if (!input.in) return OIIO::geterror();
  OIIO::ImageSpec& spec = input.spec;
  if (!input.in->open(name, spec)) return "it cannot be read back: " + input.in->geterror();
  for (const WholePart& part : parts) {
    const OIIO::ImageSpec& written = part.spec;
    std::string wrong;
    if (!input.in->seek_subimage(input.part, 0)) {
      wrong = "a part cannot be read back";
    } else if (spec = input.in->spec();
               spec.width != written.width || spec.height != written.height || spec.nchannels != written.nchannels) {
      wrong = "it reads back as a different image";
    } else if (const int last = spec.tile_width == 0 ? 1 : (spec.height - 1) % spec.tile_height + 1;
               !input.can_decode(spec.y + spec.height - last, spec.y + spec.height)) {
      wrong = "its last row cannot be read back";
    }
    const std::string reason = input.in->geterror();
    if (!wrong.empty()) return reason.empty() ? wrong : fmt::format("{}: {}", wrong, reason);
    ++input.part;
  }
  return {};
}

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
    const std::size_t wanted = std::min(size, std::uint64_t{bytes.size()});
    if (std::fread(bytes.data(), 1, wanted, in) != wanted) return {};
    digest.append(bytes.data(), wanted);
    size -= wanted;
  }
  return fmt::format("{}{}\n", kPrefix, base::lower(digest.digest()));
}

/// Appends a digest of all bytes of a file, after the end of the image data. It detects any changed bit, including bits
/// that no decoder reads. It protects against accidental damage, not against tampering.
///
/// Errors     base::Error(kIo); the message uses `name` for the file
/// Reference  SHA-1, FIPS 180-4
void append_digest(const std::filesystem::path& file, const std::filesystem::path& name) {
  const auto fail = [&](int error) { io_failed(name, std::strerror(error)); };
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

}  // namespace

void write_whole(const std::filesystem::path& file, const std::string& format, OIIO::TypeDesc type,
                 const std::vector<WholePart>& parts, bool with_digest) {
  prepare_library();
  base::AtomicFile target(file);
  const std::string name = target.temporary().string();
  // Declared before its user: a failed encoder may still write in its destructor.
  CheckedFile bytes(target.temporary());
  std::string message;
  std::unique_ptr<OIIO::ImageOutput> out;
  if (format == "jpeg") {
    message = encode_jpeg(parts.front().spec, static_cast<const std::uint8_t*>(parts.front().pixels), bytes);
  } else {
    out = OIIO::ImageOutput::create(format);
    if (!out || !out->supports("ioproxy"))
      throw base::Error(base::ErrorKind::kInternal,
                        fmt::format("this OpenImageIO cannot write {} files {}", format, OIIO::geterror()));
    out->set_ioproxy(&bytes);
    message = encode(*out, name, type, parts);
  }
  if (const int error = bytes.finish(); error != 0) io_failed(file, std::strerror(error));
  if (!message.empty()) io_failed(file, message);
  if (const std::string wrong = read_back(name, format, parts); !wrong.empty()) io_failed(file, wrong);
  if (with_digest) append_digest(target.temporary(), file);
  target.commit();
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
