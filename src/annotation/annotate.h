// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "annotation/drawing.h"
#include "annotation/legend.h"
#include "display/settings.h"
#include "scene/scene.h"

namespace orrery::annotation {

/// The font of annotations and legends.
inline constexpr const char* kDefaultFont = "DejaVuSans";

/// An image to annotate.
struct View {
  int width = 0, height = 0;  ///< px
  int frame = 1;
  std::filesystem::path folder;  ///< of the scene, for the file of a font
  /// Projects a point of the scene to the image, px; none behind the camera.
  std::function<std::optional<std::pair<double, double>>(const Vec3d&)> project;
};

/// Replaces {EXPRESSION} and {EXPRESSION:.Nf}, with N decimals, in a title. Expressions may use `frame` and the
/// numbers of the frame's header, such as `step`.
///
/// Errors     base::Error(kBadData)
std::string title_of(const std::string& title, int frame, const scene::HeaderNumbers& header);

/// The title of a scene at a frame; empty: it has none.
///
/// Errors     base::Error(kBadData)
std::string title_of(const scene::Scene& scene, int frame);

/// The colours of a scene's first coloured points table; empty if there is no such table.
///
/// `ocio`     OCIO config, which defines the working space of the palettes
LegendColors legend_of(const scene::Scene& scene, const std::string& ocio);

/// Lays out the annotation of a scene at a frame.
///
/// `legend`   colours for the scene's colour bar; empty: it has none
/// Result     empty if the scene has no annotation
/// Errors     base::Error: those of title_of() and image::text_widths()
Drawing drawing_of(const scene::Scene& scene, const LegendColors& legend, const View& view);

/// The characters of all texts of a drawing for which its font has no glyphs.
std::string missing_glyphs(const Drawing& drawing);

/// Converts colours to what a display shows, 0..1.
///
/// Errors     those of display::develop
std::function<Vec3d(const Vec3d&)> shown_by(display::Settings display);

}  // namespace orrery::annotation
