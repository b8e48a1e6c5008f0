// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "data/table.h"

/// The columns that the options of a plot name.
namespace orrery::plot {

struct PlotOptions;

/// The column that divides the outlines; empty: none does.
std::string outline_column(const PlotOptions& options, const data::FrameInfo& info);

/// The columns, conditions and expressions that the options have.
std::vector<std::string> texts_with_columns(const PlotOptions& options, const data::FrameInfo& info);

/// The columns of a frame that a plot may read: those with a role, and those that an option names. One too many costs
/// memory, one too few another pass over the file.
std::vector<std::string> expected_columns(const PlotOptions& options, data::FrameInfo info);

/// Refuses the name of a file or a column that is not UTF-8: scenes are TOML, which is.
void require_utf8(const std::string& text);

}  // namespace orrery::plot
