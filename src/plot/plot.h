// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "display/develop.h"
#include "plot/data_options.h"
#include "plot/write_legend.h"
#include "scene/scene.h"

/// A scene for a data file: what the user did not choose is chosen from the data, and every choice is reported.
namespace orrery::plot {

enum class Style { kStudio, kFlat, kNight };

struct PlotOptions : DataOptions {
  std::string look_from = "iso";  ///< "iso", "+x" .. "-z", or "azimuth,elevation" in degrees
  std::string up;                 ///< "x", "y" or "z"; empty: by the format
  Style style = Style::kStudio;
  bool ground = false;
  int width = 1920, height = 1080;  ///< px
  display::Settings display;        ///< of the images; an empty view is chosen
};

struct PlotScene {
  std::string text;                  ///< the scene file
  std::vector<std::string> choices;  ///< "radius 0.53: half the median distance to the nearest neighbour"
  std::vector<std::string> warnings;
  std::vector<int> frames;  ///< to render; empty: one still image
  scene::Points points;     ///< keys of the scene's points
  LegendColors legend;
  std::string view;  ///< of the display
};

/// Reads the data and writes a scene for it.
///
/// `folder`   of the scene file; paths in the scene are relative to it
/// Errors     base::Error: those of points::load_points() and data::open(); kBadData with its errors; kUsage for an
///            invalid view
/// Cost       reads every frame once, to fit the camera and the colour map
PlotScene make_plot(const PlotOptions& options, const std::filesystem::path& folder);

}  // namespace orrery::plot
