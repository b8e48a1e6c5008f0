// SPDX-License-Identifier: Apache-2.0
#include "image/input.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <mutex>
#include <sstream>
#include <string_view>
#include <vector>

#include <OpenImageIO/deepdata.h>
#include <fmt/core.h>
#include <zlib.h>

#include "base/error.h"
#include "base/image_limits.h"
#include "base/input_file.h"
#include "image/format.h"
#include "image/library.h"
#include "math/pixels.h"

namespace orrery::image {
namespace {

/// Rows decoded at a time: a multiple of the block height of every EXR compression except dwab.
constexpr int kRowsAtATime = 64;

/// libpng prints its errors to standard error, and OpenImageIO, which reports them too, has no switch for that.
/// Collects what is printed while a PNG file is read, and prints the lines of others at the end.
class QuietPng {
 public:
  explicit QuietPng(const OIIO::ImageInput& in) {
    if (std::strcmp(in.format_name(), "png") != 0) return;
    static std::mutex one;
    lock_ = std::unique_lock(one);
    std::fflush(stderr);
    printed_ = memfd_create("stderr", MFD_CLOEXEC);
    stderr_ = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 0);
    is_active_ = printed_ >= 0 && stderr_ >= 0 && dup2(printed_, STDERR_FILENO) >= 0;
  }
  ~QuietPng() {
    if (is_active_) {
      std::fflush(stderr);
      dup2(stderr_, STDERR_FILENO);
      print_others();
    }
    for (const int file : {printed_, stderr_})
      if (file >= 0) close(file);
  }
  QuietPng(const QuietPng&) = delete;
  QuietPng& operator=(const QuietPng&) = delete;

 private:
  void print_others() const {
    std::string text;
    char block[4096];
    lseek(printed_, 0, SEEK_SET);
    for (ssize_t got = 0; (got = read(printed_, block, sizeof(block))) > 0;)
      text.append(block, static_cast<std::size_t>(got));
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
      if (!line.starts_with("libpng ")) std::fprintf(stderr, "%s\n", line.c_str());
  }

  std::unique_lock<std::mutex> lock_;
  int printed_ = -1, stderr_ = -1;
  bool is_active_ = false;
};

constexpr const char* kTruncated = "the file is truncated";

/// Reads bytes; false at the end of the file.
bool get(std::istream& in, char* to, std::size_t count) {
  return static_cast<bool>(in.read(to, static_cast<std::streamsize>(count)));
}

std::uint32_t big_endian(const char* bytes) {
  std::uint32_t out = 0;
  for (int i = 0; i < 4; ++i) out = out << 8 | static_cast<unsigned char>(bytes[i]);
  return out;
}

/// A PNG file is a signature and chunks: length, name, data, checksum of name and data. The last one is IEND.
std::string damage_of_png(std::istream& in) {
  constexpr std::string_view kSignature("\x89PNG\r\n\x1a\n", 8);
  std::array<char, 8> head{};
  const bool is_complete = get(in, head.data(), head.size());
  if (!kSignature.starts_with({head.data(), static_cast<std::size_t>(in.gcount())})) return {};
  if (!is_complete) return kTruncated;
  std::vector<char> data(std::size_t{1} << 16);
  const auto update = [](uLong sum, const char* bytes, std::size_t count) {
    return crc32(sum, reinterpret_cast<const Bytef*>(bytes), static_cast<uInt>(count));
  };
  for (;;) {
    if (!get(in, head.data(), head.size())) return kTruncated;
    const std::string_view name(head.data() + 4, 4);
    uLong sum = update(crc32(0, nullptr, 0), name.data(), name.size());
    for (std::size_t left = big_endian(head.data()); left > 0;) {
      const std::size_t count = std::min(left, data.size());
      if (!get(in, data.data(), count)) return kTruncated;
      sum = update(sum, data.data(), count);
      left -= count;
    }
    std::array<char, 4> stored{};
    if (!get(in, stored.data(), stored.size())) return kTruncated;
    // libpng leaves out chunks that are not needed to decode the image; their names begin with a small letter.
    const bool is_needed = std::isupper(static_cast<unsigned char>(name[0])) != 0;
    if (is_needed && sum != big_endian(stored.data())) return "the file is damaged: a checksum does not match";
    if (name == "IEND") return {};
  }
}

/// In a truncated JPEG file, no end marker follows the last scan.
std::string damage_of_jpeg(std::istream& in) {
  if (in.get() != 0xFF || in.get() != 0xD8) return {};
  bool in_scan = false, is_closed = false;
  for (int before = 0, now = in.get(); now != std::istream::traits_type::eof(); before = now, now = in.get()) {
    if (before != 0xFF) continue;
    if (now == 0xDA) in_scan = true, is_closed = false;
    if (now == 0xD9 && in_scan) is_closed = true;
  }
  return is_closed ? "" : kTruncated;
}

/// Returns the first line of OpenImageIO's messages about an image. It names the cause; the others are consequences.
std::string first_message(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace

void fail_to_read(const std::filesystem::path& file, const std::string& reason) {
  throw base::Error(base::ErrorKind::kBadData, fmt::format("cannot read image {}: {}", file.string(), reason));
}

void fail_for_memory(const std::filesystem::path& file) {
  throw base::Error(base::ErrorKind::kNoMemory,
                    fmt::format("cannot read image {}: there is not enough memory for its pixels", file.string()));
}

void check_spec(const std::filesystem::path& file, const OIIO::ImageSpec& spec) {
  const auto too_large = [](int side) { return side < 1 || side > base::kLargestSide; };
  if (too_large(spec.width) || too_large(spec.height) || too_large(spec.full_width) || too_large(spec.full_height))
    fail_to_read(file, fmt::format("its header says {} x {} pixels; a side must be 1 to {}", spec.full_width,
                                   spec.full_height, base::kLargestSide));
  if (spec.deep) fail_to_read(file, "its pixels are deep; flatten them first");
}

int Input::row_step() const { return spec.tile_width == 0 ? kRowsAtATime : spec.tile_height; }

bool Input::decode(int begin, int end, int first_channel, int end_channel, OIIO::TypeDesc type, void* out) const {
  const QuietPng quiet(*in);
  if (spec.tile_width == 0) return in->read_scanlines(part, 0, begin, end, 0, first_channel, end_channel, type, out);
  return in->read_tiles(part, 0, spec.x, spec.x + spec.width, begin, end, 0, 1, first_channel, end_channel, type, out);
}

bool Input::can_decode(int begin, int end) const {
  if (spec.deep) {
    OIIO::DeepData deep;
    return in->read_native_deep_scanlines(part, 0, begin, end, 0, 0, spec.nchannels, deep);
  }
  std::vector<float> rows(math::pixel_count(spec.width, end - begin) * static_cast<std::size_t>(spec.nchannels));
  return decode(begin, end, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, rows.data());
}

std::string Input::error_message() const {
  const std::string text = first_message(in->geterror());
  return text.empty() ? "its pixels cannot be decoded" : text;
}

Input open_input(const std::filesystem::path& file, Alpha alpha) {
  prepare_library();
  const Format format = format_of(file);
  base::require_readable(file);
  if (format == Format::kSvg) fail_to_read(file, "SVG files are only written; name a PNG or EXR of the same image");
  if (const std::string damage = damage_of(file, format); !damage.empty()) fail_to_read(file, damage);
  Input out{OIIO::ImageInput::create(info_of(format).library_name), {}, 0};
  if (!out.in)
    throw base::Error(base::ErrorKind::kInternal,
                      fmt::format("this OpenImageIO cannot read {}{}", file.string(), OIIO::geterror()));
  OIIO::ImageSpec settings;
  if (alpha == Alpha::kAsInFile) settings.attribute("oiio:UnassociatedAlpha", 1);
  const QuietPng quiet(*out.in);
  if (!out.in->open(file.string(), out.spec, settings)) fail_to_read(file, first_message(out.in->geterror()));
  check_spec(file, out.spec);
  return out;
}

std::string damage_of(const std::filesystem::path& file, Format format) {
  if (format != Format::kPng && format != Format::kJpeg) return {};
  std::ifstream in(file, std::ios::binary);
  if (!in) return {};
  return format == Format::kPng ? damage_of_png(in) : damage_of_jpeg(in);
}

}  // namespace orrery::image
