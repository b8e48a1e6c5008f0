// SPDX-License-Identifier: Apache-2.0
#include "format/toml_tree.h"

#include <fmt/core.h>

#include "format/key_depth.h"
#include "format/overrides.h"

namespace orrery::format {
namespace {

Place place_of_region(const toml::source_region& region) {
  Place place;
  if (region.path) place.text_name = *region.path;
  place.line = static_cast<int>(region.begin.line);
  place.column = static_cast<int>(region.begin.column);
  if (region.end.line == region.begin.line && region.end.column > region.begin.column)
    place.width = static_cast<int>(region.end.column - region.begin.column);
  return place;
}

}  // namespace

Place place_of(const toml::node& node) { return place_of_region(node.source()); }
Place place_of(const toml::key& key) { return place_of_region(key.source()); }

void add_parse_error(const toml::parse_error& error, const SourceText& source, Diagnostics& diagnostics) {
  Place place = place_of_region(error.source());
  place.width = 1;
  std::string text(error.description());
  constexpr std::string_view kPreface = "Error while parsing ";
  if (text.rfind(kPreface, 0) == 0) text.erase(0, kPreface.size());
  std::string remedy;
  if (const std::size_t at = text.find("cannot redefine existing"); at != std::string::npos) {
    text = "duplicate: " + text.substr(at);
    remedy = "remove one of them";
  }
  diagnostics.add(base::Severity::kError, place, base::ErrorKind::kBadData,
                  [&] { return source.diagnostic(base::Severity::kError, place, text, remedy); });
}

toml::table parse_tree(const std::string& file_name, const std::string& text, const std::vector<Override>& overrides,
                       SourceText& source, Diagnostics& diagnostics) {
  source.add(file_name, text);
  if (Place place = too_deep_key(text); place.line > 0) {
    place.text_name = file_name;
    diagnostics.add(base::Severity::kError, place, base::ErrorKind::kBadData, [&] {
      return source.diagnostic(base::Severity::kError, place,
                               fmt::format("the key has more than {} parts", kDeepestKey));
    });
    return {};
  }
  toml::table root;
  try {
    root = toml::parse(std::string_view(text), std::string_view(file_name));
  } catch (const toml::parse_error& error) {
    add_parse_error(error, source, diagnostics);
    return {};
  }
  apply_overrides(root, overrides, source, diagnostics);
  return root;
}

}  // namespace orrery::format
