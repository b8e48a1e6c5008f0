// SPDX-License-Identifier: Apache-2.0
#include "scene/schema.h"

#include <limits>

#include "scene/key_builders.h"
#include "scene/layers.h"
#include "scene/limits.h"

namespace orrery::scene {
namespace {

constexpr Range kAnyLength{-kLargestLength, kLargestLength};
constexpr Range kLength{kSmallestRadius, kLargestLength};
constexpr Range kUnit{0, 1};
constexpr Range kLight{0, kBrightestBackground};

using S = Scene;

Table image_table() {
  const char* const cost = "time and memory in proportion";
  return {"image",
          {integer<S>("width", {1, kLargestSide}, {"px", "pixels in a row", cost},
                      [](S& s) -> int& { return s.image.width; }),
           integer<S>("height", {1, kLargestSide}, {"px", "rows", cost}, [](S& s) -> int& { return s.image.height; }),
           number<S>("pixel_aspect", {0.1, 10}, {"", "width of a pixel by its height, as the screen will show it"},
                     [](S& s) -> double& { return s.image.pixel_aspect; }),
           optional_window<S>("crop",
                              {"px",
                               "[x, y, width, height]: only this part of the frame is rendered; its pixels are "
                               "those of the whole, bit for bit; not together with `overscan`"},
                              "the whole frame", [](S& s) -> std::optional<Window>& { return s.image.crop; }),
           integer<S>("overscan", {0, kWidestOverscan},
                      {"px", "rows and columns beyond each edge of the frame; not together with `crop`", cost},
                      [](S& s) -> int& { return s.image.overscan; })}};
}

Table camera_table() {
  return {"camera",
          {vector<S>("look_from", kAnyLength, {"scene units", "where the camera stands; may be inside of a sphere"},
                     [](S& s) -> Vec3d& { return s.camera.look_from; }),
           vector<S>("look_at", kAnyLength, {"scene units", "the point in the middle of the picture"},
                     [](S& s) -> Vec3d& { return s.camera.look_at; }),
           vector<S>("up", kAnyLength, {"any length", "what is up in the picture; not parallel to the view"},
                     [](S& s) -> Vec3d& { return s.camera.up; }),
           number<S>("vfov", {0, 180, true, true}, {"degrees", "angle of view from the lower edge to the upper one"},
                     [](S& s) -> double& { return s.camera.vfov; }),
           number<S>("defocus_angle", {0, 180, false, true},
                     {"degrees", "apex angle of the cone from a point in focus to the rim of the lens; 0 is a pinhole",
                      "above 0 one lens sample for each path"},
                     [](S& s) -> double& { return s.camera.defocus_angle; }),
           optional_number<S>("focus_distance", kLength, {"scene units", "distance of the plane that is in focus"},
                              "distance to look_at",
                              [](S& s) -> std::optional<double>& { return s.camera.focus_distance; }),
           number<S>("shutter_open", {-kLongestShutter, kLongestShutter},
                     {"frames", "when the shutter opens, counted from the frame's own time"},
                     [](S& s) -> double& { return s.camera.shutter_open; }),
           number<S>("shutter_close", {-kLongestShutter, kLongestShutter},
                     {"frames", "when it closes; later than `shutter_open`: what moves meanwhile is blurred",
                      "only where something moves: a random number more at each vertex, and boxes that move"},
                     [](S& s) -> double& { return s.camera.shutter_close; })}};
}

Table animation_table() {
  return {"animation",
          {number<S>("fps", {0.001, 1000}, {"frames per second", "told in the header of an EXR"},
                     [](S& s) -> double& { return s.animation.fps; }),
           number<S>("turntable", {-kMostFrames, kMostFrames},
                     {"frames",
                      "in which the camera turns once around `look_at`, about `up`, to the right from frame 1 "
                      "on; below 0 to the left; 0: it stands"},
                     [](S& s) -> double& { return s.animation.turntable; })}};
}

Table background_table() {
  const char* const unit = "scene-linear";
  return {
      "background",
      {choice<S>("type", {"gradient", "constant"},
                 {"", "`gradient`: from `bottom` to `top`, linear in the height of the direction; `constant`: `color`"},
                 [](S& s) -> BackgroundType& { return s.background.type; }),
       vector<S>("bottom", kLight, {unit, "gradient: light from straight below"},
                 [](S& s) -> Vec3d& { return s.background.bottom; }),
       vector<S>("top", kLight, {unit, "gradient: light from straight above"},
                 [](S& s) -> Vec3d& { return s.background.top; }),
       vector<S>("color", kLight, {unit, "constant: light from everywhere"},
                 [](S& s) -> Vec3d& { return s.background.color; }),
       integer<S>("alpha", {0, 1},
                  {"", "1: the background is part of the picture; 0: the picture is empty where nothing else is seen",
                   "0: as much as a layer"},
                  [](S& s) -> int& { return s.background.alpha; })}};
}

Table render_table() {
  return {
      "render",
      {integer<S>("samples", {1, std::numeric_limits<std::int32_t>::max()},
                  {"per pixel", "paths for each pixel", "time in proportion; four times as many halve the noise"},
                  [](S& s) -> int& { return s.render.samples; }),
       integer<S>("max_depth", {1, kDeepestPath},
                  {"rays",
                   "most rays of a path, counted as in the book: the camera ray is the first; a path whose last "
                   "ray hits a sphere is black",
                   "a bound only: most paths leave the scene earlier"},
                  [](S& s) -> int& { return s.render.max_depth; }),
       integer<S>("roulette_depth", {0, kDeepestPath},
                  {"scattering events",
                   "from here on a path is ended by chance, the less light it can still bring the likelier, and counts "
                   "for more if it is not; without bias; 0: never",
                   "0: a little to twice the time, the more is dark the more"},
                  [](S& s) -> int& { return s.render.roulette_depth; }),
       choice<S>("sampler", {"independent", "sobol", "blue-noise"},
                 {"",
                  "how the random numbers of a pixel's paths go together: `independent`: not at all, as in the book; "
                  "`sobol`: evenly spread; `blue-noise`: so that neighbouring pixels' errors differ, too",
                  "`sobol` and `blue-noise` need fewer samples for the same error"},
                 [](S& s) -> Sampler& { return s.render.sampler; }),
       integer<S>("seed", {0, std::numeric_limits<std::uint32_t>::max()},
                  {"", "chooses the random numbers; the same seed gives the same picture, bit for bit"},
                  [](S& s) -> std::uint32_t& { return s.render.seed; }),
       choice<S>(
           "precision", {"exact", "fast", "book"},
           {"", "`exact`: double without any epsilon; `fast`: float; `book`: the book's formula with its smallest t",
            "`fast` and `book` trade accuracy for time"},
           [](S& s) -> Precision& { return s.render.precision; }),
       choice<S>("shading", {"path", "normal", "flat"},
                 {"", "`path`: light; `normal`: normals as colour; `flat`: the albedo, without light",
                  "`normal` and `flat` follow no light, one ray for each sample"},
                 [](S& s) -> Shading& { return s.render.shading; }),
       choice<S>("accelerator", {"embree", "list"},
                 {"", "`list`: each ray tries each sphere, for comparison; the picture is the same, bit for bit",
                  "`list`: time in proportion to the number of spheres"},
                 [](S& s) -> Accelerator& { return s.render.accelerator; }),
       choice<S>("filter", {"box", "gaussian", "blackman-harris", "mitchell"},
                 {"",
                  "how a pixel weighs what is around its middle: `box`, as in the book: its own square; `gaussian` and "
                  "`blackman-harris` softer; `mitchell` sharper, with negative lobes"},
                 [](S& s) -> Filter& { return s.render.filter; }),
       optional_number<S>("filter_width", {0, kWidestFilter, true, false},
                          {"px", "width of the filter from end to end"},
                          "1 for box, 3 for gaussian and blackman-harris, 4 for mitchell",
                          [](S& s) -> std::optional<double>& { return s.render.filter_width; })}};
}

Table output_table() {
  return {"output",
          {choices<S>("layers",
                      {"Z", "depth", "N", "P", "albedo", "diffuse", "specular", "transmission", "background",
                       "variance", "samples", "object_id", "material_id", "denoise.albedo", "denoise.normal",
                       "CryptoObject", "CryptoMaterial", "CryptoGroup", kAllLayers},
                      {"", "what an EXR holds beside the beauty; `all`: every layer that the scene can have",
                       "one a tenth to a fifth of the time, all of them two fifths; files grow"},
                      [](S& s) -> std::vector<std::string>& { return s.output.layers; })}};
}

std::vector<MaterialType> make_material_types() {
  using M = MaterialModel;
  const KeyDoc albedo{"scene-linear", "share of the light that is scattered, by colour"};
  return {
      {"lambertian",
       "diffuse: light leaves by the cosine law",
       Lambertian{},
       {required(vector<M>("albedo", kUnit, albedo, [](M& m) -> Vec3d& { return std::get<Lambertian>(m).albedo; }))}},
      {"hemisphere",
       "the book's first diffuse: light leaves evenly over the hemisphere",
       Hemisphere{},
       {required(vector<M>("albedo", kUnit, albedo, [](M& m) -> Vec3d& { return std::get<Hemisphere>(m).albedo; }))}},
      {"metal",
       "mirror, sharp or fuzzy",
       Metal{},
       {required(vector<M>("albedo", kUnit, albedo, [](M& m) -> Vec3d& { return std::get<Metal>(m).albedo; })),
        number<M>("fuzz", kUnit,
                  {"",
                   "radius of the sphere around the tip of the unit mirror direction; reflections end on its surface, "
                   "and those that point into the metal are absorbed; 0 is a sharp mirror"},
                  [](M& m) -> double& { return std::get<Metal>(m).fuzz; })}},
      {"dielectric",
       "clear glass, water, air in water",
       Dielectric{},
       {number<M>("ior", {1e-6, 1e6}, {"", "refractive index of the inside, relative to what is around"},
                  [](M& m) -> double& { return std::get<Dielectric>(m).ior; }),
        choice<M>("fresnel", {"schlick", "exact", "none"},
                  {"",
                   "share of the light that is reflected: `schlick`, as in the book; `exact`; `none`: all is refracted "
                   "unless reflected totally"},
                  [](M& m) -> Fresnel& { return std::get<Dielectric>(m).fresnel; })}},
  };
}

}  // namespace

std::string window_text(const Window& w) {
  return "[" + std::to_string(w.x) + ", " + std::to_string(w.y) + ", " + std::to_string(w.width) + ", " +
         std::to_string(w.height) + "]";
}

std::string Range::text() const {
  if (!from_open && !to_open) return number_text(from) + ".." + number_text(to);
  return std::string(from_open ? "above " : "from ") + number_text(from) + (to_open ? ", below " : ", up to ") +
         number_text(to);
}

const std::vector<Table>& tables() {
  static const std::vector<Table> all = {
      image_table(),
      camera_table(),
      background_table(),
      render_table(),
      {"color",
       {text<S>("space", {"", "name of the colour space of all colours here: any scene-linear one of the OCIO config"},
                [](S& s) -> std::string& { return s.color.space; }),
        text<S>("working", {"", "colour space in which light is reckoned, and of the EXR; default: `space`"},
                [](S& s) -> std::string& { return s.color.working; }),
        text<S>("config",
                {"", "OCIO config, relative to the scene file; default: `$OCIO`, and without it the built-in one"},
                [](S& s) -> std::filesystem::path& { return s.color.config; }),
        text<S>("display", {"", "display for PNG, TIFF, JPEG and PPM; default: the config's"},
                [](S& s) -> std::string& { return s.color.display; }),
        text<S>("view", {"", "view of that display; default: the display's"},
                [](S& s) -> std::string& { return s.color.view; }),
        text<S>("look", {"", "look to apply before the view"}, [](S& s) -> std::string& { return s.color.look; }),
        number<S>("exposure", {-kMaxStops, kMaxStops},
                  {"stops", "to brighten what a display shows; an EXR stays as it is"},
                  [](S& s) -> double& { return s.color.exposure; })}},
      output_table(),
      animation_table()};
  return all;
}

const std::vector<MaterialType>& material_types() {
  static const std::vector<MaterialType> all = make_material_types();
  return all;
}

const std::vector<Key<Sphere>>& sphere_keys() {
  static const std::vector<Key<Sphere>> keys = {
      required(vector<Sphere>("center", kAnyLength, {"scene units", "where it is"},
                              [](Sphere& s) -> Vec3d& { return s.center; })),
      required(number<Sphere>("radius", kAnyLength,
                              {"scene units", "its size; not 0; below 0 the normal points inward: hollow glass"},
                              [](Sphere& s) -> double& { return s.radius; })),
      text<Sphere>("name", {"", "for mattes; default: `sphere.` and its number"},
                   [](Sphere& s) -> std::string& { return s.name; }),
      text<Sphere>("group", {"", "for mattes: what has the same name is one thing"},
                   [](Sphere& s) -> std::string& { return s.group; })};
  return keys;
}

const std::vector<Key<Points>>& points_keys() {
  static const std::vector<Key<Points>> keys = [] {
    auto file = required(text<Points>(
        "file", {"", "PLY file, relative to the scene file", "one read; 32 bytes a sphere, 36 with materials"},
        [](Points& p) -> std::filesystem::path& { return p.file; }));
    return std::vector<Key<Points>>{
        file,
        optional_number<Points>("radius", kLength, {"scene units", "radius of every sphere, whatever the file says"},
                                "as in the file", [](Points& p) -> std::optional<double>& { return p.radius; }),
        text<Points>("name", {"", "for mattes: all spheres of the file are one thing; default: the file's name"},
                     [](Points& p) -> std::string& { return p.name; }),
        text<Points>("group", {"", "for mattes: what has the same name is one thing"},
                     [](Points& p) -> std::string& { return p.group; })};
  }();
  return keys;
}

}  // namespace orrery::scene
