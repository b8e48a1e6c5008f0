// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <toml++/toml.h>

#include <string>
#include <string_view>
#include <vector>

#include "format/diagnostics.h"
#include "format/source_text.h"

namespace orrery::format {

/// Returns the location of a node or a key.
Place place_of(const toml::node& node);
Place place_of(const toml::key& key);

/// Adds a parse error of the TOML library as a diagnostic.
void add_parse_error(const toml::parse_error& error, const SourceText& source, Diagnostics& diagnostics);

/// Parses the text of a scene file and applies the overrides; failures are added to `diagnostics`.
///
/// Result     the tree, empty if the text is invalid; nodes have their locations, including those in overrides
toml::table parse_tree(const std::string& file_name, const std::string& text, const std::vector<Override>& overrides,
                       SourceText& source, Diagnostics& diagnostics);

}  // namespace orrery::format
