// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "math/vec3.h"
#include "scene/number_array.h"

/// The authored scene: names, user units, nothing compiled.
///
/// The member initialisers are the defaults documented in docs/scene-format.md, and their only definition.
namespace orrery::scene {

class LatLongMap;
struct Texture;

/// A texture that replaces a constant of a material; null: the constant. Shared by copies of the scene, and never
/// modified.
using TextureSlot = std::shared_ptr<const Texture>;

/// A rectangle of pixels.
struct Window {
  int x = 0, y = 0;  ///< px, upper left corner, relative to that of the frame
  int width = 0, height = 0;
};

struct Image {
  int width = 1200;                 ///< px, frame width
  int height = 675;                 ///< px, frame height
  double pixel_aspect = 1;          ///< pixel width divided by pixel height
  std::optional<Window> crop = {};  ///< rendered window; default: the whole frame
  int overscan = 0;                 ///< px rendered beyond each edge of the frame
  double dpi = 0;                   ///< px per inch in print; 0: not known

  /// Returns the rendered window.
  Window data_window() const {
    return crop ? *crop : Window{-overscan, -overscan, width + 2 * overscan, height + 2 * overscan};
  }
};

/// An interval of numbers.
struct Interval {
  double low = 0, high = 1;
  bool operator==(const Interval&) const = default;
};

enum class Projection { kPerspective, kOrthographic };

struct Camera {
  Vec3d look_from{0, 0, 0};
  Vec3d look_at{0, 0, -1};
  Vec3d up{0, 1, 0};
  double vfov = 90;          ///< perspective: vertical field of view, degrees
  double defocus_angle = 0;  ///< degrees, apex angle of the cone from a point in focus to the lens; 0: pinhole
  std::optional<double> focus_distance;  ///< scene units; default: distance from look_from to look_at
  double shutter_open = 0;               ///< frames, relative to the frame
  double shutter_close = 0;              ///< frames, relative to the frame; equal to shutter_open: no motion blur
  Projection projection = Projection::kPerspective;
  std::optional<double> width = {};  ///< orthographic: scene units, width of the frame
  double depth_cue = 0;              ///< 0..1, share of the background in the colours of what is farthest away
  std::optional<Interval> depth_cue_range = {};  ///< scene units along the view axis; default: that of the data
};

enum class BackgroundType { kGradient, kConstant, kImage, kSky };

struct Background {
  BackgroundType type = BackgroundType::kGradient;
  Vec3d bottom{1, 1, 1};               ///< gradient: radiance from straight below
  Vec3d top{0.5, 0.7, 1};              ///< gradient: radiance from straight above
  Vec3d up{0, 1, 0};                   ///< gradient: the direction above
  Vec3d color{1, 1, 1};                ///< constant: radiance
  int alpha = 1;                       ///< 0: the background is transparent
  std::optional<Vec3d> backdrop = {};  ///< radiance that camera rays see in its place; default: they see it
  // Image and sky.
  std::shared_ptr<const LatLongMap> image = {};  ///< the texels of `file`, or the baked sky; null until loaded
  std::filesystem::path file = {};               ///< image: latitude-longitude map, relative to the scene file
  std::string color_space = {};                  ///< image; empty: from the file's metadata, else the scene's
  double rotation = 0;                           ///< degrees about +y
  double exposure = 0;                           ///< stops
  std::string light_group = {};                  ///< empty: the default group
  bool visible = true;                           ///< visible to the camera; scattered rays always see the background
  double sun_elevation = 45;                     ///< sky: degrees above the horizon
  double sun_azimuth = 0;                        ///< sky: degrees from +z towards +x
  double turbidity = 2;                          ///< sky: amount of haze; 1 is pure air
  Vec3d ground_albedo{0.2, 0.2, 0.2};
  bool sun = true;  ///< sky: includes the sun's disc
};

/// The data structure that finds the closest sphere along a ray. The image does not depend on it.
enum class Accelerator {
  kEmbree,  ///< a BVH
  kList,    ///< a loop over all spheres
};

/// Order in which rays traverse Embree's BVH. The image does not depend on it.
enum class Traversal {
  kAuto,    ///< the fastest for each kind of rays
  kPacket,  ///< 16 rays together
  kSingle,  ///< one ray after the other
};

enum class Precision { kExact, kFast, kBook };
enum class Shading { kPath, kNormal, kFlat };
enum class Sampler { kIndependent, kSobol, kBlueNoise };
enum class DirectLighting { kMis, kBsdf, kLight };
enum class Filter { kBox, kGaussian, kBlackmanHarris };

struct Render {
  int samples = 100;   ///< per pixel
  int max_depth = 50;  ///< rays per path, including the camera ray
  std::uint32_t seed = 1;
  Precision precision = Precision::kExact;
  Shading shading = Shading::kPath;
  Accelerator accelerator = Accelerator::kEmbree;
  Traversal traversal = Traversal::kAuto;
  Filter filter = Filter::kBox;
  std::optional<double> filter_width = {};  ///< full width, px; default: 1, 3, 3 or 4, depending on the filter
  int roulette_depth = 3;                   ///< scattering events before Russian roulette begins; 0: off
  Sampler sampler = Sampler::kSobol;
  DirectLighting direct_lighting = DirectLighting::kMis;
  bool caustics = true;  ///< sample light by way of mirror balls and glass balls
};

struct Lambertian {
  Vec3d albedo{0.5, 0.5, 0.5};
  TextureSlot albedo_texture = {};
  double opacity = 1;  ///< 0..1, probability that an object of this material is visible to a ray
};
/// The book's first diffuse material: directions uniform over the hemisphere, weighted by the albedo alone.
struct Hemisphere {
  Vec3d albedo{0.5, 0.5, 0.5};
  TextureSlot albedo_texture = {};
  double opacity = 1;  ///< as of Lambertian
};
struct Metal {
  Vec3d albedo{0.5, 0.5, 0.5};
  double fuzz = 0;  ///< 0..1, radius of the sphere around the tip of the unit mirror direction
  TextureSlot albedo_texture = {};
  TextureSlot fuzz_texture = {};
  double opacity = 1;  ///< as of Lambertian
};
enum class Fresnel { kSchlick, kExact, kNone };
struct Dielectric {
  double ior = 1.5;
  Fresnel fresnel = Fresnel::kSchlick;
  double fuzz = 0;  ///< 0..1, radius of the sphere around the tip of the unit direction of clear glass
  TextureSlot fuzz_texture = {};
};

/// A dielectric coat over a diffuse base.
struct Plastic {
  Vec3d albedo{0.5, 0.5, 0.5};  ///< of the base
  double ior = 1.5;             ///< of the coat
  double fuzz = 0.2;            ///< 0..1, roughness of the coat
  TextureSlot albedo_texture = {};
  TextureSlot fuzz_texture = {};
  double opacity = 1;  ///< as of Lambertian
};

/// Emits the same radiance in all directions, on both sides, and reflects nothing.
struct Emitter {
  Vec3d radiance{1, 1, 1};
  double exposure = 0;           ///< stops
  std::string light_group = {};  ///< empty: the default group
  TextureSlot radiance_texture = {};
  double opacity = 1;  ///< as of Lambertian
};

using MaterialModel = std::variant<Lambertian, Hemisphere, Metal, Dielectric, Emitter, Plastic>;

/// The opacity of a material. Dielectrics have none, which counts as 1.
inline double opacity_of(const MaterialModel& model) {
  return std::visit(
      [](const auto& m) {
        if constexpr (requires { m.opacity; }) return m.opacity;
        return 1.0;
      },
      model);
}

struct Material {
  std::string name;
  MaterialModel model;
};

struct Sphere {
  Vec3d center;
  double radius = 1;           ///< negative: normal points inward (hollow glass)
  std::uint32_t material = 0;  ///< index into Scene::materials
  std::string name = {};       ///< optional, for mattes
  std::string group = {};      ///< optional, for mattes: all objects of a group are one matte
  bool is_page = false;        ///< the camera sees it as a part of the backdrop, on which shadows fall
};

/// A sphere swept along a segment. It transmits no light.
struct Rod {
  Vec3d from, to;     ///< ends of the segment; if they are equal, a sphere
  double radius = 1;  ///< > 0
  /// Of the half at `from` and of that at `to`: indices into Scene::materials.
  std::array<std::uint32_t, 2> materials = {0, 0};
  std::string name = {};   ///< optional, for mattes
  std::string group = {};  ///< optional, for mattes
};

/// Numbers or colours by particle type, in the order of the types' names.
using NumbersByType = std::vector<std::pair<std::string, double>>;
using ColorsByType = std::vector<std::pair<std::string, Vec3d>>;

/// Radii of the spheres of a points file, set by one of `value`, `column`, `element` and `types`; if none is set, those
/// in the file.
struct PointsRadius {
  std::optional<double> value;     ///< radius of every sphere, scene units
  std::string column;              ///< name of a column
  std::string element;             ///< "vdw", "covalent" or "ball"
  NumbersByType types;             ///< scene units
  double scale = 1;                ///< multiplies column and element radii
  std::vector<std::string> where;  ///< "CONDITION: NUMBER"; the last that matches decides
  bool operator==(const PointsRadius&) const = default;
};

/// True if the name of a colour map or of a font is that of a file: other names contain neither dots nor slashes.
inline bool is_file_name(const std::string& name) { return name.find_first_of("./\\") != std::string::npos; }

/// Colours of the spheres of a points file, set by one of `column`, `element`, `types` and `rgb`; if none is set, those
/// of the material.
struct PointsColor {
  std::string column;              ///< coloured by a map; or an expression of columns
  std::string map = "viridis";     ///< name of a colour map, or a file relative to the scene file
  std::optional<Interval> range;   ///< range of the column's values; default: that of the selected spheres
  bool log = false;                ///< the map is linear in the logarithms of the values
  Vec3d nan_color{0.5, 0.5, 0.5};  ///< colour of NaN values
  std::string element;             ///< "jmol" or "soft"
  std::string carbon;              ///< with `element`: carbon atoms are coloured by this column and the map
  ColorsByType types;
  bool rgb = false;                ///< the file's colours
  std::vector<std::string> where;  ///< "CONDITION: COLOUR"; the last that matches decides

  bool is_set() const { return has_legend() || rgb || !where.empty(); }
  /// True if each colour stands for a value, a type or an element.
  bool has_legend() const { return !column.empty() || !element.empty() || !types.empty(); }
  bool has_map_file() const { return is_file_name(map); }
  bool operator==(const PointsColor&) const = default;
};

/// Bonds between the particles of a points file. Lengths are in the unit of the file, as are its coordinates.
struct PointsBonds {
  bool are_drawn = false;
  std::string from;              ///< "file", "distance" or "both"; empty: what the file has, see points::bond_source()
  std::optional<double> factor;  ///< by distance: largest length divided by the sum of the covalent radii
  std::optional<double> length;  ///< by distance: largest length, instead of `factor`
  std::optional<double> radius;  ///< of the rods; default: see points::bond_radius()
  std::optional<std::uint32_t> material;  ///< index into Scene::materials; default: as the spheres, half by half

  /// True if a key other than `are_drawn` is set.
  bool has_keys() const { return !from.empty() || factor || length || radius || material; }
  bool operator==(const PointsBonds&) const = default;
};

/// A bond between two spheres of a points table, by index: a < b.
struct SphereBond {
  std::uint32_t a = 0, b = 0;

  auto operator<=>(const SphereBond&) const = default;
};

/// A text in the image, at a point of the scene.
struct Label {
  Vec3d at{0, 0, 0};
  std::string text;
};

/// Half of a bond that crosses the boundary of a periodic box.
struct BondStub {
  std::uint32_t sphere = 0, partner = 0;  ///< the sphere at which it begins, and the one beyond the boundary
  Vec3d end{0, 0, 0};                     ///< the middle of the bond
};

/// Arrows at the spheres of a points file.
struct PointsVectors {
  std::vector<std::string> columns;  ///< of the x, y and z component; empty: no arrows
  double scale = 1;                  ///< length of an arrow, in the unit of the file, divided by that of its vector
  std::optional<double> radius;      ///< of the shafts, unit of the file; default: as PointsBonds::radius
  bool operator==(const PointsVectors&) const = default;
};

/// Motion of the spheres of a points file, in a frame: from their places to those in the next frame, or by velocities.
struct PointsMotion {
  bool next_frame = false;           ///< excludes the others
  std::vector<std::string> columns;  ///< of the x, y and z component of the velocity; empty: those of the file
  std::optional<double> frame_time;  ///< time between two frames, in the unit of the velocities

  bool is_set() const { return next_frame || frame_time || !columns.empty(); }
  bool operator==(const PointsMotion&) const = default;
};

/// Opacities of the spheres of a points file, 0..1, in place of those of their materials: `value`, or that of the last
/// of `where` that matches, else one of `column` and `types`, if one is set and has a value for the sphere.
struct PointsOpacity {
  std::optional<double> value;     ///< of every sphere; excludes the others
  std::string column;              ///< name of a column
  NumbersByType types;             ///< of the listed types
  std::vector<std::string> where;  ///< "CONDITION: NUMBER" or "NUMBER", see points::parse_opacity_rule()

  bool is_set() const { return value || !column.empty() || !types.empty() || !where.empty(); }
  bool operator==(const PointsOpacity&) const = default;
};

/// Transforms a point p of a file to scale * R p + translate, where R rotates about x, then y, then z.
struct PointsTransform {
  double scale = 1;
  Vec3d rotate{0, 0, 0};  ///< degrees
  Vec3d translate{0, 0, 0};
  bool operator==(const PointsTransform&) const = default;
};

/// The keys of a [[points]] table.
struct PointsKeys {
  std::filesystem::path file;    ///< as in the scene file, relative to it
  std::uint32_t material = 0;    ///< index into Scene::materials; used if the file has no materials
  std::string name = {};         ///< optional, for mattes: all spheres share it; default: the file name
  std::string group = {};        ///< optional, for mattes
  std::string sequence = {};     ///< `file` before the rendered frame replaced its frame pattern; empty: it has none
  std::optional<int> frame;      ///< frame of the file, from 1; default: the rendered frame, if the file has several
  std::optional<int> component;  ///< particle type of an HDF5 snapshot
  std::filesystem::path topology = {};  ///< file that names the atoms of a trajectory, as `file`; empty: none
  PointsRadius radius;
  PointsColor color;
  PointsBonds bonds;
  PointsVectors vectors;
  PointsMotion motion;
  PointsOpacity opacity;
  std::vector<std::string> representation;  ///< "CONDITION: KIND" or "KIND"; the last that matches decides
  std::vector<std::string> material_where;  ///< "CONDITION: MATERIAL"; the last that matches decides
  std::string select;                       ///< condition on columns; empty: all
  Vec3d replicate{1, 1, 1};                 ///< number of periodic boxes along each box edge
  bool unwrap = false;                      ///< unwrap coordinates with the periodic image flags of the file
  std::string assembly;                     ///< biological assembly; empty: the file's own atoms
  PointsTransform transform;
  std::array<std::optional<Interval>, 3> clip = {};  ///< keeps spheres with centres in these intervals of x, y and z
  std::string material_column = "material";          ///< indices into Scene::materials, in PLY files; empty: none
  bool skip_bad = false;                             ///< skips rows with non-finite coordinates or radii
  std::vector<std::string> labels;                   ///< "CONDITION: TEXT", at the middle of the particles that match
  std::vector<std::string> cryptomatte;              ///< columns; each combination of their values is an object
  bool operator==(const PointsKeys&) const = default;
};

/// The spheres of a points table, in flat arrays because there may be a hundred million, and the bonds between them.
struct PointsSpheres {
  PointArray centers = {};
  NumberArray radii = {};                     ///< one per centre
  std::vector<std::uint32_t> materials = {};  ///< one per centre; empty: PointsKeys::material for all
  std::vector<std::uint16_t> colors = {};     ///< one per centre, index into `palette`; empty: the material's colour
  /// One per centre; below 0: that of the material. Empty: PointsOpacity::value, or that of the material, for all.
  std::vector<float> opacities = {};
  std::vector<std::uint8_t> are_traces = {};  ///< one per centre: its bonds have `trace_radius`; empty: none
  std::vector<SphereBond> bond_pairs = {};
  std::vector<BondStub> bond_stubs = {};
  PointArray sphere_vectors = {};  ///< one per centre, while arrows are to be added
  PointArray to_next = {};         ///< one per centre, its displacement in a frame; empty: all rest
  PointArray to_previous = {};     ///< one per centre, its displacement to the frame before; empty: the opposite

  /// Bytes of the spheres and bonds.
  std::size_t bytes() const {
    return centers.bytes() + radii.bytes() + materials.size() * sizeof(materials[0]) +
           colors.size() * sizeof(colors[0]) + are_traces.size() + bond_pairs.size() * sizeof(bond_pairs[0]) +
           bond_stubs.size() * sizeof(bond_stubs[0]) + opacities.size() * sizeof(opacities[0]) + to_next.bytes() +
           to_previous.bytes();
  }
};

/// Names and values.
using HeaderNumbers = std::vector<std::pair<std::string, double>>;

/// What else the data of a points table determine: it is kept when the spheres are released.
struct PointsFindings {
  std::vector<Vec3d> palette = {};  ///< colours that replace those of the material
  std::size_t palette_rec709 = 0;   ///< leading colours that are linear Rec.709; others are in Color::space
  /// Of the colours in `palette`, if they represent types or elements; empty: that of a condition.
  std::vector<std::string> color_names = {};
  std::optional<Interval> color_range = {};  ///< range of the colour map, if there is one
  bool has_nan_color = false;                ///< values without a colour in the map have the last one of `palette`
  std::vector<std::string> unused = {};      ///< unused columns of the file, such as colours
  HeaderNumbers header = {};                 ///< numbers of the frame's header, e.g. its `step`
  std::vector<Label> placed_labels = {};     ///< those of PointsKeys::labels
  std::size_t arrow_count = 0;               ///< number of arrows; their shafts are the last of `bond_pairs`
  std::size_t arrow_spheres = 0;             ///< number of spheres of their heads, after all others
  double rms_vector = 0;                     ///< root mean square length of the vectors, times their scale
  std::vector<std::uint32_t> objects = {};  ///< with `cryptomatte`: indices into `object_names`, of centres, then stubs
  std::vector<std::string> object_names = {};  ///< ".A", appended to the name of the table
  std::string bonds_from = {};                 ///< resolved PointsBonds::from; empty: bonds are not drawn
  double bond_radius = 0;                      ///< of the rods of bonds, scene units
  double trace_radius = 0;                     ///< of the rods of traces, scene units
  bool spheres_are_rows = true;  ///< sphere i is row i of the file: no selection, sorting, copying or clipping
};

/// A [[points]] table, with its data if they have been read, see points::load_points().
struct Points : PointsKeys, PointsSpheres, PointsFindings {
  /// Number of spheres without those of arrows.
  std::size_t particle_count() const { return centers.size() - arrow_spheres; }
  /// The displacement of a sphere in a time, frames: a part of that to the next frame, or of that to the previous one.
  ///
  /// Domain     the spheres move
  Vec3d displacement(std::size_t sphere, double frames) const {
    return frames < 0 && !to_previous.empty() ? to_previous[sphere] * -frames : to_next[sphere] * frames;
  }
  /// Radius of the bonds of a sphere.
  double bond_radius_of(std::size_t sphere) const {
    return !are_traces.empty() && are_traces[sphere] != 0 ? trace_radius : bond_radius;
  }
  /// Number of rods of the bonds and arrows.
  std::size_t bond_count() const { return bond_pairs.size() + bond_stubs.size(); }
  std::size_t bytes() const { return PointsSpheres::bytes() + objects.size() * sizeof(objects[0]); }
  /// Calls `f` with each array that has a value of each sphere and is not empty, except centres, radii and vectors.
  ///
  /// Domain     `objects` does not yet have those of stubs
  template <class F>
  void each_sphere_value(F f) {
    const auto visit = [&](auto& values) {
      if (!values.empty()) f(values);
    };
    visit(materials);
    visit(colors);
    visit(opacities);
    visit(objects);
    visit(are_traces);
  }
  /// Calls `f` with each array that has a vector of each sphere and is not empty.
  template <class F>
  void each_vector(F f) {
    for (PointArray* const array : {&sphere_vectors, &to_next, &to_previous})
      if (!array->empty()) f(*array);
  }
  /// Frees the memory of the spheres and bonds.
  void release_spheres() { static_cast<PointsSpheres&>(*this) = {}; }
  /// Keeps the keys alone.
  void release_data() {
    release_spheres();
    static_cast<PointsFindings&>(*this) = {};
  }
};

/// Rods of a data file, one per row. Filled by points::load_rods.
struct RodFile {
  std::filesystem::path file;                       ///< as in the scene file, relative to it
  std::optional<double> radius;                     ///< of all rods; default: those in the file
  std::array<std::uint32_t, 2> materials = {0, 0};  ///< as of a Rod
  std::string name = {};                            ///< optional, for mattes: all rods share it; default: the file name
  std::string group = {};                           ///< optional, for mattes
  PointArray from = {}, to = {};                    ///< ends
  NumberArray radii = {};                           ///< one per rod

  /// Bytes of the rods.
  std::size_t bytes() const { return from.bytes() + to.bytes() + radii.bytes(); }
  /// Frees the memory of the rods; keeps the keys.
  void release_rods() {
    from.clear();
    to.clear();
    radii.clear();
  }
};

/// Contents of output files in addition to the beauty image.
struct Output {
  std::vector<std::string> layers;  ///< names from the schema's choices
};

/// Colour management: colour spaces of the scene file and of the image, and the display transform.
struct Color {
  std::string space = "lin_rec709";
  std::string working;              ///< for rendering and for EXR output; empty: `space`
  std::filesystem::path config;     ///< OCIO config, relative to the scene file; empty: $OCIO or the built-in config
  std::string display, view, look;  ///< names in the config; empty: its defaults, and no look
  double exposure = 0;              ///< stops

  const std::string& working_space() const { return working.empty() ? space : working; }
};

/// Text, scales and lines over the image: burnt into display formats, and a layer of EXR files.
struct Annotation {
  std::string title;                   ///< at the top left; {EXPRESSION} of frame and header numbers becomes its value
  std::optional<double> scale_bar;     ///< length, scene units
  std::string unit;                    ///< of the scale bar, as text
  bool color_bar = false;              ///< the colours of the first coloured points table
  std::string color_title;             ///< title of the colour bar; empty: the column
  std::string color_at = "top right";  ///< corner of the colour bar
  double font_size = 0;                ///< px; 0: depends on the image
  double outline = 0;                  ///< width of the outlines of objects, px; 0: none
  bool outline_objects = false;        ///< divides lines into those between and within the objects of CryptoObject
  double outline_depth = 0;            ///< smallest jump of the depth, scene units; 0: that of the front object
  std::filesystem::path font;          ///< name or file; empty: DejaVu Sans

  /// True if something is drawn.
  bool is_set() const { return !title.empty() || scale_bar || color_bar || outline > 0; }
};

enum class Interpolation { kLinear, kCubic, kHold };

/// Keyframes of an animated number or vector, and the interpolation between them.
struct Track {
  std::string target;  ///< as accepted by scene::find_animated: "camera.look_from", "sphere[3].radius"
  Interpolation interpolation = Interpolation::kLinear;
  std::vector<double> frames;  ///< ascending
  std::vector<Vec3d> values;   ///< one per frame; a single number is in x
};

struct Animation {
  double fps = 24;       ///< frames per second
  double turntable = 0;  ///< frames per orbit of the camera around look_at, about up; 0: off
};

struct Scene {
  Image image;
  Camera camera;
  Background background;
  Render render;
  Color color;
  Output output;
  Annotation annotation;
  Animation animation;
  std::vector<Track> tracks;
  std::vector<Material> materials;
  std::vector<Sphere> spheres;
  std::vector<Points> points;
  std::vector<Rod> rods;
  std::vector<RodFile> rod_files;
  /// No two spheres coincide in this precision or a higher one. Empty: not known.
  std::optional<Precision> distinct_in = {};

  /// Returns the number of rods in [[rod]] tables and in files, and of bonds.
  std::size_t rod_count() const {
    std::size_t count = rods.size();
    for (const Points& p : points) count += p.bond_count();
    for (const RodFile& file : rod_files) count += file.from.size();
    return count;
  }

  /// Returns the number of spheres in [[sphere]] tables and points files.
  std::size_t sphere_count() const {
    std::size_t count = spheres.size();
    for (const Points& p : points) count += p.centers.size();
    return count;
  }
};

}  // namespace orrery::scene
