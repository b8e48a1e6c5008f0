// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "display/settings.h"
#include "load/load_scene.h"

/// Settings of a plot that scene keys override, read before there is a scene.
namespace orrery::plot {

struct PlotOptions;
struct PlotScene;

/// A side of the image, which the camera must know. An invalid one is reported when the scene is read.
int side_of(const load::Overrides& overrides, const char* key, int otherwise);

/// The vertical field of view of a perspective camera, which overrides can also select, by a field of view alone. An
/// invalid one is reported when the scene is read.
std::optional<double> vfov_of(const PlotOptions& options);

/// The display transform that the user has set.
display::Settings display_of(const PlotOptions& options);

/// A provisional scene with only the overrides of tables that every scene has, validated.
///
/// `develops` see load::SceneRequest
load::LoadedScene settings_scene(const PlotOptions& options, bool develops);

/// The display transform of a plot's legend.
///
/// Errors     those of settings_scene()
display::Settings legend_display(const PlotOptions& options, const PlotScene& made);

/// The scene with the overrides applied, so that rendering it does not need them again.
std::string saved_text(const PlotOptions& options, const PlotScene& made);

}  // namespace orrery::plot
