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
  const std::string message = fmt::format("{}: {}{}", file, errors_, errors_ == 1 ? " error" : " errors");
  const bool all_missing = missing_ == errors_;
  if (all_missing && missing_file_)
    throw base::FileError(base::ErrorKind::kMissingInput, message, missing_file_->file(), missing_file_->number(),
                          std::move(diagnostics));
  throw base::Error(all_missing ? base::ErrorKind::kMissingInput : base::ErrorKind::kBadData, message,
                    std::move(diagnostics));
}

}  // namespace orrery::format
