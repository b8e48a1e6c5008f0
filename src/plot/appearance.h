// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "plot/data_frames.h"
#include "plot/plot.h"
#include "scene/scene.h"

namespace orrery::plot {

/// Chooses radius, bonds, arrows and colours of a plot where the user has not.
///
/// `data`     that the plot shows
/// `points`   in: the keys that the user has set; out: all of them
/// Result     the choices and their reasons, as they are printed
/// Errors     base::Error(kUsage) for options that exclude each other; those of DataFrames::load()
std::vector<std::string> choose_appearance(const PlotOptions& options, const DataFrames& data,
                                           scene::PointsKeys& points);

}  // namespace orrery::plot
