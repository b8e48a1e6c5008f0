// SPDX-License-Identifier: Apache-2.0
#include "format/source_text.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <system_error>

#include "base/error.h"

namespace orrery::format {

namespace {

/// A file may be nothing but line ends: the place of every line would be eight times as large as the file.
constexpr std::size_t kStride = 64;

/// A line that wraps ten times helps nobody.
constexpr std::size_t kLongestShown = 400;

/// The byte, from 0, at which the `index`-th character begins; beyond the end where there are not as many.
std::size_t byte_of_character(std::string_view line, std::size_t index) {
  std::size_t at = 0;
  for (; at < line.size(); ++at) {
    const bool begins = (static_cast<unsigned char>(line[at]) & 0xC0u) != 0x80u;
    if (begins && index-- == 0) return at;
  }
  return at + index;
}

}  // namespace

void SourceText::add(const std::string& name, std::string_view text) {
  const auto [at, is_new] = texts_.try_emplace(name);
  if (!is_new) at->second.bytes += '\n';
  at->second.bytes += text;
  at->second.begins.clear();
}

std::string_view SourceText::line_of(const Text& text, int line) {
  const std::string_view bytes = text.bytes;
  if (text.begins.empty()) {
    text.begins.push_back(0);
    std::size_t count = 0;
    for (std::size_t at = bytes.find('\n'); at != std::string_view::npos; at = bytes.find('\n', at + 1))
      if (++count % kStride == 0) text.begins.push_back(at + 1);
  }
  const auto index = static_cast<std::size_t>(line) - 1;
  if (line < 1 || index / kStride >= text.begins.size()) return {};
  std::size_t begin = text.begins[index / kStride];
  for (std::size_t i = 0; i < index % kStride; ++i) {
    const std::size_t end = bytes.find('\n', begin);
    if (end == std::string_view::npos) return {};
    begin = end + 1;
  }
  std::string_view out = bytes.substr(begin, bytes.find('\n', begin) - begin);
  if (!out.empty() && out.back() == '\r') out.remove_suffix(1);
  return out;
}

base::Finding SourceText::finding(base::Severity severity, const Place& place, std::string text,
                                  std::string remedy) const {
  base::Finding out;
  out.severity = severity;
  out.file = place.text_name;
  out.line = place.line;
  out.column = place.column;
  out.width = place.width;
  out.text = std::move(text);
  out.remedy = std::move(remedy);
  const auto found = texts_.find(place.text_name);
  if (found == texts_.end() || place.column < 1) return out;
  const std::string_view line = line_of(found->second, place.line);
  const auto begin = static_cast<std::size_t>(place.column) - 1;
  const std::size_t first = byte_of_character(line, begin);
  out.column = static_cast<int>(first) + 1;
  out.width = static_cast<int>(byte_of_character(line, begin + static_cast<std::size_t>(place.width)) - first);
  if (line.size() <= kLongestShown) out.source_line = line;
  return out;
}

std::string read_file(const std::filesystem::path& file, std::uint64_t largest_bytes) {
  const auto too_large = [&] {
    return base::Error(base::ErrorKind::kBadData, file.string() + " is larger than the " +
                                                      std::to_string(largest_bytes >> 20) + " MiB that are read");
  };
  std::error_code error;
  if (std::filesystem::is_directory(file, error))
    throw base::Error(base::ErrorKind::kMissingInput, "cannot open " + file.string() + ": it is a directory");
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> in(std::fopen(file.c_str(), "rb"), &std::fclose);
  if (!in)
    throw base::Error(base::ErrorKind::kMissingInput, "cannot open " + file.string() + ": " + std::strerror(errno));
  const auto size = std::filesystem::file_size(file, error);
  if (!error && size > largest_bytes) throw too_large();
  std::string bytes;
  bytes.resize(error ? 0 : static_cast<std::size_t>(size));
  std::size_t got = std::fread(bytes.data(), 1, bytes.size(), in.get());
  if (got < bytes.size()) bytes.resize(got);
  // What has no size beforehand (a pipe), or grew meanwhile, is read on until its end.
  char more[65536];
  while ((got = std::fread(more, 1, sizeof(more), in.get())) > 0) {
    bytes.append(more, got);
    if (bytes.size() > largest_bytes) throw too_large();
  }
  if (std::ferror(in.get()) != 0) throw base::Error(base::ErrorKind::kIo, "reading " + file.string() + " failed");
  return bytes;
}

}  // namespace orrery::format
