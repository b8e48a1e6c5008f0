// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "annotation/legend.h"
#include "load/overrides.h"
#include "plot/data_frames.h"
#include "points/rules.h"

/// Makes a scene for a data file: settings that the user did not choose are chosen from the data, and reported.
namespace orrery::plot {

enum class Style { kStudio, kSoft, kFlat, kNight, kAmbient, kIllustration };

/// How little noise an image has, and how long it takes.
enum class Quality { kDraft, kGood, kFinal };

using points::Representation;
using points::representation_names;

/// Names of the styles and of the qualities, in the order of the enumerators.
const std::vector<std::string>& style_names();
const std::vector<std::string>& quality_names();

/// Materials of the spheres, by name.
const std::vector<std::string>& material_names();

/// The style or quality with one of these names; none for an empty name.
std::optional<Style> style_of(const std::string& name);
std::optional<Quality> quality_of(const std::string& name);

struct PlotOptions : DataOptions {
  std::string look_from;           ///< "auto", or as view_axes() takes it; empty: depends on the data
  std::string up;                  ///< "x", "y" or "z"; empty: depends on the format
  std::optional<double> vfov_deg;  ///< vertical field of view of a perspective camera; none: orthographic
  double zoom = 1;                 ///< magnification, relative to the camera that sees all
  std::string fit;                 ///< condition: the camera sees the particles that match; empty: all
  /// Particles further in front of, or behind, those of `fit` or `center` are removed; scene units.
  std::optional<double> near, far;
  std::string center;                     ///< condition: the camera looks at the middle of the particles that match
  std::optional<Style> style;             ///< default: kStudio
  std::optional<Quality> quality;         ///< default: kGood
  std::optional<math::Vec3d> background;  ///< colour behind the spheres, linear Rec.709; default: that of the style
  bool transparent = false;               ///< the background is transparent
  bool exact_colors = false;              ///< no tone mapping
  std::optional<double> depth_cue;        ///< 0..1; default: see kDepthCue
  double shutter = 0;                     ///< time that the shutter is open, frames; 0: no motion blur
  /// Column whose values divide the outlines, see scene::Annotation::outline_objects; empty: they are not divided.
  std::string outline_by;
  /// Of all particles, one of material_names(); empty: plastic with rods, else matte. Those of some are in `points`.
  std::string material;
  /// Of all particles; none: spheres, or a trace if all atoms are C-alpha or phosphorus atoms. Those of some particles
  /// are in `points`.
  std::optional<Representation> representation;
  std::optional<bool> bonds;  ///< draws bonds by the keys in `points.bonds`; default: unless kSpheres
  bool ground = false;
  /// Text and lines over the image. A scale bar of length 0 has a length that suits the view.
  scene::Annotation annotation;
  bool box = false;                  ///< draws the edges of the simulation box
  bool axes = false;                 ///< draws the directions of x, y and z
  bool allow_empty = false;          ///< a selection or a slice may leave nothing
  bool has_target = false;           ///< the user limits noise or time
  bool develops = false;             ///< an image has a display format
  std::filesystem::path scene_file;  ///< paths in the scene, and the OCIO config, are relative to its folder
  /// Keys that the user has set. They are not part of the scene's text, but size, camera and display view follow them.
  load::Overrides overrides;
};

/// Depth cue of molecules.
inline constexpr double kDepthCue = 0.35;

/// The view that reproduces the colours of the colour map, and the one that compresses bright colours, if the OCIO
/// config defines them.
inline constexpr const char *kPlainView = "Un-tone-mapped", *kNeutralView = "Neutral";

struct PlotScene {
  std::string text;                  ///< the scene file
  std::vector<std::string> choices;  ///< "radius 0.53: half the median distance to the nearest neighbour"
  std::vector<std::string> warnings;
  std::vector<int> frames;  ///< frames to render; empty: one still image
  scene::PointsKeys points;
  annotation::LegendColors legend;
  std::string view;                  ///< view of the display
  std::string material;              ///< of the spheres
  math::Vec3d up;                    ///< the up axis
  data::FrameInfo data;              ///< what the first frame contains, including derived columns
  std::optional<int> frame_count;    ///< of the file; empty: unknown, since counting would read it
  std::optional<double> noise = {};  ///< target noise, unless the user limits samples, noise or time
  bool denoise = false;              ///< the quality is that of denoised images
  points::OpenData open_data;  ///< opens the data file for the render without reading it again; empty with `loaded`
  std::shared_ptr<points::LoadedPoints> loaded;  ///< the spheres of a still image, if they are those of the scene
};

/// Reads the data and writes a scene for it.
///
/// `check`    called with PlotScene::frames before the frames are read, so that an invalid request fails early; of all
///            frames of a file with the first two, and with all of them if that throws
/// Errors     base::Error: those of points::load_points() and data::open(); kBadData with its errors, and if a
///            selection or a slice leaves nothing; kUsage for an invalid view, and for options without effect; those of
///            `check`
/// Cost       reads every frame once, to fit the camera and the colour map; several frames again for a turntable and
/// for
///            PlotOptions::center
PlotScene make_plot(const PlotOptions& options, const std::function<void(const std::vector<int>& frames)>& check = {});

}  // namespace orrery::plot
