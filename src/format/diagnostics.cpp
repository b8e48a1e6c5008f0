// SPDX-License-Identifier: Apache-2.0
#include "format/diagnostics.h"

#include <fmt/core.h>

namespace orrery::format {

void Diagnostics::raise_errors(const std::string& file) const {
  if (errors_ == 0) return;
  std::vector<base::Diagnostic> diagnostics;
  for (const auto& [key, diagnostic] : shown_) diagnostics.push_back(diagnostic);
  if (errors_ > shown_.size()) {
    base::Diagnostic rest;
    rest.file = file;
    rest.text = fmt::format("and {} more ({} in all)", errors_ - shown_.size(), errors_);
    diagnostics.push_back(std::move(rest));
  }
  throw base::Error(missing_ == errors_ ? base::ErrorKind::kMissingInput : base::ErrorKind::kBadData,
                    fmt::format("{}: {}{}", file, errors_, errors_ == 1 ? " error" : " errors"),
                    std::move(diagnostics));
}

}  // namespace orrery::format
