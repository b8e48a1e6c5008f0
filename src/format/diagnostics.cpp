// SPDX-License-Identifier: Apache-2.0
#include "format/diagnostics.h"

namespace orrery::format {

void Diagnostics::raise_errors(const std::string& file) const {
  if (errors_ == 0) return;
  std::vector<base::Finding> findings;
  for (const auto& [key, finding] : shown_) findings.push_back(finding);
  if (errors_ > shown_.size()) {
    base::Finding rest;
    rest.file = file;
    rest.text = "and " + std::to_string(errors_ - shown_.size()) + " more (" + std::to_string(errors_) + " in all)";
    findings.push_back(std::move(rest));
  }
  throw base::Error(missing_ == errors_ ? base::ErrorKind::kMissingInput : base::ErrorKind::kBadData,
                    file + ": " + std::to_string(errors_) + (errors_ == 1 ? " error" : " errors"), std::move(findings));
}

}  // namespace orrery::format
