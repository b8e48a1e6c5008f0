// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "math/vec3.h"
#include "scene/accelerator.h"

/// The scene as its author wrote it: named things, the author's units, nothing compiled.
///
/// The values given to members here are the documented defaults of docs/scene-format.md, and stand nowhere else.
namespace orrery::scene {

using math::Vec3d;

/// A rectangle of pixels.
struct Window {
  int x = 0, y = 0;  ///< px, upper left corner; 0, 0 is that of the frame
  int width = 0, height = 0;
};

struct Image {
  int width = 1200;                 ///< px, of the frame
  int height = 675;                 ///< px
  double pixel_aspect = 1;          ///< a pixel's width by its height
  std::optional<Window> crop = {};  ///< what is rendered of the frame; default: all
  int overscan = 0;                 ///< px beyond each edge of the frame that are rendered, too

  /// What is rendered.
  Window data_window() const {
    return crop ? *crop : Window{-overscan, -overscan, width + 2 * overscan, height + 2 * overscan};
  }
};

struct Camera {
  Vec3d look_from{0, 0, 0};
  Vec3d look_at{0, 0, -1};
  Vec3d up{0, 1, 0};
  double vfov = 90;                      ///< degrees, vertical
  double defocus_angle = 0;              ///< degrees, apex angle of the cone at the focus plane; 0 = pinhole
  std::optional<double> focus_distance;  ///< scene units; default: distance from look_from to look_at
  double shutter_open = 0;               ///< frames, from the frame's own time
  double shutter_close = 0;              ///< frames; not before shutter_open; the same: nothing is blurred
};

enum class BackgroundType { kGradient, kConstant };

struct Background {
  BackgroundType type = BackgroundType::kGradient;
  Vec3d bottom{1, 1, 1};   ///< gradient: looking straight down
  Vec3d top{0.5, 0.7, 1};  ///< gradient: looking straight up
  Vec3d color{1, 1, 1};    ///< constant
  int alpha = 1;           ///< 0: where only the background is seen, the picture is empty
};

enum class Precision { kExact, kFast, kBook };
enum class Shading { kPath, kNormal, kFlat };
enum class Sampler { kIndependent, kSobol, kBlueNoise };
enum class Filter { kBox, kGaussian, kBlackmanHarris, kMitchell };

struct Render {
  int samples = 100;   ///< per pixel
  int max_depth = 50;  ///< rays of a path, the camera ray included
  std::uint32_t seed = 1;
  Precision precision = Precision::kExact;
  Shading shading = Shading::kPath;
  Accelerator accelerator = Accelerator::kEmbree;
  Filter filter = Filter::kBox;
  std::optional<double> filter_width = {};  ///< px, from end to end; default: 1, 3, 3 or 4, by filter
  int roulette_depth = 3;                   ///< scattering events before Russian roulette begins; 0: never
  Sampler sampler = Sampler::kSobol;
};

struct Lambertian {
  Vec3d albedo{0.5, 0.5, 0.5};
};
/// The book's first diffuse: directions uniform over the hemisphere, weighted by the albedo alone.
struct Hemisphere {
  Vec3d albedo{0.5, 0.5, 0.5};
};
struct Metal {
  Vec3d albedo{0.5, 0.5, 0.5};
  double fuzz = 0;  ///< 0..1, radius of the sphere around the tip of the unit mirror direction
};
enum class Fresnel { kSchlick, kExact, kNone };
struct Dielectric {
  double ior = 1.5;
  Fresnel fresnel = Fresnel::kSchlick;
};

using MaterialModel = std::variant<Lambertian, Hemisphere, Metal, Dielectric>;

struct Material {
  std::string name;
  MaterialModel model;
};

struct Sphere {
  Vec3d center;
  double radius = 1;           ///< negative: inward normal (hollow glass)
  std::uint32_t material = 0;  ///< index into Scene::materials
  std::string name = {};       ///< optional, for mattes
  std::string group = {};      ///< optional, for mattes: spheres of one name are one thing
};

/// Spheres from a data file: flat arrays, since there may be ten million. Filled by format::read.
struct Points {
  std::filesystem::path file;    ///< as written in the scene, relative to the scene file
  std::uint32_t material = 0;    ///< index into Scene::materials; where the file has none of its own
  std::string name = {};         ///< optional, for mattes: all of them are one thing; default: the file's name
  std::string group = {};        ///< optional, for mattes
  std::optional<double> radius;  ///< of every point, whatever the file says; default: the file's
  std::vector<Vec3d> centers;
  std::vector<double> radii;             ///< as many as centers
  std::vector<std::uint32_t> materials;  ///< as many as centers, or empty: `material` for all
  std::vector<std::string> unused = {};  ///< properties of the file's vertices that nothing uses, such as colours
};

/// What files hold beside the beauty.
struct Output {
  std::vector<std::string> layers;  ///< names out of the schema's choices
};

/// Colours of the scene file, of the picture made of it, and of what a display shows of that.
struct Color {
  std::string space = "lin_rec709";
  std::string working;              ///< of light and of the picture; empty: `space`
  std::filesystem::path config;     ///< of OCIO, relative to the scene file; empty: $OCIO, without it the built-in one
  std::string display, view, look;  ///< names of the config; empty: its defaults, and no look
  double exposure = 0;              ///< stops

  const std::string& working_space() const { return working.empty() ? space : working; }
};

enum class Interpolation { kLinear, kCubic, kHold };

/// A number that changes from frame to frame: what it is at some of them, its keys, and how it goes between.
struct Track {
  std::string target;  ///< "camera.look_from", "sphere[3].radius"; what scene::find_animated finds
  Interpolation interpolation = Interpolation::kLinear;
  std::vector<double> frames;  ///< ascending
  std::vector<Vec3d> values;   ///< one for each frame; of a single number x
};

struct Animation {
  double fps = 24;       ///< frames per second
  double turntable = 0;  ///< frames in which the camera turns once around look_at, about up; 0: it stands
};

struct Scene {
  Image image;
  Camera camera;
  Background background;
  Render render;
  Color color;
  Output output;
  Animation animation;
  std::vector<Track> tracks;
  std::vector<Material> materials;
  std::vector<Sphere> spheres;
  std::vector<Points> points;

  /// Of tables and of points files.
  std::size_t sphere_count() const {
    std::size_t count = spheres.size();
    for (const Points& p : points) count += p.centers.size();
    return count;
  }
};

}  // namespace orrery::scene
