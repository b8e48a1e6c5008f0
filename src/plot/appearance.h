// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "plot/data_frames.h"

namespace orrery::plot {

struct PlotOptions;

/// Chooses radius, bonds, arrows and colours of a plot where the user has not.
///
/// `data`     that the plot shows
/// `points`   in: the keys that the user has set; out: all of them
/// Result     the choices and their reasons, as they are printed
/// Errors     base::Error(kUsage) for options that exclude each other; those of DataFrames::load()
std::vector<std::string> choose_appearance(const PlotOptions& options, const DataFrames& data,
                                           scene::PointsKeys& points);

/// Whether a plot shows the unit cell of a crystal in the customary way, since the user has chosen no representation:
/// as a ball-and-stick model in the edges of the cell, with its axes.
bool shows_cell(const PlotOptions& options, const data::FrameInfo& info);

/// Sets the colour keys that `color_by` selects, with the names of DataOptions::color_by.
///
/// Result     true if the user chose no colour map, so that this function chose one
/// Errors     base::Error(kUsage) if the user set a map or a range that would have no effect
bool set_color(const DataOptions& options, const std::string& color_by, const data::FrameInfo& info,
               scene::PointsColor& color);

}  // namespace orrery::plot
