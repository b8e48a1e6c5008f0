// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

namespace orrery::format {

/// A key set from the command line, and the option that set it, which messages name.
struct Override {
  // NOLINTNEXTLINE(google-explicit-constructor): "camera.vfov=30" is an override
  Override(std::string key_and_value) : text(std::move(key_and_value)), typed(text) {}
  // NOLINTNEXTLINE(google-explicit-constructor)
  Override(const char* key_and_value) : Override(std::string(key_and_value)) {}

  /// An override from a dedicated option: `--samples 20` is Override("render.samples=20", "--samples", "20").
  ///
  /// Domain     `value` is a suffix of `key_and_value`, not counting a closing bracket
  Override(std::string key_and_value, std::string name, std::string value)
      : text(std::move(key_and_value)), option(std::move(name)), typed(std::move(value)) {}

  /// True if the override sets this key.
  bool sets(std::string_view key) const {
    const std::size_t begin = std::min(text.find_first_not_of(" \t"), text.size());
    const std::size_t end = text.find_first_not_of(" \t", begin + key.size());
    return text.compare(begin, key.size(), key) == 0 && end != std::string::npos && text[end] == '=';
  }

  std::string text;              ///< "camera.vfov=30"
  std::string option = "--set";  ///< option name as the user typed it
  std::string typed;             ///< the option's value
};

}  // namespace orrery::format
