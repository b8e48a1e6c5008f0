// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace orrery::base {

/// The candidate that somebody who typed `wrong` most likely meant.
///
/// Result     empty where none is near: more than a third of the letters, or the only one, would have to change; of
///            equally near ones the first
/// Cost       candidates x letters^2
std::string closest(std::string_view wrong, const std::vector<std::string>& candidates);

/// "did you mean `samples`?", or nothing.
std::string did_you_mean(std::string_view wrong, const std::vector<std::string>& candidates);

/// "a, b, c".
std::string joined(const std::vector<std::string>& names);

}  // namespace orrery::base
