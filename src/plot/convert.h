// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/error.h"
#include "plot/data_frames.h"

namespace orrery::plot {

/// A file that convert() has written.
struct ConvertedFile {
  std::filesystem::path file;
  std::size_t spheres = 0;
  std::vector<std::string> columns;
  std::vector<std::string> notes;  ///< what was omitted, and why
  std::vector<base::Diagnostic> warnings;
};

struct ConvertOptions : DataOptions {
  std::filesystem::path output;  ///< .ply, .xyz, .npy or .csv; with a frame pattern if there are several frames
};

/// Writes the spheres of a data file: x, y, z, radius, then red, green, blue, then the other columns of their rows.
///
/// - Positions and radii are those of a plot: selected, unwrapped, replicated and sliced. A slice plane acts as in a
///   plot from the default view. Other columns keep the values of the file; copies of a particle have the same values.
/// - The radius is omitted if neither the file nor the options define it; it is not guessed.
/// - Colours are those of `color_by`, or the file's own: display-referred sRGB, uint8.
/// - The order is that of the particle ids, if the file has any.
///
/// `written`  called for each file
/// Errors     base::Error: those of points::load_points(), data::open() and data::write_table(); kUsage if an
///            output would replace an input, and for the wrong number of outputs
/// Cost       one read of all columns per frame; with several frames and a colour map without a range, two
void convert(const ConvertOptions& options, const std::function<void(const ConvertedFile&)>& written);

}  // namespace orrery::plot
