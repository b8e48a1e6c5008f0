// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <toml++/toml.h>

#include <string>
#include <string_view>
#include <vector>

#include "base/finding.h"
#include "format/source_text.h"

namespace orrery::format {

/// Where a node or a key stands.
Place place_of(const toml::node& node);
Place place_of(const toml::key& key);

/// A parse error of the library in our own words.
base::Finding parse_finding(const toml::parse_error& error, const SourceText& source);

/// Parses the scene file's text and puts the overrides in; what can't be parsed becomes findings.
///
/// Result     the tree as far as there is one; nodes know their places, also those of overrides
toml::table parse_tree(const std::string& file_name, const std::string& text, const std::vector<std::string>& overrides,
                       SourceText& source, std::vector<base::Finding>& findings);

}  // namespace orrery::format
