// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <toml++/toml.h>

#include <string>
#include <string_view>
#include <vector>

#include "format/diagnostics.h"
#include "format/source_text.h"

namespace orrery::format {

/// Where a node or a key stands.
Place place_of(const toml::node& node);
Place place_of(const toml::key& key);

/// Adds a parse error of the library, in our own words.
void add_parse_error(const toml::parse_error& error, const SourceText& source, Diagnostics& diagnostics);

/// Parses the scene file's text and puts the overrides in; what cannot be parsed becomes diagnostics.
///
/// Result     the tree as far as there is one; nodes know their places, also those of overrides
toml::table parse_tree(const std::string& file_name, const std::string& text, const std::vector<Override>& overrides,
                       SourceText& source, Diagnostics& diagnostics);

}  // namespace orrery::format
