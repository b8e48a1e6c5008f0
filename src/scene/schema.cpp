// SPDX-License-Identifier: Apache-2.0
#include "scene/schema.h"

#include <limits>
#include <utility>

#include <fmt/core.h>

#include "scene/key_builders.h"
#include "scene/layers.h"
#include "scene/limits.h"

namespace orrery::scene {
namespace {

using S = Scene;

Table image_table() {
  const char* const cost = "Time and memory scale linearly";
  return {
      "image",
      Part::kView,
      {integer<S>("width", {1, kLargestSide}, {"px", "Image width", cost}, in(&S::image, &Image::width)),
       integer<S>("height", {1, kLargestSide}, {"px", "Image height", cost}, in(&S::image, &Image::height)),
       number<S>("pixel_aspect", {0.1, 10}, {"", "Pixel width divided by pixel height on the display"},
                 in(&S::image, &Image::pixel_aspect)),
       otherwise(
           "the whole image",
           key_of<S>(
               "crop", ValueType::kWindow, {0, kLargestSide},
               {"px",
                "Crop window (EXR data window) in pixels from the top left of the image, as [x, y, width, height]. Its "
                "pixels are identical to those of the full image, bit for bit. Cannot be combined with `overscan`"},
               in(&S::image, &Image::crop))),
       integer<S>(
           "overscan", {0, kWidestOverscan},
           {"px", "Rows and columns to render beyond each edge of the image. Cannot be combined with `crop`", cost},
           in(&S::image, &Image::overscan))}};
}

Table camera_table() {
  return {
      "camera",
      Part::kView,
      {choice<S>("projection", {"perspective", "orthographic"},
                 {"",
                  "`perspective`: rays start at `look_from`. `orthographic`: parallel rays start on the plane through "
                  "`look_from`; what is behind this plane is not visible"},
                 in(&S::camera, &Camera::projection)),
       vector<S>("look_from", kAnyLength, {"scene units", "Camera position. May be inside a sphere"},
                 in(&S::camera, &Camera::look_from)),
       vector<S>("look_at", kAnyLength, {"scene units", "Point at the centre of the image"},
                 in(&S::camera, &Camera::look_at)),
       vector<S>("up", kAnyLength,
                 {"any length", "Up direction of the image. Must not be parallel to the view direction"},
                 in(&S::camera, &Camera::up)),
       number<S>("vfov", {0, 180, true, true}, {"degrees", "Perspective: vertical field of view"},
                 in(&S::camera, &Camera::vfov)),
       otherwise("none; required for orthographic",
                 number<S>("width", kLength, {"scene units", "Orthographic: width of the image"},
                           in(&S::camera, &Camera::width))),
       number<S>(
           "defocus_angle", {0, 180, false, true},
           {"degrees", "Apex angle of the cone from a point in focus to the rim of the lens. 0 is a pinhole camera",
            "Above 0: one lens sample per path"},
           in(&S::camera, &Camera::defocus_angle)),
       otherwise("distance to look_at",
                 number<S>("focus_distance", kLength, {"scene units", "Distance from the camera to the focus plane"},
                           in(&S::camera, &Camera::focus_distance))),
       number<S>("shutter_open", {-kLongestShutter, kLongestShutter},
                 {"frames", "Shutter opening time, relative to the frame"}, in(&S::camera, &Camera::shutter_open)),
       number<S>("shutter_close", {-kLongestShutter, kLongestShutter},
                 {"frames",
                  "Shutter closing time, relative to the frame. If later than `shutter_open`, camera and spheres "
                  "that move during the interval are motion-blurred",
                  "Only if something moves: one extra random dimension per path, and motion-blurred bounds"},
                 in(&S::camera, &Camera::shutter_close))}};
}

Table animation_table() {
  return {"animation",
          Part::kOutput,
          {number<S>("fps", {0.001, 1000}, {"frames per second", "Frame rate, written to the EXR header"},
                     in(&S::animation, &Animation::fps)),
           number<S>("turntable", {-kMaxFrame, kMaxFrame},
                     {"frames",
                      "Number of frames per orbit of the camera around `look_at`, about `up`. The camera is at "
                      "`look_from` in frame 1 and moves to its right; negative values: to its left. 0: no orbit"},
                     in(&S::animation, &Animation::turntable))}};
}

Table background_table() {
  const char* const unit = "scene-linear";
  return {
      "background",
      Part::kLook,
      {choice<S>("type", {"gradient", "constant", "image", "sky"},
                 {"",
                  "`gradient`: from `bottom` to `top`, linear in the y component of the unit ray direction. "
                  "`constant`: `color`. `image`: the latitude-longitude map in `file`. `sky`: daylight, computed from "
                  "the scattering of sunlight in the atmosphere; see [Daylight](#daylight)"},
                 in(&S::background, &Background::type)),
       vector<S>("bottom", kLight, {unit, "Gradient: radiance from straight below"},
                 in(&S::background, &Background::bottom)),
       vector<S>("top", kLight, {unit, "Gradient: radiance from straight above"}, in(&S::background, &Background::top)),
       vector<S>("color", kLight, {unit, "Constant: radiance from every direction"},
                 in(&S::background, &Background::color)),
       integer<S>("alpha", {0, 1},
                  {"", "1: the background is opaque. 0: the image is transparent where only the background is visible",
                   "0: costs as much as one layer"},
                  in(&S::background, &Background::alpha)),
       otherwise("camera rays see the background",
                 vector<S>("backdrop", kLight,
                           {unit,
                            "Radiance that camera rays see in place of the background. It illuminates nothing; "
                            "reflections and refractions still see the background"},
                           in(&S::background, &Background::backdrop))),
       file<S>("file", kBackgroundFile,
               {"",
                "Image: EXR or HDR file, relative to the scene file, with the poles at +y and -y, +z at the centre and "
                "+x halfway to the left edge. May contain a frame pattern such as `####`",
                "12 bytes per texel; 13.3 with `direct_lighting` other than `bsdf`"},
               in(&S::background, &Background::file)),
       text<S>("color_space",
               {"",
                "Image: colour space of `file`, if the file does not declare one. Any space of the OCIO config. "
                "Default: `color.space`"},
               in(&S::background, &Background::color_space)),
       number<S>("rotation", {-kLargestRotation, kLargestRotation},
                 {"degrees", "Image and sky: rotation about +y; 90 turns +z to +x"},
                 in(&S::background, &Background::rotation)),
       number<S>("exposure", {-kMaxStops, kMaxStops},
                 {"stops", "Image and sky: multiplies the radiance by 2 to this power. The product is at most 2^34"},
                 in(&S::background, &Background::exposure)),
       text<S>("light_group", {"", "Image and sky: light group. Default: the group `default`"},
               in(&S::background, &Background::light_group)),
       boolean<S>(
           "visible",
           {"", "Image and sky: visible to the camera. If `false`, camera rays see black; reflections still see it"},
           in(&S::background, &Background::visible)),
       number<S>("sun_elevation", {-90, 90},
                 {"degrees", "Sky: angle from the horizon to the sun. Negative: the sun has set"},
                 in(&S::background, &Background::sun_elevation)),
       number<S>("sun_azimuth", {-kLargestRotation, kLargestRotation},
                 {"degrees", "Sky: angle from +z to the sun; 90 is +x"}, in(&S::background, &Background::sun_azimuth)),
       number<S>("turbidity", {kLowestTurbidity, kHighestTurbidity},
                 {"", "Sky: amount of haze. 1: pure air, 2: a clear day, 6: hazy"},
                 in(&S::background, &Background::turbidity)),
       vector<S>("ground_albedo", kUnit, {unit, "Sky: reflectance of the ground, which also brightens the sky"},
                 in(&S::background, &Background::ground_albedo)),
       boolean<S>("sun", {"", "Sky: includes the sun's disc, which is sampled as a separate light"},
                  in(&S::background, &Background::sun))}};
}

Table render_table() {
  return {
      "render",
      Part::kView,
      {integer<S>("samples", {1, std::numeric_limits<std::int32_t>::max()},
                  {"per pixel", "Paths per pixel", "Time scales linearly; four times as many samples halve the noise"},
                  in(&S::render, &Render::samples)),
       integer<S>("max_depth", {1, kDeepestPath},
                  {"rays",
                   "Maximum number of rays per path, counted as in the book: the camera ray is the first. If the last "
                   "ray hits a sphere, only the sphere's emission counts",
                   "An upper bound only: most paths leave the scene earlier"},
                  in(&S::render, &Render::max_depth)),
       integer<S>("roulette_depth", {0, kDeepestPath},
                  {"scattering events",
                   "Scattering events before Russian roulette begins. It terminates paths with a probability that "
                   "grows as their throughput falls, and divides the throughput of survivors by their survival "
                   "probability; the result is unbiased. 0: no roulette",
                   "0: up to twice the render time, especially in dark scenes"},
                  in(&S::render, &Render::roulette_depth)),
       choice<S>("sampler", {"independent", "sobol", "blue-noise"},
                 {"",
                  "Sampler. `independent`: uncorrelated random numbers, as in the book. `sobol`: Owen-scrambled Sobol "
                  "sequence (low discrepancy). `blue-noise`: a Sobol sequence shared by neighbouring pixels, so that "
                  "their errors form blue noise",
                  "`sobol` and `blue-noise` need fewer samples for the same error"},
                 in(&S::render, &Render::sampler)),
       integer<S>("seed", {0, std::numeric_limits<std::uint32_t>::max()},
                  {"", "Random seed. The same seed gives the same image, bit for bit"}, in(&S::render, &Render::seed)),
       changes(Part::kGeometry,
               choice<S>("precision", {"exact", "fast", "book"},
                         {"",
                          "`exact`: double precision without epsilons. `fast`: single precision. `book`: the book's "
                          "intersection formula with its minimum t, for comparison: sphere by sphere, without SIMD, "
                          "for any `accelerator`",
                          "`fast` trades accuracy for speed; the time of `book` grows with the number of spheres"},
                         in(&S::render, &Render::precision))),
       choice<S>("shading", {"path", "normal", "flat"},
                 {"", "`path`: path tracing. `normal`: surface normals as colours. `flat`: albedo without lighting",
                  "`normal` and `flat`: one ray per sample"},
                 in(&S::render, &Render::shading)),
       changes(
           Part::kGeometry,
           choice<S>(
               "accelerator", {"embree", "list"},
               {"",
                "`embree`: Embree's BVH. `list`: each ray tests every sphere, for comparison. The image is the same, "
                "bit for bit; in `fast` for static spheres up to 10,000 times the scene's size from the origin",
                "`list`: time is proportional to the number of spheres"},
               in(&S::render, &Render::accelerator))),
       choice<S>(
           "traversal", {"auto", "packet", "single"},
           {"",
            "Traversal of Embree's BVH, for comparison: by packets of rays, or ray by ray. `auto`: times both with "
            "rays of the scene and uses the faster. The image is the same, bit for bit",
            "-"},
           in(&S::render, &Render::traversal)),
       changes(
           Part::kLook,
           choice<S>(
               "direct_lighting", {"mis", "bsdf", "light"},
               {"",
                "Sampling of direct light. `mis`: light and BSDF sampling, combined by multiple importance sampling. "
                "`bsdf`: BSDF sampling only, as in the book. `light`: light sampling only, except for reflections in "
                "mirrors and glass and inside emitters, where it is impossible",
                "`mis` and `light`: one shadow ray per vertex on a diffuse material or fuzzy metal; none in scenes "
                "without lights"},
               in(&S::render, &Render::direct_lighting))),
       changes(Part::kLook,
               boolean<S>("caustics",
                          {"",
                           "Sample the light that reaches diffuse surfaces by way of a mirror ball or a ball of clear "
                           "glass, from lamps and the sun. `false`: it is found by BSDF sampling, as without light "
                           "sampling. Has no effect with `direct_lighting = \"bsdf\"`",
                           "2 to 4 rays per vertex on a diffuse material; none in scenes without such a ball or light"},
                          in(&S::render, &Render::caustics))),
       choice<S>("filter", {"box", "gaussian", "blackman-harris", "mitchell"},
                 {"",
                  "Pixel filter. `box`: the area of the pixel, as in the book. `gaussian`, `blackman-harris`: softer. "
                  "`mitchell`: sharper, with negative lobes"},
                 in(&S::render, &Render::filter)),
       otherwise("1 for box, 3 for gaussian and blackman-harris, 4 for mitchell",
                 number<S>("filter_width", {0, kWidestFilter, true, false}, {"px", "Full width of the filter"},
                           in(&S::render, &Render::filter_width)))}};
}

Table annotation_table() {
  return {
      "annotation",
      Part::kOutput,
      {text<S>("title",
               {"",
                "Text at the top left. `{EXPRESSION}` is replaced by the value of an [expression](data.md#expressions) "
                "of `frame` and `step`, the time step in the data file: `t = {step * 0.005:.1f} ps`"},
               in(&S::annotation, &Annotation::title)),
       otherwise("none",
                 number<S>("scale_bar", kLength,
                           {"scene units", "Length of a bar at the bottom left. Requires an orthographic camera"},
                           in(&S::annotation, &Annotation::scale_bar))),
       text<S>("unit", {"", "Text after the length of the scale bar, e.g. `nm`"},
               in(&S::annotation, &Annotation::unit)),
       boolean<S>("color_bar", {"", "Legend of the first points table that is coloured by a column, type or element"},
                  in(&S::annotation, &Annotation::color_bar)),
       number<S>(
           "outline", {0, kWidestOutline},
           {"px",
            "Width of the outlines of objects, drawn at discontinuities of the depth. 0: none. Spheres and rods at "
            "shutter open, seen without a lens",
            "16 rays per pixel"},
           in(&S::annotation, &Annotation::outline)),
       file<S>("font", kFontFile,
               {"", "Font of all texts: a name, or a file relative to the scene file. Default: DejaVu Sans"},
               in(&S::annotation, &Annotation::font))}};
}

Table output_table() {
  std::vector<std::string> layers = layer_names();
  layers.emplace_back(kAllLayers);
  return {
      "output",
      Part::kOutput,
      {key_of<S>("layers", ValueType::kChoices, {},
                 {"",
                  "Layers of EXR files in addition to the beauty image. `all`: every layer that the scene can have, "
                  "except `halves`",
                  "One layer adds about 20 % to the render time of a simple scene, all layers 70 %. Larger files"},
                 in(&S::output, &Output::layers), std::move(layers))}};
}

}  // namespace

const FileRole kPointsFile{"points file", true};
const FileRole kRodsFile{"file of rods", true};
const FileRole kColorMapFile{"colour map", false, [](const std::string& value) {
                               PointsColor color;
                               color.map = value;
                               return color.has_map_file();
                             }};
const FileRole kBackgroundFile{"background image", true};
const FileRole kTextureFile{"texture", true};
const FileRole kFontFile{"font", false,
                         [](const std::string& value) { return value.find_first_of("./\\") != std::string::npos; }};
const FileRole kOcioConfigFile{
    "OCIO config", false, [](const std::string& value) { return !value.empty() && !value.starts_with("ocio://"); }};

std::string Range::text() const {
  if (!from_open && !to_open) return fmt::format("{}..{}", number_text(from), number_text(to));
  return std::string(from_open ? "above " : "at least ") + number_text(from) +
         (to_open ? " and below " : " and at most ") + number_text(to);
}

std::string Range::requirement() const { return (from_open || to_open ? "must be " : "must be in ") + text(); }

const std::vector<Table>& tables() {
  static const std::vector<Table> all = {
      image_table(),
      camera_table(),
      background_table(),
      render_table(),
      {"color",
       Part::kOutput,
       {changes(
            Part::kAssignment,
            text<S>("space",
                    {"", "Colour space of all colours in the scene file: any scene-linear space of the OCIO config"},
                    in(&S::color, &Color::space))),
        changes(Part::kAssignment,
                text<S>("working", {"", "Colour space for rendering and for EXR output. Default: `space`"},
                        in(&S::color, &Color::working))),
        changes(
            Part::kAssignment,
            file<S>(
                "config", kOcioConfigFile,
                {"",
                 "OCIO config, relative to the scene file. Default: `$OCIO`, or the built-in config if it is not set"},
                in(&S::color, &Color::config))),
        text<S>("display", {"", "Display for PNG, TIFF, JPEG and PPM. Default: that of the config"},
                in(&S::color, &Color::display)),
        text<S>("view", {"", "View of the display. Default: that of the display"}, in(&S::color, &Color::view)),
        text<S>("look", {"", "Look to apply before the view"}, in(&S::color, &Color::look)),
        number<S>("exposure", {-kMaxStops, kMaxStops}, {"stops", "Exposure of display output. Does not affect EXR"},
                  in(&S::color, &Color::exposure))}},
      output_table(),
      annotation_table(),
      animation_table()};
  return all;
}

const std::vector<Key<Sphere>>& sphere_keys() {
  static const std::vector<Key<Sphere>> keys = {
      required(vector<Sphere>("center", kAnyLength, {"scene units", "Centre"}, &Sphere::center)),
      required(number<Sphere>(
          "radius", kAnyLength,
          {"scene units", "Radius. Must not be 0. If negative, the normal points inward, for hollow glass"},
          &Sphere::radius)),
      changes(Part::kOutput,
              text<Sphere>("name", {"", "Name in the CryptoObject matte. Default: `sphere.` and the index"},
                           &Sphere::name)),
      changes(Part::kOutput,
              text<Sphere>("group", {"", "CryptoGroup name; objects of a group share one matte"}, &Sphere::group))};
  return keys;
}

const std::vector<Key<Rod>>& rod_keys() {
  static const std::vector<Key<Rod>> keys = {
      required(vector<Rod>("from", kAnyLength, {"scene units", "One end of the axis"}, &Rod::from)),
      required(vector<Rod>("to", kAnyLength,
                           {"scene units", "The other end. May be the same point: the rod is then a sphere"},
                           &Rod::to)),
      required(number<Rod>("radius", kLength, {"scene units", "Radius"}, &Rod::radius)),
      changes(Part::kOutput,
              text<Rod>("name", {"", "Name in the CryptoObject matte. Default: `rod.` and the index"}, &Rod::name)),
      changes(Part::kOutput,
              text<Rod>("group", {"", "CryptoGroup name; objects of a group share one matte"}, &Rod::group))};
  return keys;
}

const std::vector<Key<RodFile>>& rod_file_keys() {
  static const std::vector<Key<RodFile>> keys = {
      required(
          file<RodFile>("file", kRodsFile,
                        {"",
                         "Data file, relative to the scene file, in a format of `[[points]]`, with columns `x0`, "
                         "`y0`, `z0`, `x1`, `y1`, `z1` and `radius`: a rod per row. May contain a frame pattern such "
                         "as `####`",
                         "About 90 bytes per rod, with the BVH"},
                        &RodFile::file)),
      otherwise("as in the file",
                number<RodFile>("radius", kLength, {"scene units", "Radius of all rods"}, &RodFile::radius)),
      changes(Part::kOutput,
              text<RodFile>("name", {"", "Name in the CryptoObject matte, shared by all rods. Default: the file name"},
                            &RodFile::name)),
      changes(Part::kOutput,
              text<RodFile>("group", {"", "CryptoGroup name; objects of a group share one matte"}, &RodFile::group))};
  return keys;
}

}  // namespace orrery::scene
