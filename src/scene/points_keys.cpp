// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include "scene/key_builders.h"

namespace orrery::scene {
namespace {

using P = PointsKeys;

constexpr Range kAnyValue{-kLargestValue, kLargestValue};
constexpr int kMaxFrameOfFile = std::numeric_limits<int>::max();

/// `radius = 1`, or with conditions `radius = { value = 1, where = [...] }`.
Key<PointsRadius> key_of_radius(const char* name, bool has_conditions, KeyDoc doc) {
  Key<PointsRadius> key = otherwise("as in the file", number(name, kLength, std::move(doc), &PointsRadius::value));
  key.get = [=](const PointsRadius& radius) -> std::optional<Value> {
    return radius.value && radius.where.empty() != has_conditions ? std::optional<Value>(*radius.value) : std::nullopt;
  };
  return key;
}

/// `bonds = true` draws bonds by default keys; with other keys, `bonds` is a table of them.
Key<PointsBonds> key_of_bonds() {
  Key<PointsBonds> key = boolean("",
                                 {"Draws bonds as rods between spheres that are drawn, each half with the material and "
                                  "colour of its sphere. A table of the following keys implies `true`"},
                                 &PointsBonds::are_drawn);
  key.get = [](const PointsBonds& bonds) -> std::optional<Value> {
    if (!bonds.are_drawn || bonds.has_keys()) return std::nullopt;
    return true;
  };
  return key;
}

Key<P> clip(const char* name, std::size_t axis, const KeyDoc& about) {
  const auto at = [axis](P& points) -> std::optional<Interval>& { return points.clip[axis]; };
  return otherwise("unlimited", key_at<P>(name, ValueType::kInterval, kAnyLength, about, at));
}

std::vector<Key<P>> make_keys() {
  std::vector<Key<P>> out;
  const auto add = [&](std::vector<Key<P>> keys) { out.insert(out.end(), keys.begin(), keys.end()); };
  add({required(file("file", kPointsFile,
                     {"Data file, relative to the scene file: LAMMPS, XYZ, PDB, mmCIF, CIF, VASP, GRO, XTC, TRR, DCD, "
                      "PLY, CSV, NPY, NPZ, LAS, LAZ, GSD, HDF5 or VTK; see [Data files](data.md). May contain a frame "
                      "pattern such as `####`",
                      "",
                      "Read for each frame. At least 12 bytes of scene data per sphere, excluding the BVH; see "
                      "[Cost](data.md#cost)"},
                     &P::file)),
       otherwise("the rendered frame, if the file has several",
                 integer("frame", {1, kMaxFrameOfFile}, {"Frame of the file, counted from 1"}, &P::frame)),
       otherwise("the only one",
                 integer("component", {0, 1000}, {"HDF5: particle type, N of `PartTypeN`"}, &P::component)),
       file("topology", kTopologyFile,
            {"Data file that names the atoms of a trajectory, relative to the scene file; see [Data "
             "files](data.md#trajectories)"},
            &P::topology)});
  add(subtable("radius", {}, &P::radius,
               {key_of_radius("", false, {"Radius of all spheres. Overrides the radii of the file", "scene units"}),
                key_of_radius("value", true, {"With `where`: radius of the others", "scene units"}),
                text("column", {"Column of the file that holds the radii"}, &PointsRadius::column),
                choice("element", {"vdw", "covalent", "ball"},
                       {"Radii by chemical element, in ångström. `vdw`: van der Waals radii. `covalent`: "
                        "covalent radii. `ball`: a quarter of the van der Waals radii"},
                       &PointsRadius::element),
                key_of("type", ValueType::kNumbersByType, kLength,
                       {"Radii by particle type, e.g. `{ 1 = 0.5, 2 = 0.7 }`. Each type that occurs must be listed",
                        "scene units"},
                       &PointsRadius::types),
                number("scale", {0, kLargestLength, true, false},
                       {"Scale factor for radii from a column or by element, e.g. 0.5 for a column of diameters"},
                       &PointsRadius::scale),
                key_of("where", ValueType::kTexts, {},
                       {"Radii of the spheres that match a [condition](data.md#selections), e.g. `[\"type == 2: "
                        "0.5\"]`. The last that matches decides, with precedence over the other radii"},
                       &PointsRadius::where)}));
  add(subtable(
      "color", Part::kAssignment, &P::color,
      {text("column",
            {"Column of the file that `color.map` maps to colours, or an [expression](data.md#expressions) such as "
             "`sqrt(vx^2 + vy^2)`"},
            &PointsColor::column),
       file("map", kColorMapFile,
            {"Colour map: the name of a built-in map, or a text file relative to the scene file; see [Data "
             "files](data.md#colour)"},
            &PointsColor::map),
       otherwise("minimum and maximum of the frame",
                 key_of("range", ValueType::kInterval, kAnyValue,
                        {"Values of the column at both ends of the map, e.g. `[-2, 2]`"}, &PointsColor::range)),
       boolean("log", {"The map is linear in the logarithms of the values. Those up to 0 have `color.nan_color`"},
               &PointsColor::log),
       vector("nan_color", {0, 1}, {"Colour of NaN values", "scene-linear"}, &PointsColor::nan_color),
       choice(
           "element", {"jmol", "soft"},
           {"Colours by chemical element. `jmol`: those of Jmol, with hydrogen in light grey. `soft`: the same, mixed "
            "with white"},
           &PointsColor::element),
       text("carbon", {"With `color.element`: carbon atoms have the colours of this column, by `color.map`"},
            &PointsColor::carbon),
       key_of("type", ValueType::kColorsByType, kUnit,
              {"Colours by particle type. Each type that occurs must be listed", "scene-linear"}, &PointsColor::types),
       boolean("rgb", {"Uses the colours in the file, as sRGB"}, &PointsColor::rgb),
       key_of(
           "where", ValueType::kTexts, {},
           {"Colours of the spheres that match a [condition](data.md#selections), e.g. `[\"type == 2: red\", "
            "\"id == 5: #ffaa00\"]`, as sRGB. The last that matches decides, with precedence over the other colours"},
           &PointsColor::where)}));
  add(subtable(
      "bonds", {}, &P::bonds,
      {otherwise("false", key_of_bonds()),
       choice("from", {"file", "distance", "both"},
              {"Which pairs are bonded: those of the file, those that are close, or both. The default depends "
               "on the file; see [Bonds](data.md#bonds)"},
              &PointsBonds::from),
       otherwise("1.2, unless `length` is set", number("factor", {0, kLargestBondFactor, true, false},
                                                       {"By distance: a pair is bonded if it is closer than the sum of "
                                                        "its covalent radii in ångström, multiplied by this"},
                                                       &PointsBonds::factor)),
       otherwise("none", number("length", kLength,
                                {"By distance: a pair is bonded if it is closer than this", "unit of the file"},
                                &PointsBonds::length)),
       otherwise("0.15 if the file has elements, else 0.3 times the mean radius of the spheres",
                 number("radius", kLength,
                        {"Radius of the rods. `transform.scale` applies", "unit of the file",
                         "About 40 bytes per bond, with the BVH"},
                        &PointsBonds::radius))}));
  add(subtable(
      "vectors", {}, &P::vectors,
      {key_of("columns", ValueType::kTexts, {},
              {"Draws an arrow at each sphere: columns of the x, y and z component of its vector, e.g. `[\"vx\", "
               "\"vy\", \"vz\"]`",
               "", "12 more spheres and a rod for each arrow"},
              &PointsVectors::columns),
       number("scale", {0, kLargestLength, true, false},
              {"Length of an arrow, in the unit of the file, divided by that of its vector"}, &PointsVectors::scale),
       otherwise("as `bonds.radius`",
                 number("radius", kLength,
                        {"Radius of the shafts. Vectors no longer than twice this have no arrow", "unit of the file"},
                        &PointsVectors::radius))}));
  add(subtable(
      "motion", {}, &P::motion,
      {boolean("next_frame",
               {"While the shutter is open, spheres move towards their places in the next frame of the file; see "
                "[Motion](data.md#motion)",
                "", "Reads the next frame. 44 to 56 bytes per sphere"},
               &PointsMotion::next_frame),
       key_of("columns", ValueType::kTexts, {},
              {"Spheres move by velocities: columns of the x, y and z component, e.g. `[\"vx\", \"vy\", \"vz\"]`. "
               "Default: the velocities of the file, if `frame_time` is set"},
              &PointsMotion::columns),
       otherwise("none", number("frame_time", {0, kLargestLength, true, false},
                                {"Time between two frames, which multiplies the velocities", "time of the file"},
                                &PointsMotion::frame_time))}));
  add(subtable(
      "opacity", Part::kAssignment, &P::opacity,
      {otherwise("those of the materials",
                 number("", kUnit,
                        {"Opacity of all spheres, in place of that of the material; see [Opacity](#opacity)", "",
                         "Below 1: more noise, and 4 bytes per sphere"},
                        &PointsOpacity::value)),
       text("column", {"Column of the file that holds the opacities, 0..1"}, &PointsOpacity::column),
       key_of("type", ValueType::kNumbersByType, kUnit,
              {"Opacities by particle type, e.g. `{ 2 = 0.2 }`. Types that are not listed have that of the material"},
              &PointsOpacity::types),
       key_of("where", ValueType::kTexts, {},
              {"Opacities of the spheres that match a [condition](data.md#selections), e.g. `[\"type == 2: 0.2\"]`. A "
               "number alone matches all. The last that matches decides, with precedence over the other opacities"},
              &PointsOpacity::where)}));
  add({key_of("representation", ValueType::kTexts, {},
              {"How the particles that match a [condition](data.md#selections) are drawn: `spheres`, `ball-and-stick`, "
               "`sticks`, `trace` or `points`, e.g. `[\"trace\", \"residue HEM: sticks\"]`. A kind alone matches all. "
               "The last that matches decides; see [Representations](data.md#representations)"},
              &P::representation),
       text("select", {"Condition on the columns, e.g. `type == 2 && z > 0`; see [Selections](data.md#selections)"},
            &P::select),
       vector("replicate", {1, kMaxCopies},
              {"Number of periodic boxes along each box edge", "", "Each copy adds its spheres"}, &P::replicate),
       boolean(
           "unwrap",
           {"Unwraps coordinates with the file's periodic image flags, or else makes molecules whole by their bonds"},
           &P::unwrap),
       key_of("assembly", ValueType::kName, {},
              {"PDB and mmCIF: name of a biological assembly", "", "Each copy adds its spheres"}, &P::assembly)});
  add(subtable("transform", {}, &P::transform,
               {number("scale", {0, kLargestLength, true, false}, {"Scale factor of coordinates and radii"},
                       &PointsTransform::scale),
                vector("rotate", {-kLargestRotation, kLargestRotation},
                       {"Rotation about the x axis, then y, then z; applied after the scale", "degrees"},
                       &PointsTransform::rotate),
                vector("translate", kAnyLength, {"Translation, applied after the rotation", "scene units"},
                       &PointsTransform::translate)}));
  add({changes(Part::kAssignment,
               key_of("material_where", ValueType::kTexts, {},
                      {"Materials of the spheres that match a [condition](data.md#selections), e.g. `[\"residue HEM: "
                       "glass\"]`. The last that matches decides, with precedence over `material` and "
                       "`material_column`",
                       "", "4 bytes per sphere"},
                      &P::material_where)),
       clip("clip.x", 0,
            {"Keeps spheres with centres in this interval, after replication and transform", "scene units"}),
       clip("clip.y", 1, {"As `clip.x`", "scene units"}), clip("clip.z", 2, {"As `clip.x`", "scene units"}),
       changes(Part::kAssignment, text("material_column",
                                       {"PLY: column of indices into the scene's materials, counted from 0 in the "
                                        "order of the scene file. `\"\"`: none"},
                                       &P::material_column)),
       key_of("labels", ValueType::kTexts, {},
              {"Texts in the image, each at the middle of the particles that match a [condition](data.md#selections): "
               "`[\"id == 5: Fe\"]`"},
              &P::labels),
       changes(Part::kAssignment,
               key_of("cryptomatte", ValueType::kTexts, {},
                      {"Columns that divide the file into objects of the CryptoObject matte: `[\"chain\"]` makes one "
                       "for each chain, named after the file and the chain with a dot between. Several columns: one "
                       "for each combination of their values",
                       "", "4 bytes per sphere"},
                      &P::cryptomatte)),
       boolean("skip_bad", {"Skips rows with non-finite coordinates or radii"}, &P::skip_bad),
       changes(Part::kOutput, text("name",
                                   {"Name in the CryptoObject matte, shared by all spheres of the file; see "
                                    "`cryptomatte`. Default: the file name"},
                                   &P::name)),
       changes(Part::kOutput, text("group", {"CryptoGroup name; objects of a group share one matte"}, &P::group))});
  return out;
}

}  // namespace

const std::vector<Key<PointsKeys>>& points_keys() {
  static const std::vector<Key<PointsKeys>> keys = make_keys();
  return keys;
}

}  // namespace orrery::scene
