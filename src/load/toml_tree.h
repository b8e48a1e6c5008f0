// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <toml++/toml.h>

#include <string>
#include <string_view>
#include <vector>

#include "load/diagnostics.h"

namespace orrery::load {

/// Returns the location of a node or a key.
Place place_of(const toml::node& node);
Place place_of(const toml::key& key);

/// A key with its value, and its place in the file or among the overrides.
struct Entry {
  const toml::key* key;
  const toml::node* value;
  bool is_override;
  int line, column;
};

/// The entries of a table in the order of the file, then those of overrides; the library sorts them by name.
std::vector<Entry> in_order(const toml::table& table);

/// Returns a key, quoted if necessary, and a value on one line, as in a scene file.
std::string toml_text(const toml::key& key);
std::string toml_text(const toml::node& node);

/// Returns a parse error of the TOML library in our words.
Override::Fault fault_of(const toml::parse_error& error);

/// Maximum number of dots in a row without a delimiter of keys; scenes need two, and texts have fewer than this. The
/// TOML library creates a table for each part of a dotted key and destroys tables recursively, so that a key of ten
/// thousand parts would overflow the stack.
inline constexpr int kDeepestKey = 1000;

/// Finds the first key with more than kDeepestKey parts in a TOML text.
///
/// Result     location of the first excess dot; line 0 if there is no such key; text_name is not set
Place too_deep_key(std::string_view text);

/// Parses the text of a scene file and applies the overrides; failures are added to `state`.
///
/// Overrides are merged into the tables of the file; missing tables are created, list elements must exist.
///
/// Domain     `overrides` exists as long as `state`
/// Result     the tree, empty if the text is invalid; nodes have their locations, including those in overrides
toml::table parse_tree(const std::string& file_name, const std::string& text, const Overrides& overrides,
                       ReadState& state);

}  // namespace orrery::load
