// SPDX-License-Identifier: Apache-2.0
#include "load/diagnostics.h"

#include <fmt/core.h>

#include "base/text.h"

namespace orrery::load {
namespace {

/// Maximum length of a quoted line, bytes: a line that wraps ten times is not helpful.
constexpr std::size_t kLongestShown = 400;

/// Returns the 0-based byte index of the `index`-th character; beyond the end if the line has fewer characters.
std::size_t byte_of_character(std::string_view line, std::size_t index) {
  std::size_t at = 0;
  for (; at < line.size(); ++at) {
    if (!base::continues_character(line[at]) && index-- == 0) return at;
  }
  return at + index;
}

/// Returns a line, counted from 1, without its end; empty if there is no such line.
std::string_view line_of(std::string_view text, int line) {
  for (int i = 1; i < line; ++i) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) return {};
    text.remove_prefix(end + 1);
  }
  std::string_view out = text.substr(0, text.find('\n'));
  if (out.ends_with('\r')) out.remove_suffix(1);
  return out;
}

}  // namespace

void SourceText::set_file(const std::string& name, std::string_view text) {
  name_ = name;
  text_ = text;
}

base::Diagnostic SourceText::diagnostic(base::Severity severity, const Place& place, std::string text,
                                        std::string remedy) const {
  base::Diagnostic out = base::file_diagnostic(severity, place.text_name, std::move(text), std::move(remedy));
  if (place.text_name == kOverrideName && overrides_ != nullptr && place.line >= 1 &&
      static_cast<std::size_t>(place.line) <= overrides_->size()) {
    const Override& override = (*overrides_)[static_cast<std::size_t>(place.line) - 1];
    out.file = override.option;
    if (override.typed.size() > kLongestShown) return out;
    out.source_line = fmt::format("{} {}", override.option, override.typed);
    out.column = static_cast<int>(override.option.size()) + 2;
    out.width = static_cast<int>(override.typed.size());
    return out;
  }
  out.line = place.line;
  out.column = place.column;
  out.width = place.width;
  if (place.text_name != name_) return out;
  if (place.line > typed_lines_.value_or(place.line)) {
    out.line = out.column = 0;
    return out;
  }
  if (place.line < 1 || place.column < 1) return out;
  const std::string_view line = line_of(text_, place.line);
  const auto begin = static_cast<std::size_t>(place.column) - 1;
  const std::size_t first = byte_of_character(line, begin);
  out.column = static_cast<int>(first) + 1;
  out.width = static_cast<int>(byte_of_character(line, begin + static_cast<std::size_t>(place.width)) - first);
  if (line.size() <= kLongestShown) out.source_line = line;
  return out;
}

void Diagnostics::raise_errors(const std::string& file) const {
  if (errors_ == 0) return;
  std::vector<base::Diagnostic> diagnostics;
  for (const auto& [key, diagnostic] : shown_) diagnostics.push_back(diagnostic);
  if (errors_ > shown_.size())
    diagnostics.push_back(base::file_diagnostic(
        base::Severity::kError, file, fmt::format("and {} more ({} in all)", errors_ - shown_.size(), errors_)));
  const std::string message = fmt::format("{}: {}", file, base::counted(errors_, "error"));
  const bool all_missing = missing_ == errors_;
  if (all_missing && missing_file_)
    throw base::FileError(base::ErrorKind::kMissingInput, message, missing_file_->file(), missing_file_->number(),
                          std::move(diagnostics));
  throw base::Error(all_missing ? base::ErrorKind::kMissingInput : base::ErrorKind::kBadData, message,
                    std::move(diagnostics));
}

}  // namespace orrery::load
