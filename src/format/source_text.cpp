// SPDX-License-Identifier: Apache-2.0
#include "format/source_text.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <system_error>

#include "base/error.h"

namespace orrery::format {

void SourceText::add(const std::string& name, std::string_view text) {
  std::vector<std::string>& lines = lines_[name];
  for (std::size_t begin = 0; begin <= text.size();) {
    std::size_t end = text.find('\n', begin);
    if (end == std::string_view::npos) end = text.size();
    std::string_view line = text.substr(begin, end - begin);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    lines.emplace_back(line);
    begin = end + 1;
  }
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
  const auto lines = lines_.find(place.text_name);
  if (lines != lines_.end() && place.line > 0 && static_cast<std::size_t>(place.line) <= lines->second.size()) {
    constexpr std::size_t kLongestShown = 400;  // a line that wraps ten times helps nobody
    const std::string& line = lines->second[static_cast<std::size_t>(place.line) - 1];
    if (line.size() <= kLongestShown) out.source_line = line;
  }
  return out;
}

std::string read_file(const std::filesystem::path& file, std::uint64_t largest_bytes) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error))
    throw base::Error(base::ErrorKind::kMissingInput, "cannot open " + file.string() + ": it is a directory");
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> in(std::fopen(file.c_str(), "rb"), &std::fclose);
  if (!in)
    throw base::Error(base::ErrorKind::kMissingInput, "cannot open " + file.string() + ": " + std::strerror(errno));
  const auto size = std::filesystem::file_size(file, error);
  if (!error && size > largest_bytes)
    throw base::Error(base::ErrorKind::kBadData, file.string() + " is larger than the " +
                                                     std::to_string(largest_bytes >> 20) + " MiB that are read");
  std::string bytes;
  bytes.resize(error ? 0 : static_cast<std::size_t>(size));
  std::size_t got = std::fread(bytes.data(), 1, bytes.size(), in.get());
  if (got < bytes.size()) bytes.resize(got);
  // What has no size beforehand (a pipe), or grew meanwhile, is read on until its end.
  char more[65536];
  while ((got = std::fread(more, 1, sizeof(more), in.get())) > 0) {
    bytes.append(more, got);
    if (bytes.size() > largest_bytes)
      throw base::Error(base::ErrorKind::kBadData, file.string() + " is larger than the " +
                                                       std::to_string(largest_bytes >> 20) + " MiB that are read");
  }
  if (std::ferror(in.get()) != 0)
    throw base::Error(base::ErrorKind::kIo, "reading " + file.string() + " failed");
  return bytes;
}

}  // namespace orrery::format
