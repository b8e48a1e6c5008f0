// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <iterator>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/diagnostic.h"
#include "format/source_text.h"

namespace orrery::format {

/// Errors reported of one scene; a generated scene may have the same fault in each of a million spheres.
inline constexpr std::size_t kMostErrors = 100;

/// Collects what is wrong with a scene, in the order of the places: the first kMostErrors errors, and how many there
/// are.
class Diagnostics {
 public:
  /// `make` gives the finding; it is called only for one that will be shown.
  template <class Make>
  void add(base::Severity severity, const Place& place, base::ErrorKind kind, Make make) {
    if (severity == base::Severity::kWarning) {
      warnings_.push_back(make());
      return;
    }
    ++errors_;
    if (kind == base::ErrorKind::kMissingInput) ++missing_;
    const Key key{place.text_name, place.line, place.column};
    if (shown_.size() >= kMostErrors && !(key < std::prev(shown_.end())->first)) return;
    shown_.emplace(key, make());
    if (shown_.size() > kMostErrors) shown_.erase(std::prev(shown_.end()));
  }

  bool has_errors() const { return errors_ > 0; }
  std::vector<base::Diagnostic> take_warnings() { return std::move(warnings_); }

  /// Ends the reading of `file` where there is an error.
  ///
  /// Errors     base::Error with the findings: kMissingInput where nothing is wrong but inputs that cannot be opened,
  ///            else kBadData
  void raise_errors(const std::string& file) const;

 private:
  using Key = std::tuple<std::string, int, int>;

  std::multimap<Key, base::Diagnostic> shown_;
  std::vector<base::Diagnostic> warnings_;
  std::size_t errors_ = 0, missing_ = 0;
};

}  // namespace orrery::format
