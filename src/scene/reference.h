// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace orrery::scene {

/// Tables of all keys with type, range, unit, default and cost, as Markdown: the part of docs/scene-format.md that the
/// schema knows. A test holds the two together.
std::string reference_markdown();

}  // namespace orrery::scene
