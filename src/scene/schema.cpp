// SPDX-License-Identifier: Apache-2.0
#include "scene/schema.h"

#include <limits>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include "scene/key_builders.h"
#include "scene/layers.h"

namespace orrery::scene {
namespace {

template <class Member>
Table table(const char* name, Part part, Member Scene::*member, std::vector<Key<Member>> keys) {
  return {name, part, keys_at<Scene>(member, std::move(keys))};
}

/// Builds a key for a member that is 0 if the scene does not say it; the range of the key excludes 0.
template <class Target>
Key<Target> number_or_none(const char* name, const Range& range, const KeyDoc& about, double Target::*at) {
  Key<Target> key = number(name, range, about, at);
  key.get = [at](const Target& target) {
    return target.*at == 0 ? std::optional<Value>() : std::optional<Value>(target.*at);
  };
  return key;
}

Table image_table() {
  const char* const cost = "Time and memory scale linearly";
  return table(
      "image", Part::kView, &Scene::image,
      {integer("width", {1, kLargestSide}, {"Image width", "px", cost}, &Image::width),
       integer("height", {1, kLargestSide}, {"Image height", "px", cost}, &Image::height),
       number("pixel_aspect", {0.1, 10}, {"Pixel width divided by pixel height on the display"}, &Image::pixel_aspect),
       otherwise(
           "the whole image",
           key_of(
               "crop", ValueType::kWindow, {0, kLargestSide},
               {"Crop window (EXR data window) in pixels from the top left of the image, as [x, y, width, height]. Its "
                "pixels are identical to those of the full image, bit for bit. Cannot be combined with `overscan`",
                "px"},
               &Image::crop)),
       integer("overscan", {0, kWidestOverscan},
               {"Rows and columns to render beyond each edge of the image. Cannot be combined with `crop`", "px", cost},
               &Image::overscan),
       changes(Part::kOutput,
               otherwise("none",
                         number_or_none(
                             "dpi", {1, 10000, false, false},
                             {"Resolution in print, which PNG, TIFF and JPEG files carry. Texts are 8 points high then",
                              "px per inch"},
                             &Image::dpi)))});
}

Table camera_table() {
  return table(
      "camera", Part::kView, &Scene::camera,
      {choice("projection", {"perspective", "orthographic"},
              {"`perspective`: rays start at `look_from`. `orthographic`: parallel rays start on the plane through "
               "`look_from`; what is behind this plane is not visible"},
              &Camera::projection),
       vector("look_from", kAnyLength, {"Camera position. May be inside a sphere", "scene units"}, &Camera::look_from),
       vector("look_at", kAnyLength, {"Point at the centre of the image", "scene units"}, &Camera::look_at),
       vector("up", kAnyLength, {"Up direction of the image. Must not be parallel to the view direction", "any length"},
              &Camera::up),
       number("vfov", {0, 180, true, true}, {"Perspective: vertical field of view", "degrees"}, &Camera::vfov),
       otherwise("none; required for orthographic",
                 number("width", kLength, {"Orthographic: width of the image", "scene units"}, &Camera::width)),
       number("defocus_angle", {0, 180, false, true},
              {"Apex angle of the cone from a point in focus to the rim of the lens. 0 is a pinhole camera", "degrees",
               "Above 0: one lens sample per path"},
              &Camera::defocus_angle),
       otherwise("distance to look_at",
                 number("focus_distance", kLength, {"Distance from the camera to the focus plane", "scene units"},
                        &Camera::focus_distance)),
       number("shutter_open", {-kLongestShutter, kLongestShutter},
              {"Shutter opening time, relative to the frame", "frames"}, &Camera::shutter_open),
       number("shutter_close", {-kLongestShutter, kLongestShutter},
              {"Shutter closing time, relative to the frame. If later than `shutter_open`, camera and spheres that "
               "move during the interval are motion-blurred",
               "frames", "Only if something moves: one extra random dimension per path, and motion-blurred bounds"},
              &Camera::shutter_close),
       number("depth_cue", {0, 1},
              {"Depth cue: share of the backdrop, or of the background where there is none, in the colours at the far "
               "end of `depth_cue_range`. It rises linearly from 0 at the near end, along the view axis, and is that "
               "of the first hit of each path. With `background.alpha = 0`, the share is transparent",
               "", "At most 5 % of the render time"},
              &Camera::depth_cue),
       otherwise("from a tenth of the depth of all `[[points]]` and rods to their farthest point",
                 key_of("depth_cue_range", ValueType::kInterval, kAnyLength,
                        {"Where the depth cue begins and ends, as distances from `look_from` along the view axis. Set "
                         "it for sequences: the default depends on the frame",
                         "scene units"},
                        &Camera::depth_cue_range))});
}

Table animation_table() {
  return table(
      "animation", Part::kOutput, &Scene::animation,
      {number("fps", {0.001, 1000}, {"Frame rate, written to the EXR header", "frames per second"}, &Animation::fps),
       number("turntable", {-kMaxFrame, kMaxFrame},
              {"Number of frames per orbit of the camera around `look_at`, about `up`. The camera is at `look_from` in "
               "frame 1 and moves to its right; negative values: to its left. 0: no orbit",
               "frames"},
              &Animation::turntable)});
}

Table background_table() {
  const char* const unit = "scene-linear";
  return table(
      "background", Part::kLook, &Scene::background,
      {choice("type", {"gradient", "constant", "image", "sky"},
              {"`gradient`: from `bottom` to `top`, linear in the component of the unit ray direction along `up`. "
               "`constant`: `color`. `image`: the latitude-longitude map in `file`. `sky`: daylight, computed from the "
               "scattering "
               "of sunlight in the atmosphere; see [Daylight](#daylight)"},
              &Background::type),
       vector("bottom", kLight, {"Gradient: radiance from straight below", unit}, &Background::bottom),
       vector("top", kLight, {"Gradient: radiance from straight above", unit}, &Background::top),
       vector("up", kAnyLength, {"Gradient: the direction above", "any length"}, &Background::up),
       vector("color", kLight, {"Constant: radiance from every direction", unit}, &Background::color),
       integer("alpha", {0, 1},
               {"1: the background is opaque. 0: the image is transparent where only the background is visible", "",
                "0: costs as much as one layer"},
               &Background::alpha),
       otherwise("camera rays see the background",
                 vector("backdrop", kLight,
                        {"Radiance that camera rays see in place of the background. It illuminates nothing; "
                         "reflections and refractions still see the background",
                         unit},
                        &Background::backdrop)),
       file("file", kBackgroundFile,
            {"Image: EXR or HDR file, relative to the scene file, with the poles at +y and -y, +z at the centre and +x "
             "halfway to the left edge. May contain a frame pattern such as `####`",
             "", "12 bytes per texel; 13.3 with `direct_lighting` other than `bsdf`"},
            &Background::file),
       text("color_space",
            {"Image: colour space of `file`, if the file does not declare one. Any space of the OCIO config. Default: "
             "`color.space`"},
            &Background::color_space),
       number("rotation", {-kLargestRotation, kLargestRotation},
              {"Image and sky: rotation about +y; 90 turns +z to +x", "degrees"}, &Background::rotation),
       number("exposure", {-kMaxStops, kMaxStops},
              {"Image and sky: multiplies the radiance by 2 to this power. The product is at most 2^34", "stops"},
              &Background::exposure),
       text("light_group", {"Image and sky: light group. Default: the group `default`"}, &Background::light_group),
       boolean("visible",
               {"Image and sky: visible to the camera. If `false`, camera rays see black; reflections still see it"},
               &Background::visible),
       number("sun_elevation", {-90, 90},
              {"Sky: angle from the horizon to the sun. Negative: the sun has set", "degrees"},
              &Background::sun_elevation),
       number("sun_azimuth", {-kLargestRotation, kLargestRotation},
              {"Sky: angle from +z to the sun; 90 is +x", "degrees"}, &Background::sun_azimuth),
       number("turbidity", {kLowestTurbidity, kHighestTurbidity},
              {"Sky: amount of haze. 1: pure air, 2: a clear day, 6: hazy"}, &Background::turbidity),
       vector("ground_albedo", kUnit, {"Sky: reflectance of the ground, which also brightens the sky", unit},
              &Background::ground_albedo),
       boolean("sun", {"Sky: includes the sun's disc, which is sampled as a separate light"}, &Background::sun)});
}

Table render_table() {
  return table(
      "render", Part::kView, &Scene::render,
      {integer("samples", {1, std::numeric_limits<std::int32_t>::max()},
               {"Paths per pixel", "per pixel", "Time scales linearly; four times as many samples halve the noise"},
               &Render::samples),
       integer("max_depth", {1, kDeepestPath},
               {"Maximum number of rays per path, counted as in the book: the camera ray is the first. If the last ray "
                "hits a sphere, only the sphere's emission counts",
                "rays", "An upper bound only: most paths leave the scene earlier"},
               &Render::max_depth),
       integer("roulette_depth", {0, kDeepestPath},
               {"Scattering events before Russian roulette begins. It terminates paths with a probability that grows "
                "as their throughput falls, and divides the throughput of survivors by their survival probability; the "
                "result is unbiased. 0: no roulette",
                "scattering events", "0: up to twice the render time, especially in dark scenes"},
               &Render::roulette_depth),
       choice("sampler", {"independent", "sobol", "blue-noise"},
              {"Sampler. `independent`: uncorrelated random numbers, as in the book. `sobol`: Owen-scrambled Sobol "
               "sequence (low discrepancy). `blue-noise`: a Sobol sequence shared by neighbouring pixels, so that "
               "their errors form blue noise",
               "", "`sobol` and `blue-noise` need fewer samples for the same error"},
              &Render::sampler),
       integer("seed", {0, std::numeric_limits<std::uint32_t>::max()},
               {"Random seed. The same seed gives the same image, bit for bit"}, &Render::seed),
       changes(
           Part::kGeometry,
           choice(
               "precision", {"exact", "fast", "book"},
               {"`exact`: double precision without epsilons. `fast`: single precision. `book`: the book's intersection "
                "formula with its minimum t, for comparison: sphere by sphere, without SIMD, for any `accelerator`",
                "", "`fast` trades accuracy for speed; the time of `book` grows with the number of spheres"},
               &Render::precision)),
       choice("shading", {"path", "normal", "flat"},
              {"`path`: path tracing. `normal`: surface normals as colours. `flat`: albedo without lighting", "",
               "`normal` and `flat`: one ray per sample"},
              &Render::shading),
       changes(
           Part::kGeometry,
           choice(
               "accelerator", {"embree", "list"},
               {"`embree`: Embree's BVH. `list`: each ray tests every sphere, for comparison. The image is the same, "
                "bit for bit; in `fast` for static spheres up to 10,000 times the scene's size from the origin",
                "", "`list`: time is proportional to the number of spheres"},
               &Render::accelerator)),
       choice("traversal", {"auto", "packet", "single"},
              {"Traversal of Embree's BVH, for comparison: by packets of rays, or ray by ray. `auto`: the fastest for "
               "each kind of rays. The image is the same, bit for bit",
               "", "-"},
              &Render::traversal),
       changes(Part::kLook,
               choice("direct_lighting", {"mis", "bsdf", "light"},
                      {"Sampling of direct light. `mis`: light and BSDF sampling, combined by multiple importance "
                       "sampling. `bsdf`: BSDF sampling only, as in the book. `light`: light sampling only, except for "
                       "reflections in mirrors and glass and inside emitters, where it is impossible",
                       "",
                       "`mis` and `light`: one shadow ray per vertex on a diffuse material or fuzzy metal; none in "
                       "scenes without lights"},
                      &Render::direct_lighting)),
       changes(
           Part::kLook,
           boolean("caustics",
                   {"Sample caustics: light from lamps and the sun that reaches diffuse surfaces via a mirror ball or "
                    "a ball of clear glass. `false`: it is found by BSDF sampling only. Has no effect with "
                    "`direct_lighting = \"bsdf\"`",
                    "", "2 to 4 rays per vertex on a diffuse material; none in scenes without such a ball or light"},
                   &Render::caustics)),
       choice("filter", {"box", "gaussian", "blackman-harris"},
              {"Pixel filter. `box`: the area of the pixel, as in the book. `gaussian`, `blackman-harris`: softer"},
              &Render::filter),
       otherwise("1 for box, 3 for gaussian and blackman-harris",
                 number("filter_width", {0, kWidestFilter, true, false}, {"Full width of the filter", "px"},
                        &Render::filter_width))});
}

Table annotation_table() {
  return table(
      "annotation", Part::kOutput, &Scene::annotation,
      {text("title",
            {"Text at the top left. `{EXPRESSION}` is replaced by the value of an [expression](data.md#expressions) of "
             "`frame`, that of the first points table if it is set there, else the rendered one, and `step`, the time "
             "step in the data file: `t = {step * 0.005:.1f} ps`; numbers in the comment line of extended XYZ have "
             "their "
             "names there: `{energy:.2f}`. `{{` and `}}` are braces. A title that is too long "
             "is set in a smaller font, or cut"},
            &Annotation::title),
       otherwise("none", number("scale_bar", kLength,
                                {"Length of a bar at the bottom left. Requires an orthographic camera", "scene units"},
                                &Annotation::scale_bar)),
       text("unit", {"Text after the length of the scale bar, e.g. `nm`"}, &Annotation::unit),
       boolean("color_bar", {"Legend of the first points table that is coloured by a column, type or element"},
               &Annotation::color_bar),
       text("color_title", {"Title of the colour bar, e.g. `Speed (m/s)`. Default: the column"},
            &Annotation::color_title),
       choice("color_at", {"top right", "bottom right", "top left", "bottom left"}, {"Corner of the colour bar"},
              &Annotation::color_at),
       otherwise("a 32nd of the height, or with `image.dpi` 8 points; at least 9",
                 number_or_none("font_size", {4, 1000}, {"Height of the texts", "px"}, &Annotation::font_size)),
       number("outline", {0, kWidestOutline},
              {"Width of the outlines of objects, drawn at discontinuities of the depth. 0: none. Drawn as at shutter "
               "open, without a lens",
               "px", "4 to 16 rays per pixel, twice as many with translucent objects"},
              &Annotation::outline),
       boolean(
           "outline_objects",
           {"Draw outlines wherever objects of the CryptoObject matte meet, such as the chains with `cryptomatte = "
            "[\"chain\"]` in `[[points]]`. Within objects, lines are half as wide and weaker, except against what is "
            "far behind"},
           &Annotation::outline_objects),
       otherwise("a quarter of the radius of the object in front, twice the radius with `outline_objects`",
                 number("outline_depth", {0, kLargestLength},
                        {"Smallest jump of the depth that is an outline", "scene units"}, &Annotation::outline_depth)),
       file("font", kFontFile,
            {"Font of all texts: a name, or a file relative to the scene file. Default: DejaVu Sans"},
            &Annotation::font)});
}

Table color_table() {
  return table(
      "color", Part::kOutput, &Scene::color,
      {changes(
           Part::kAssignment,
           text("space", {"Colour space of all colours in the scene file: any scene-linear space of the OCIO config"},
                &Color::space)),
       changes(Part::kAssignment,
               text("working", {"Colour space for rendering and for EXR output. Default: `space`"}, &Color::working)),
       changes(
           Part::kAssignment,
           file("config", kOcioConfigFile,
                {"OCIO config, relative to the scene file. Default: `$OCIO`, or the built-in config if it is not set"},
                &Color::config)),
       text("display", {"Display for PNG, TIFF, JPEG and PPM. Default: that of the config"}, &Color::display),
       text("view", {"View of the display. Default: that of the display"}, &Color::view),
       text("look", {"Look to apply before the view"}, &Color::look),
       number("exposure", {-kMaxStops, kMaxStops}, {"Exposure of display output. Does not affect EXR", "stops"},
              &Color::exposure)});
}

Table output_table() {
  std::vector<std::string> layers = layer_names();
  layers.emplace_back(kAllLayers);
  return table(
      "output", Part::kOutput, &Scene::output,
      {key_of("layers", ValueType::kChoices, {},
              {"Layers of EXR files in addition to the beauty image. `all`: every layer that the scene can have, "
               "except `halves`",
               "", "One layer adds about 20 % to the render time of a simple scene, all layers 70 %. Larger files"},
              &Output::layers, std::move(layers))});
}

}  // namespace

const FileRole kPointsFile{"points file", true};
const FileRole kTopologyFile{"topology file"};
const FileRole kRodsFile{"file of rods", true};
const FileRole kColorMapFile{"colour map", false, is_file_name};
const FileRole kBackgroundFile{"background image", true};
const FileRole kTextureFile{"texture", true};
const FileRole kFontFile{"font", false, is_file_name};
const FileRole kOcioConfigFile{
    "OCIO config", false, [](const std::string& value) { return !value.empty() && !value.starts_with("ocio://"); }};

std::string Range::text() const {
  if (!from_open && !to_open) return fmt::format("{}..{}", number_text(from), number_text(to));
  return std::string(from_open ? "above " : "at least ") + number_text(from) +
         (to_open ? " and below " : " and at most ") + number_text(to);
}

std::string Range::requirement() const { return (from_open || to_open ? "must be " : "must be in ") + text(); }

const std::vector<Table>& tables() {
  static const std::vector<Table> all = {image_table(), camera_table(), background_table(), render_table(),
                                         color_table(), output_table(), annotation_table(), animation_table()};
  return all;
}

const std::vector<Key<Sphere>>& sphere_keys() {
  static const std::vector<Key<Sphere>> keys = {
      required(vector("center", kAnyLength, {"Centre", "scene units"}, &Sphere::center)),
      required(number("radius", kAnyLength,
                      {"Radius. Must not be 0. If negative, the normal points inward, for hollow glass", "scene units"},
                      &Sphere::radius)),
      changes(Part::kOutput,
              text("name", {"Name in the CryptoObject matte. Default: `sphere.` and the index"}, &Sphere::name)),
      changes(Part::kOutput, text("group", {"CryptoGroup name; objects of a group share one matte"}, &Sphere::group)),
      changes(
          Part::kView,
          boolean("page",
                  {"The camera sees the sphere as a part of the backdrop on which shadows fall: it is not tone mapped, "
                   "and with `background.alpha = 0` its shadows are alpha. Its colour without shadows should be "
                   "`background.backdrop`. One sphere of a scene"},
                  &Sphere::is_page))};
  return keys;
}

const std::vector<Key<Rod>>& rod_keys() {
  static const std::vector<Key<Rod>> keys = {
      required(vector("from", kAnyLength, {"One end of the axis", "scene units"}, &Rod::from)),
      required(vector("to", kAnyLength,
                      {"The other end. May be the same point: the rod is then a sphere", "scene units"}, &Rod::to)),
      required(number("radius", kLength, {"Radius", "scene units"}, &Rod::radius)),
      changes(Part::kOutput,
              text("name", {"Name in the CryptoObject matte. Default: `rod.` and the index"}, &Rod::name)),
      changes(Part::kOutput, text("group", {"CryptoGroup name; objects of a group share one matte"}, &Rod::group))};
  return keys;
}

const std::vector<Key<RodFile>>& rod_file_keys() {
  static const std::vector<Key<RodFile>> keys = {
      required(file("file", kRodsFile,
                    {"Data file, relative to the scene file, in a format of `[[points]]`, with columns `x0`, `y0`, "
                     "`z0`, `x1`, `y1`, `z1` and `radius`: a rod per row. May contain a frame pattern such as `####`",
                     "", "About 90 bytes per rod, with the BVH"},
                    &RodFile::file)),
      otherwise("as in the file", number("radius", kLength, {"Radius of all rods", "scene units"}, &RodFile::radius)),
      changes(
          Part::kOutput,
          text("name", {"Name in the CryptoObject matte, shared by all rods. Default: the file name"}, &RodFile::name)),
      changes(Part::kOutput, text("group", {"CryptoGroup name; objects of a group share one matte"}, &RodFile::group))};
  return keys;
}

const std::vector<Key<Track>>& track_keys() {
  static const std::vector<Key<Track>> keys = {choice(
      "interpolation", {"linear", "cubic", "hold"},
      {"`cubic`: smooth, through all values; may overshoot between them. `hold`: constant until the next keyframe"},
      &Track::interpolation)};
  return keys;
}

}  // namespace orrery::scene
