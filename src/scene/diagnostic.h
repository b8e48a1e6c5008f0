// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"

namespace orrery::scene {

/// A diagnostic that concerns several values of the scene, or one element of bulk data.
struct SceneDiagnostic {
  base::Severity severity = base::Severity::kError;
  std::string key;  ///< "camera.up", "sphere[3].radius", "points[0].file", 0-based; empty: the whole scene
  std::string text;
  base::ErrorKind kind = base::ErrorKind::kBadData;  ///< kind of an error: kBadData or kMissingInput
};

/// Collects diagnostics about the keys of a scene, or of a table.
class KeyFaults {
 public:
  /// `table`    prefix of the keys: "points[0]"; empty: the whole scene
  explicit KeyFaults(std::string table = {}) : table_(std::move(table)) {}

  /// Adds an error about a key.
  ///
  /// `part`     the key within the table: ".radius.column"; empty: the whole table
  void error(const std::string& part, std::string text, base::ErrorKind kind = base::ErrorKind::kBadData) {
    diagnostics_.push_back({base::Severity::kError, table_ + part, std::move(text), kind});
    has_errors_ = true;
  }
  /// Adds an error that has been thrown, as kMissingInput or kBadData.
  void error(const std::string& part, const base::Error& thrown) {
    const bool is_missing = thrown.kind() == base::ErrorKind::kMissingInput;
    error(part, thrown.what(), is_missing ? base::ErrorKind::kMissingInput : base::ErrorKind::kBadData);
  }
  /// Adds an error, unless the text is empty.
  void error_if_any(const std::string& part, std::string text) {
    if (!text.empty()) error(part, std::move(text));
  }
  void warning(const std::string& part, std::string text) {
    diagnostics_.push_back({base::Severity::kWarning, table_ + part, std::move(text)});
  }

  bool has_errors() const { return has_errors_; }
  std::vector<SceneDiagnostic> take() { return std::move(diagnostics_); }

 private:
  std::string table_;
  std::vector<SceneDiagnostic> diagnostics_;
  bool has_errors_ = false;
};

/// Maximum number of similar diagnostics of bulk data; only the number of the others is reported.
inline constexpr std::size_t kMaxReported = 3;

/// Returns "and 10 more (13 in all)", if more than kMaxReported were found; otherwise an empty text.
inline std::string rest_text(std::size_t count) {
  if (count <= kMaxReported) return {};
  return "and " + std::to_string(count - kMaxReported) + " more (" + std::to_string(count) + " in all)";
}

}  // namespace orrery::scene
