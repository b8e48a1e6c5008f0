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

std::vector<Key<P>> make_keys() {
  std::vector<Key<P>> keys = {
      required(text<P>("file",
                       {"",
                        "Data file, relative to the scene file: LAMMPS, XYZ, PDB, mmCIF, PLY, CSV, NPY, NPZ, LAS, GSD, "
                        "HDF5 or VTK; see [Data files](data.md). May contain a frame pattern such as `####`",
                        "Read for each frame. At least 12 bytes of scene data per sphere, excluding the BVH; see "
                        "[Cost](data.md#cost)"},
                       [](P& p) -> std::filesystem::path& { return p.file; })),
      optional_integer<P>("frame", {1, kMaxFrameOfFile}, {"", "Frame of the file, counted from 1"},
                          "the rendered frame, if the file has several",
                          [](P& p) -> std::optional<int>& { return p.frame; }),
      optional_integer<P>("component", {0, 1000}, {"", "HDF5: particle type, N of `PartTypeN`"}, "the only one",
                          [](P& p) -> std::optional<int>& { return p.component; }),
      optional_number<P>("radius", kLength, {"scene units", "Radius of all spheres. Overrides the radii of the file"},
                         "as in the file", [](P& p) -> std::optional<double>& { return p.radius.value; }),
      text<P>("radius.column", {"", "Column of the file that holds the radii"},
              [](P& p) -> std::string& { return p.radius.column; }),
      choice_of_text<P>(
          "radius.element", {"vdw", "covalent", "ball"},
          {"",
           "Radii by chemical element, in ångström. `vdw`: van der Waals radii. `covalent`: covalent radii. "
           "`ball`: a quarter of the van der Waals radii"},
          [](P& p) -> std::string& { return p.radius.element; }),
      number<P>("radius.scale", {0, kLargestLength, true, false},
                {"", "Scale factor for radii from a column or by element, e.g. 0.5 for a column of diameters"},
                [](P& p) -> double& { return p.radius.scale; }),
      changes(Part::kAssignment, text<P>("color.column", {"", "Column of the file that `color.map` maps to colours"},
                                         [](P& p) -> std::string& { return p.color.column; })),
      changes(Part::kAssignment,
              text<P>("color.map",
                      {"",
                       "Colour map: the name of a built-in map, or a text file relative to the scene file; see "
                       "[Data files](data.md#colour)"},
                      [](P& p) -> std::string& { return p.color.map; })),
      changes(Part::kAssignment,
              optional_interval<P>(
                  "color.range", kAnyValue, {"", "Values of the column at both ends of the map, e.g. `[-2, 2]`"},
                  "minimum and maximum of the frame", [](P& p) -> std::optional<Interval>& { return p.color.range; })),
      changes(Part::kAssignment, vector<P>("color.nan_color", {0, 1}, {"scene-linear", "Colour of NaN values"},
                                           [](P& p) -> Vec3d& { return p.color.nan_color; })),
      changes(Part::kAssignment,
              choice_of_text<P>("color.element", {"jmol"},
                                {"", "Colours by chemical element. `jmol`: those of Jmol, with hydrogen in light grey"},
                                [](P& p) -> std::string& { return p.color.element; })),
      changes(Part::kAssignment, boolean<P>("color.rgb", {"", "Uses the colours in the file, as sRGB"},
                                            [](P& p) -> bool& { return p.color.rgb; })),
      text<P>("select",
              {"", "Condition on the columns, e.g. `type == 2 && z > 0`; see [Selections](data.md#selections)"},
              [](P& p) -> std::string& { return p.select; }),
      vector<P>("replicate", {1, kMaxCopies},
                {"", "Number of periodic boxes along each box edge", "Each copy adds its spheres"},
                [](P& p) -> Vec3d& { return p.replicate; }),
      boolean<P>("unwrap", {"", "Unwraps coordinates with the file's periodic image flags"},
                 [](P& p) -> bool& { return p.unwrap; }),
      name_or_number<P>("assembly", {"", "PDB and mmCIF: name of a biological assembly", "Each copy adds its spheres"},
                        [](P& p) -> std::string& { return p.assembly; }),
      number<P>("transform.scale", {0, kLargestLength, true, false}, {"", "Scale factor of coordinates and radii"},
                [](P& p) -> double& { return p.transform.scale; }),
      vector<P>("transform.rotate", {-kLargestRotation, kLargestRotation},
                {"degrees", "Rotation about the x axis, then y, then z; applied after the scale"},
                [](P& p) -> Vec3d& { return p.transform.rotate; }),
      vector<P>("transform.translate", kAnyLength, {"scene units", "Translation, applied after the rotation"},
                [](P& p) -> Vec3d& { return p.transform.translate; }),
      optional_interval<P>(
          "clip.x", kAnyLength,
          {"scene units", "Keeps spheres with centres in this interval, after replication and transform"}, "unlimited",
          [](P& p) -> std::optional<Interval>& { return p.clip[0]; }),
      optional_interval<P>("clip.y", kAnyLength, {"scene units", "As `clip.x`"}, "unlimited",
                           [](P& p) -> std::optional<Interval>& { return p.clip[1]; }),
      optional_interval<P>("clip.z", kAnyLength, {"scene units", "As `clip.x`"}, "unlimited",
                           [](P& p) -> std::optional<Interval>& { return p.clip[2]; }),
      changes(Part::kAssignment, text<P>("material_column",
                                         {"",
                                          "PLY: column of indices into the scene's materials, counted from 0 in the "
                                          "order of the scene file. `\"\"`: "
                                          "none"},
                                         [](P& p) -> std::string& { return p.material_column; })),
      boolean<P>("skip_bad", {"", "Skips rows with non-finite coordinates or radii"},
                 [](P& p) -> bool& { return p.skip_bad; }),
      changes(Part::kOutput,
              text<P>("name",
                      {"", "Name in the CryptoObject matte, shared by all spheres of the file. Default: the file name"},
                      [](P& p) -> std::string& { return p.name; })),
      changes(Part::kOutput, text<P>("group", {"", "CryptoGroup name; objects of a group share one matte"},
                                     [](P& p) -> std::string& { return p.group; }))};
  return keys;
}

}  // namespace

const std::vector<Key<Points>>& points_keys() {
  static const std::vector<Key<Points>> keys = make_keys();
  return keys;
}

}  // namespace orrery::scene
