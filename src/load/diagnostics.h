// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "base/error.h"
#include "load/overrides.h"

namespace orrery::load {

/// Name of the text that consists of all overrides, one per line.
inline constexpr const char* kOverrideName = "--set";

/// A range of characters in one line of a text.
///
/// Units      characters, not bytes, as in the TOML library
struct Place {
  std::string text_name;  ///< name of the text; empty: none
  int line = 0;           ///< 1-based; 0: none
  int column = 0;         ///< 1-based
  int width = 1;
};

/// The sources of a scene, the text of the file and the overrides, for quoting lines in diagnostics.
class SourceText {
 public:
  void set_file(const std::string& name, std::string_view text);

  /// Sets the number of lines at the beginning of the file that the user knows, if not all: a program wrote the others,
  /// and diagnostics omit their location.
  void set_typed_lines(std::optional<int> count) { typed_lines_ = count; }

  /// Makes the overrides the lines of kOverrideName.
  ///
  /// Domain     they exist as long as this
  void set_overrides(const Overrides& overrides) { overrides_ = &overrides; }

  /// Returns the option of a line of kOverrideName: "--set", "--samples".
  const std::string& option_at(int line) const { return (*overrides_)[static_cast<std::size_t>(line) - 1].option; }

  /// Returns a diagnostic with location and source line; for an override, that is the option: "--samples 0".
  base::Diagnostic diagnostic(base::Severity severity, const Place& place, std::string text,
                              std::string remedy = {}) const;

 private:
  std::string name_, text_;
  std::optional<int> typed_lines_;
  const Overrides* overrides_ = nullptr;
};

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
  ///            the first of add_missing(); else kBadData
  void raise_errors(const std::string& file) const;

 private:
  using Key = std::tuple<std::string, int, int>;

  std::multimap<Key, base::Diagnostic> shown_;
  std::vector<base::Diagnostic> warnings_;
  std::size_t errors_ = 0, missing_ = 0;
  std::optional<base::FileError> missing_file_;
};

/// State while a tree is read: its source text and the diagnostics so far.
struct ReadState {
  SourceText source;
  Diagnostics diagnostics;
  std::set<std::string> unread;  ///< full names of keys that kept their defaults because of an error

  void error(const Place& place, const std::string& text, const std::string& remedy = {},
             base::ErrorKind kind = base::ErrorKind::kBadData) {
    add(base::Severity::kError, place, text, remedy, kind);
  }
  void add(base::Severity severity, const Place& place, const std::string& text, const std::string& remedy = {},
           base::ErrorKind kind = base::ErrorKind::kBadData) {
    diagnostics.add(severity, place, kind, [&] { return source.diagnostic(severity, place, text, remedy); });
  }
};

}  // namespace orrery::load
