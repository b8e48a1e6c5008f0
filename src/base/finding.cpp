// SPDX-License-Identifier: Apache-2.0
#include "base/finding.h"

namespace orrery::base {
namespace {

/// A tab must stay a tab under a tab, or the caret does not stand under its column.
std::string caret_line(const Finding& finding) {
  std::string line;
  for (int i = 1; i < finding.column; ++i) {
    const auto at = static_cast<std::size_t>(i) - 1;
    line += at < finding.source_line.size() && finding.source_line[at] == '\t' ? '\t' : ' ';
  }
  line += '^';
  line.append(finding.width > 1 ? static_cast<std::size_t>(finding.width) - 1 : 0, '~');
  return line;
}

}  // namespace

std::string formatted(const Finding& finding) {
  std::string out = finding.file;
  if (finding.line > 0) out += ':' + std::to_string(finding.line);
  if (finding.column > 0) out += ':' + std::to_string(finding.column);
  if (!out.empty()) out += ": ";
  out += finding.severity == Severity::kError ? "error: " : "warning: ";
  out += finding.text;
  if (!finding.remedy.empty()) out += "; " + finding.remedy;
  out += '\n';
  if (!finding.source_line.empty() && finding.column > 0) {
    out += "    " + finding.source_line + "\n    " + caret_line(finding) + '\n';
  }
  return out;
}

}  // namespace orrery::base
