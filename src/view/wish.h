// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace orrery::view {

/// What a client wants to see.
struct Wish {
  /// Values of controls, by option: "--color-by"; several of one that is repeated, none of a flag.
  std::map<std::string, std::vector<std::string>> options = {};
  std::vector<std::string> camera = {};  ///< settings, KEY=VALUE; empty: the camera of the subject
  bool moves = false;                    ///< soon followed by another one: speed counts, not quality
  std::string client = {};               ///< the page that asks: each shows its own images
};

/// Reads a wish: a JSON object with `options`, `camera`, `moves` and `client`, each optional. The value of an option is
/// a string, a list of strings, or `true` for a flag; an empty string is no value. `camera` is a list of strings.
///
/// `is_control`  whether clients may set an option
/// Errors        base::Error(kUsage), for anything else
Wish read_wish(const std::string& json, const std::function<bool(const std::string& option)>& is_control);

/// The words of a command: the fixed ones, the controls, and the camera.
std::vector<std::string> words_of(const std::vector<std::string>& fixed, const Wish& wish);

}  // namespace orrery::view
