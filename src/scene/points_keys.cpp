// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include "scene/key_builders.h"
#include "scene/limits.h"
#include "scene/schema.h"

namespace orrery::scene {
namespace {

using P = Points;

constexpr Range kAnyValue{-kLargestValue, kLargestValue};
constexpr int kMaxFrameOfFile = std::numeric_limits<int>::max();

/// `bonds = true` draws bonds by default keys; with other keys, `bonds` is a table of them.
Key<P> key_of_bonds() {
  Key<P> key = boolean<P>("bonds",
                          {"",
                           "Draws bonds as rods between spheres that are drawn, each half with the material and "
                           "colour of its sphere. A table of the following keys is the same as `true`"},
                          in(&P::bonds, &PointsBonds::are_drawn));
  key.get = [](const P& points) -> std::optional<Value> {
    if (!points.bonds.are_drawn || points.bonds.has_keys()) return std::nullopt;
    return true;
  };
  return key;
}

std::vector<Key<P>> make_keys() {
  std::vector<Key<P>> keys = {
      required(file<P>("file", kPointsFile,
                       {"",
                        "Data file, relative to the scene file: LAMMPS, XYZ, PDB, mmCIF, PLY, CSV, NPY, NPZ, LAS, GSD, "
                        "HDF5 or VTK; see [Data files](data.md). May contain a frame pattern such as `####`",
                        "Read for each frame. At least 12 bytes of scene data per sphere, excluding the BVH; see "
                        "[Cost](data.md#cost)"},
                       &P::file)),
      otherwise("the rendered frame, if the file has several",
                integer<P>("frame", {1, kMaxFrameOfFile}, {"", "Frame of the file, counted from 1"}, &P::frame)),
      otherwise("the only one",
                integer<P>("component", {0, 1000}, {"", "HDF5: particle type, N of `PartTypeN`"}, &P::component)),
      otherwise("as in the file",
                number<P>("radius", kLength, {"scene units", "Radius of all spheres. Overrides the radii of the file"},
                          in(&P::radius, &PointsRadius::value))),
      text<P>("radius.column", {"", "Column of the file that holds the radii"}, in(&P::radius, &PointsRadius::column)),
      choice_of_text<P>(
          "radius.element", {"vdw", "covalent", "ball"},
          {"",
           "Radii by chemical element, in ångström. `vdw`: van der Waals radii. `covalent`: covalent radii. "
           "`ball`: a quarter of the van der Waals radii"},
          in(&P::radius, &PointsRadius::element)),
      key_of<P>(
          "radius.type", ValueType::kNumbersByType, kLength,
          {"scene units", "Radii by particle type, e.g. `{ 1 = 0.5, 2 = 0.7 }`. Each type that occurs must be listed"},
          in(&P::radius, &PointsRadius::types)),
      number<P>("radius.scale", {0, kLargestLength, true, false},
                {"", "Scale factor for radii from a column or by element, e.g. 0.5 for a column of diameters"},
                in(&P::radius, &PointsRadius::scale)),
      changes(Part::kAssignment, text<P>("color.column",
                                         {"",
                                          "Column of the file that `color.map` maps to colours, or an "
                                          "[expression](data.md#expressions) such as `sqrt(vx^2 + vy^2)`"},
                                         in(&P::color, &PointsColor::column))),
      changes(Part::kAssignment,
              file<P>("color.map", kColorMapFile,
                      {"",
                       "Colour map: the name of a built-in map, or a text file relative to the scene file; see "
                       "[Data files](data.md#colour)"},
                      in(&P::color, &PointsColor::map))),
      changes(Part::kAssignment,
              otherwise("minimum and maximum of the frame",
                        interval<P>("color.range", kAnyValue,
                                    {"", "Values of the column at both ends of the map, e.g. `[-2, 2]`"},
                                    in(&P::color, &PointsColor::range)))),
      changes(
          Part::kAssignment,
          boolean<P>("color.log",
                     {"", "The map is linear in the logarithms of the values. Those up to 0 have `color.nan_color`"},
                     in(&P::color, &PointsColor::log))),
      changes(Part::kAssignment, vector<P>("color.nan_color", {0, 1}, {"scene-linear", "Colour of NaN values"},
                                           in(&P::color, &PointsColor::nan_color))),
      changes(Part::kAssignment,
              choice_of_text<P>("color.element", {"jmol"},
                                {"", "Colours by chemical element. `jmol`: those of Jmol, with hydrogen in light grey"},
                                in(&P::color, &PointsColor::element))),
      changes(Part::kAssignment,
              key_of<P>("color.type", ValueType::kColorsByType, kUnit,
                        {"scene-linear", "Colours by particle type. Each type that occurs must be listed"},
                        in(&P::color, &PointsColor::types))),
      changes(Part::kAssignment,
              boolean<P>("color.rgb", {"", "Uses the colours in the file, as sRGB"}, in(&P::color, &PointsColor::rgb))),
      otherwise("false", key_of_bonds()),
      choice_of_text<P>(
          "bonds.from",
          {"file", "distance", "both"},
          {"",
           "Which pairs are bonded: those of the file, those that are close, or both. The default depends on the file; "
           "see [Bonds](data.md#bonds)"},
          in(&P::bonds, &PointsBonds::from)),
      otherwise("1.2, unless `length` is set",
                number<P>("bonds.factor", {0, kLargestBondFactor, true, false},
                          {"",
                           "By distance: a pair is bonded if it is closer than the sum of its covalent radii in "
                           "ångström, multiplied by this"},
                          in(&P::bonds, &PointsBonds::factor))),
      otherwise("none", number<P>("bonds.length", kLength,
                                  {"unit of the file", "By distance: a pair is bonded if it is closer than this"},
                                  in(&P::bonds, &PointsBonds::length))),
      otherwise("0.15 if the file has elements, else 0.3 times the mean radius of the spheres",
                number<P>("bonds.radius", kLength,
                          {"unit of the file", "Radius of the rods. `transform.scale` applies",
                           "About 40 bytes per bond, with the BVH"},
                          in(&P::bonds, &PointsBonds::radius))),
      key_of<P>("vectors.columns", ValueType::kTexts, {},
                {"",
                 "Draws an arrow at each sphere: columns of the x, y and z component of its vector, e.g. "
                 "`[\"vx\", \"vy\", \"vz\"]`",
                 "12 more spheres and a rod for each arrow"},
                in(&P::vectors, &PointsVectors::columns)),
      number<P>("vectors.scale", {0, kLargestLength, true, false},
                {"", "Length of an arrow, in the unit of the file, divided by that of its vector"},
                in(&P::vectors, &PointsVectors::scale)),
      otherwise("as `bonds.radius`",
                number<P>("vectors.radius", kLength,
                          {"unit of the file", "Radius of the shafts. Vectors no longer than twice this have no arrow"},
                          in(&P::vectors, &PointsVectors::radius))),
      changes(
          Part::kAssignment,
          otherwise("those of the materials",
                    number<P>("opacity", kUnit,
                              {"", "Opacity of all spheres, in place of that of the material; see [Opacity](#opacity)",
                               "Below 1: more noise, and 4 bytes per sphere"},
                              in(&P::opacity, &PointsOpacity::value)))),
      changes(Part::kAssignment, text<P>("opacity.column", {"", "Column of the file that holds the opacities, 0..1"},
                                         in(&P::opacity, &PointsOpacity::column))),
      changes(Part::kAssignment,
              key_of<P>("opacity.type", ValueType::kNumbersByType, kUnit,
                        {"",
                         "Opacities by particle type, e.g. `{ 2 = 0.2 }`. Types that are not listed have that of the "
                         "material"},
                        in(&P::opacity, &PointsOpacity::types))),
      changes(Part::kAssignment,
              key_of<P>("opacity.where", ValueType::kTexts, {},
                        {"",
                         "Opacities of the spheres that match a [condition](data.md#selections), e.g. "
                         "`[\"type == 2: 0.2\"]`. A number alone matches all. The last that matches decides, before "
                         "the other opacities"},
                        in(&P::opacity, &PointsOpacity::where))),
      text<P>("select",
              {"", "Condition on the columns, e.g. `type == 2 && z > 0`; see [Selections](data.md#selections)"},
              &P::select),
      vector<P>("replicate", {1, kMaxCopies},
                {"", "Number of periodic boxes along each box edge", "Each copy adds its spheres"}, &P::replicate),
      boolean<P>("unwrap", {"", "Unwraps coordinates with the file's periodic image flags"}, &P::unwrap),
      key_of<P>("assembly", ValueType::kName, {},
                {"", "PDB and mmCIF: name of a biological assembly", "Each copy adds its spheres"}, &P::assembly),
      number<P>("transform.scale", {0, kLargestLength, true, false}, {"", "Scale factor of coordinates and radii"},
                in(&P::transform, &PointsTransform::scale)),
      vector<P>("transform.rotate", {-kLargestRotation, kLargestRotation},
                {"degrees", "Rotation about the x axis, then y, then z; applied after the scale"},
                in(&P::transform, &PointsTransform::rotate)),
      vector<P>("transform.translate", kAnyLength, {"scene units", "Translation, applied after the rotation"},
                in(&P::transform, &PointsTransform::translate)),
      otherwise(
          "unlimited",
          interval<P>("clip.x", kAnyLength,
                      {"scene units", "Keeps spheres with centres in this interval, after replication and transform"},
                      [](P& p) -> std::optional<Interval>& { return p.clip[0]; })),
      otherwise("unlimited", interval<P>("clip.y", kAnyLength, {"scene units", "As `clip.x`"},
                                         [](P& p) -> std::optional<Interval>& { return p.clip[1]; })),
      otherwise("unlimited", interval<P>("clip.z", kAnyLength, {"scene units", "As `clip.x`"},
                                         [](P& p) -> std::optional<Interval>& { return p.clip[2]; })),
      changes(Part::kAssignment, text<P>("material_column",
                                         {"",
                                          "PLY: column of indices into the scene's materials, counted from 0 in the "
                                          "order of the scene file. `\"\"`: "
                                          "none"},
                                         &P::material_column)),
      key_of<P>("labels", ValueType::kTexts, {},
                {"",
                 "Texts in the image, each at the middle of the particles that match a "
                 "[condition](data.md#selections): `[\"id == 5: Fe\"]`"},
                &P::labels),
      changes(
          Part::kAssignment,
          key_of<P>("cryptomatte", ValueType::kTexts, {},
                    {"",
                     "Columns that divide the file into objects of the CryptoObject matte: `[\"chain\"]` makes one of "
                     "each chain, with the name of the file, a dot and the name of the chain. Several columns: one "
                     "for each combination of their values",
                     "4 bytes per sphere"},
                    &P::cryptomatte)),
      boolean<P>("skip_bad", {"", "Skips rows with non-finite coordinates or radii"}, &P::skip_bad),
      changes(Part::kOutput, text<P>("name",
                                     {"",
                                      "Name in the CryptoObject matte, shared by all spheres of the file; see "
                                      "`cryptomatte`. Default: the file name"},
                                     &P::name)),
      changes(Part::kOutput,
              text<P>("group", {"", "CryptoGroup name; objects of a group share one matte"}, &P::group))};
  return keys;
}

}  // namespace

const std::vector<Key<Points>>& points_keys() {
  static const std::vector<Key<Points>> keys = make_keys();
  return keys;
}

}  // namespace orrery::scene
