// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "display/settings.h"
#include "plot/data_options.h"
#include "plot/write_legend.h"
#include "scene/scene.h"

/// Makes a scene for a data file: settings that the user did not choose are chosen from the data, and reported.
namespace orrery::plot {

enum class Style { kStudio, kAmbient, kFlat, kNight };

struct PlotOptions : DataOptions {
  std::string look_from = "iso";  ///< "iso", "+x" .. "-z", or "azimuth,elevation" in degrees
  std::string up;                 ///< "x", "y" or "z"; empty: depends on the format
  Style style = Style::kStudio;
  bool has_style = false;  ///< the user set `style`
  bool ground = false;
  int width = 1920, height = 1080;  ///< px
  display::Settings display;        ///< display transform of the images; an empty view is chosen
  bool has_size = false;            ///< the user set `width` or `height`
  std::optional<double> vfov = {};  ///< degrees: a perspective camera; default: orthographic
  bool is_turntable = false;        ///< the camera orbits around the up axis
  bool allow_empty = false;         ///< a selection or a slice may leave nothing
};

/// The view that reproduces the colours of the colour map, if the OCIO config defines it.
inline constexpr const char* kPlainView = "Un-tone-mapped";

struct PlotScene {
  std::string text;                  ///< the scene file
  std::vector<std::string> choices;  ///< "radius 0.53: half the median distance to the nearest neighbour"
  std::vector<std::string> warnings;
  std::vector<int> frames;  ///< frames to render; empty: one still image
  scene::Points points;     ///< keys of the scene's points
  LegendColors legend;
  std::string view;  ///< view of the display
};

/// Reads the data and writes a scene for it.
///
/// `folder`   folder of the scene file; paths in the scene are relative to it
/// `check`    called with PlotScene::frames before any row is read, so that an invalid request fails early
/// Errors     base::Error: those of points::load_points() and particles::open(); kBadData with its errors, and if a
///            selection or a slice leaves nothing; kUsage for an invalid view, and for options without effect; those of
///            `check`
/// Cost       reads every frame once, to fit the camera and the colour map; twice for a turntable
PlotScene make_plot(const PlotOptions& options, const std::filesystem::path& folder,
                    const std::function<void(const std::vector<int>& frames)>& check = {});

}  // namespace orrery::plot
