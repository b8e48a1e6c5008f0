// SPDX-License-Identifier: Apache-2.0
#include "base/error.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "base/text.h"

namespace orrery::base {
namespace {

/// Returns the line with the caret. It repeats the tabs of the source line, so that the caret is under its column. Only
/// the first byte of a character takes one.
std::string caret_line(const Diagnostic& diagnostic) {
  const std::string& source = diagnostic.source_line;
  const std::size_t begin = std::min(static_cast<std::size_t>(diagnostic.column) - 1, source.size());
  std::size_t end = std::min(begin + static_cast<std::size_t>(std::max(diagnostic.width, 1)), source.size());
  while (end < source.size() && continues_character(source[end])) ++end;
  std::string line;
  for (const char c : printable(source.substr(0, begin)))
    if (!continues_character(c)) line += c == '\t' ? '\t' : ' ';
  const std::size_t caret = line.size();
  for (const char c : printable(source.substr(begin, end - begin)))
    if (!continues_character(c)) line += '~';
  line.resize(std::max(line.size(), caret + 1));
  line[caret] = '^';
  return line;
}

constexpr const char* kWarning = "warning: ";

}  // namespace

std::string formatted(const Diagnostic& diagnostic) {
  std::string out = printable(diagnostic.file);
  if (diagnostic.line > 0) out += ':' + std::to_string(diagnostic.line);
  if (diagnostic.line > 0 && diagnostic.column > 0) out += ':' + std::to_string(diagnostic.column);
  if (!out.empty()) out += ": ";
  out += diagnostic.severity == Severity::kError ? "error: " : kWarning;
  out += printable(diagnostic.text);
  if (!diagnostic.remedy.empty()) out += "; " + printable(diagnostic.remedy);
  out += '\n';
  if (!diagnostic.source_line.empty() && diagnostic.column > 0) {
    out += "    " + printable(diagnostic.source_line) + "\n    " + caret_line(diagnostic) + '\n';
  }
  return out;
}

std::string warning_line(std::string_view text) { return std::string(kWarning).append(text) + '\n'; }

Diagnostic file_diagnostic(Severity severity, std::string file, std::string text, std::string remedy) {
  Diagnostic out;
  out.severity = severity;
  out.file = std::move(file);
  out.text = std::move(text);
  out.remedy = std::move(remedy);
  return out;
}

}  // namespace orrery::base
