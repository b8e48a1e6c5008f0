// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "display/settings.h"
#include "load/load_images.h"
#include "load/read_scene.h"
#include "points/load_points.h"
#include "scene/changed_parts.h"

namespace orrery::load {

/// A scene to load.
struct SceneRequest {
  SceneSource source;
  bool develops = false;                ///< true if display formats will be written
  std::uint64_t memory_limit = 0;       ///< bytes that an image may take; 0: the free memory
  bool skips_large_background = false;  ///< see ImageRequest::skips_large; also applies to textures
  bool keeps_authored = false;          ///< fill LoadedScene::authored, for a later load
  /// Called before data or images are read that replace those of an earlier load, so that their memory is released.
  std::function<void(const scene::Parts& changed)> on_change = {};
};

/// A scene that is ready to be compiled, and what was determined while loading it.
struct LoadedScene {
  ReadResult read;                        ///< colours are in the working space
  display::Settings display;              ///< of the images
  std::optional<display::Choice> choice;  ///< if `develops`, or if a colour name is set
  std::optional<LoadedMap> background;    ///< image background or sky; the scene refers to its image
  std::vector<LoadedTexture> textures;    ///< image textures; the scene refers to their images
  std::vector<base::Diagnostic> warnings;

  scene::Parts changed = scene::Parts::all();  ///< what differs from the previous load
  // For the next load.
  std::optional<scene::Scene> authored, authored_closing;  ///< the scene of the file, without spheres of points tables
  std::string data_version;                                ///< identifies the contents of all data files
  std::vector<scene::SceneDiagnostic> data_warnings, coincident;
  std::vector<std::vector<math::Vec3d>> palettes;  ///< of the points tables, not yet in the working space
};

/// Reads a scene with its textures and its image background or sky, checks everything that a render would reject, and
/// converts its colours to the working space. All commands load scenes here, so that they accept the same scenes.
///
/// Names in [color] are always looked up. A default config is loaded only if `develops`.
///
/// `previous`  an earlier load with keeps_authored, after which only what has changed is read: the result is the same,
///             except that points tables have no spheres unless `changed` contains geometry or assignment. Its images
///             move to the result
/// Errors     those of SceneReader, with unknown names in [color] among its diagnostics; base::Error: kMissingInput and
///            kBadData for the config in $OCIO
LoadedScene load_scene(const SceneRequest& request, std::optional<LoadedScene> previous = {});

/// Reads a scene file and its data files, but no images; colours are as in the file.
///
/// Errors     those of load_scene(), except those about images and names in [color]
ReadResult read_with_data(const SceneRequest& request);

/// Reads the data again from which the spheres of a points table were made.
///
/// `scene`    from load_scene(), with this source
/// Errors     those of points::load_points; base::Error(kBadData) if its spheres can no longer be made
points::SourceRows read_source_rows(const SceneSource& source, const scene::Scene& scene, std::size_t table);

/// Reduces the resolution of a scene to at most this many pixels with the same view, at both shutter times. Drops crop
/// and overscan.
///
/// Domain     pixels >= 1
void reduce_picture(ReadResult& scene, double pixels);

}  // namespace orrery::load
