// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace orrery::scene {

/// Returns the "Keys" section of docs/scene-format.md: Markdown tables of all keys with type, range, unit, default and
/// cost, generated from the schema. A test compares the two.
std::string reference_markdown();

}  // namespace orrery::scene
