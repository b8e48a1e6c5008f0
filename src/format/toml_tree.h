// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <toml++/toml.h>

#include <string>
#include <vector>

#include "base/finding.h"
#include "format/source_text.h"

namespace orrery::format {

/// The name of the text that all overrides together are, in the place of a file's name.
inline constexpr const char* kOverrideName = "--set";

/// Where a node or a key stands.
Place place_of(const toml::node& node);
Place place_of(const toml::key& key);

/// Parses the scene file's text and puts the overrides in; what can't be parsed becomes findings.
///
/// Result     the tree as far as there is one; nodes know their places, also those of overrides
toml::table parse_tree(const std::string& file_name, const std::string& text, const std::vector<std::string>& overrides,
                       SourceText& source, std::vector<base::Finding>& findings);

}  // namespace orrery::format
