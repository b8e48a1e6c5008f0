// SPDX-License-Identifier: Apache-2.0
#include "data/faults.h"

#include <algorithm>
#include <limits>
#include <utility>

#include <fmt/core.h>

#include "base/error.h"

namespace orrery::data {

void Faults::add(std::uint64_t line, const std::string& text, const std::string& remedy) {
  diagnostics_.push_back(base::file_diagnostic(base::Severity::kError, file_, text, remedy));
  diagnostics_.back().line = static_cast<int>(std::min<std::uint64_t>(line, std::numeric_limits<int>::max()));
}

void Faults::add_of_many(std::uint64_t line, const std::string& text) {
  if (++many_ <= kMaxListed) add(line, text);
}

void Faults::fail(std::uint64_t line, const std::string& text, const std::string& remedy) {
  add(line, text, remedy);
  raise();
}

std::string Faults::take_text() {
  const std::vector<base::Diagnostic> taken = std::exchange(diagnostics_, {});
  const std::uint64_t others = std::max<std::uint64_t>(std::exchange(many_, 0), taken.size()) - 1;
  const std::string line = taken.front().line > 0 ? fmt::format("line {}: ", taken.front().line) : "";
  return line + taken.front().text + (others > 0 ? fmt::format(", and {} more", others) : "");
}

void Faults::raise_if_any() {
  if (has_any()) raise();
}

void Faults::raise() {
  if (many_ > kMaxListed) add(0, fmt::format("and {} more ({} in all)", many_ - kMaxListed, many_));
  throw base::Error(base::ErrorKind::kBadData, "cannot use " + file_, std::move(diagnostics_));
}

}  // namespace orrery::data
