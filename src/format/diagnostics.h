// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "base/error.h"
#include "format/source_text.h"

namespace orrery::format {

/// Maximum number of errors reported for one scene; a generated scene may have the same error in a million spheres.
inline constexpr std::size_t kMaxErrors = 100;

/// Collects the diagnostics of a scene: warnings, the first kMaxErrors errors by location, and the number of errors.
class Diagnostics {
 public:
  /// Adds a diagnostic. `make` creates it, and is called only if it is kept.
  template <class Make>
  void add(base::Severity severity, const Place& place, base::ErrorKind kind, Make make) {
    if (severity == base::Severity::kWarning) {
      warnings_.push_back(make());
      return;
    }
    ++errors_;
    if (kind == base::ErrorKind::kMissingInput) ++missing_;
    const Key key{place.text_name, place.line, place.column};
    if (shown_.size() >= kMaxErrors && !(key < std::prev(shown_.end())->first)) return;
    shown_.emplace(key, make());
    if (shown_.size() > kMaxErrors) shown_.erase(std::prev(shown_.end()));
  }

  /// Adds an input that cannot be opened, and which an error names.
  void add_missing(const base::FileError& error) {
    if (!missing_file_) missing_file_ = error;
  }

  bool has_errors() const { return errors_ > 0; }
  std::vector<base::Diagnostic> take_warnings() { return std::move(warnings_); }

  /// Throws if there are errors.
  ///
  /// Errors     base::Error with the diagnostics: kMissingInput if all errors are inputs that cannot be opened, with
  /// the
  ///            first of add_missing(); else kBadData
  void raise_errors(const std::string& file) const;

 private:
  using Key = std::tuple<std::string, int, int>;

  std::multimap<Key, base::Diagnostic> shown_;
  std::vector<base::Diagnostic> warnings_;
  std::size_t errors_ = 0, missing_ = 0;
  std::optional<base::FileError> missing_file_;
};

}  // namespace orrery::format
