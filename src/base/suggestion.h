// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace orrery::base {

/// Returns the candidate closest to a misspelt word.
///
/// Result     the first of equally close candidates; empty if more than a third of the letters, or the only letter,
///            would have to change
/// Cost       number of candidates times the square of the word length
std::string closest(std::string_view wrong, const std::vector<std::string>& candidates);

/// Returns "did you mean `samples`?", or an empty string if no candidate is close.
std::string did_you_mean(std::string_view wrong, const std::vector<std::string>& candidates);

/// Joins names with commas: "a, b, c".
std::string joined(const std::vector<std::string>& names);

}  // namespace orrery::base
