// SPDX-License-Identifier: Apache-2.0
#include "plot/plot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/core.h>

#include "annotation/annotate.h"
#include "base/error.h"
#include "base/text.h"
#include "data/data_file.h"
#include "data/elements.h"
#include "display/develop.h"
#include "film/picture.h"
#include "load/load_scene.h"
#include "load/read_scene.h"
#include "plot/data_frames.h"
#include "points/color_map.h"
#include "scene/animation.h"
#include "support/mentions.h"
#include "support/temp_dir.h"

namespace orrery::plot {
namespace {

using math::Vec3d;

/// A frame of a LAMMPS dump.
std::string frame(const std::string& columns, const std::vector<std::string>& rows) {
  std::string out = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n" + std::to_string(rows.size()) +
                    "\nITEM: BOX BOUNDS pp pp pp\n0 10\n0 10\n0 10\nITEM: ATOMS " + columns + "\n";
  for (const std::string& row : rows) out += row + "\n";
  return out;
}

/// The corners of a cube of edge 4, one of them with a neighbour at distance 1.
const std::string kCorners =
    "x,y,z,mass\n0,0,0,1\n4,0,0,2\n0,4,0,3\n4,4,0,4\n0,0,4,5\n4,0,4,6\n0,4,4,7\n4,4,4,8\n1,0,0,9\n";

using Labels = decltype(annotation::LegendColors::labels);

class PlotPlot : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) {
    support::write_bytes(folder_ / name, text);
    options.file = folder_ / name;
  }
  void make() {
    options.scene_file = folder_ / "scene.toml";
    made = make_plot(options);
  }
  void make(const std::string& name, const std::string& text) {
    write(name, text);
    make();
  }
  /// The scene that the plot writes, read at a frame.
  scene::Scene read(int at = 1) {
    load::SceneRequest request;
    request.source.file = folder_ / "scene.toml";
    request.source.text = std::make_shared<const std::string>(made.text);
    request.source.frame = at;
    scene::Scene out = load::read_with_data(request).scene;
    if (made.loaded && at == 1) check_loaded(request, out);
    return out;
  }
  /// The spheres of a still image are not read again, and are those of the scene.
  void check_loaded(load::SceneRequest request, const scene::Scene& expected) {
    request.source.loaded = std::exchange(made.loaded, nullptr);
    request.source.open_data = [](const std::filesystem::path& path, const data::OpenOptions& open) {
      ADD_FAILURE() << path << " is opened again";
      return data::open(path, open);
    };
    const scene::Points taken = load::read_with_data(request).scene.points.at(0), &fresh = expected.points.at(0);
    EXPECT_TRUE(taken.centers == fresh.centers);
    EXPECT_TRUE(taken.radii == fresh.radii);
    EXPECT_EQ(taken.colors, fresh.colors);
    EXPECT_EQ(taken.palette, fresh.palette);
    EXPECT_EQ(taken.bond_pairs, fresh.bond_pairs);
    EXPECT_EQ(taken.opacities, fresh.opacities);
  }
  /// Of an image of 640 x 360 pixels from -y.
  void expect_spheres_beside_annotation() {
    const scene::Scene scene = read();
    const annotation::View view{640, 360, 1, folder_.path(), {}};
    const std::vector<annotation::Box> boxes =
        annotation::covered_by(annotation::drawing_of(scene, annotation::legend_of(scene, ""), view));
    ASSERT_GT(boxes.size(), 10u);
    const double scale = 640 / *scene.camera.width;
    for (const Vec3d& center : scene.points[0].centers) {
      const Vec3d at = (center - scene.camera.look_at) * scale;  // x to the right, z up
      for (const annotation::Box& box : boxes) {
        const double beside = std::max(box.left - (320 + at.x), 320 + at.x - box.right),
                     above = std::max(box.top - (180 - at.z), 180 - at.z - box.bottom);
        EXPECT_GT(std::max(beside, above), 0.5 * scale) << center.x << ' ' << center.z;
      }
    }
  }
  bool chose(const std::string& choice) const {
    return std::count(made.choices.begin(), made.choices.end(), choice) == 1;
  }
  /// Whether there is one choice "WHAT: REASON", whose reason has these facts.
  bool chose(const std::string& what, const std::vector<std::string_view>& facts) const {
    return std::count_if(made.choices.begin(), made.choices.end(), [&](const std::string& choice) {
             return choice.starts_with(what + ": ") && test::mentions(choice.substr(what.size()), facts);
           }) == 1;
  }
  std::string choices() const {
    std::string out;
    for (const std::string& choice : made.choices) out += choice + "\n";
    return out;
  }
  /// The text of a usage error or of the first diagnostic.
  std::string error() {
    try {
      make();
    } catch (const base::Error& e) {
      return e.diagnostics().empty() ? e.what() : e.diagnostics()[0].text;
    }
    return "no error";
  }

  /// Sets a key, which replaces all overrides.
  void set(const std::string& setting) {
    options.overrides = {};
    options.overrides.add(setting);
  }

  PlotOptions options;
  PlotScene made;
  support::TempDir folder_;
};

TEST_F(PlotPlot, DefaultsWithoutRadiusAndColor) {
  make("a.csv", kCorners);
  EXPECT_EQ(choices(),
            "CSV: 9 particles\n"
            "radius 2: half the median distance to the nearest neighbour; --radius changes it\n"
            "no colour: light grey; --color-by COLUMN shows values\n"
            "up z: customary for simulations and scans; --up changes it\n"
            "view 30,20, 19.02 wide: fitted to the spheres; --look-from and --zoom change it\n"
            "style studio: a key light from the upper left, and white light from all directions; --style changes it\n"
            "size 1920 x 1080: --width and --height change it\n"
            "quality good: noise 0.15, denoised; --quality, --noise, --time or --samples change it\n");
  const scene::Scene scene = read();
  ASSERT_EQ(scene.points.size(), 1u);
  EXPECT_EQ(scene.points[0].file, "a.csv") << "relative to the scene file";
  EXPECT_EQ(scene.points[0].radius.value, 2.0);
  EXPECT_EQ(scene.points[0].centers.size(), 9u);
  EXPECT_TRUE(scene.points[0].palette.empty());
  EXPECT_EQ(scene.camera.projection, scene::Projection::kOrthographic);
  EXPECT_EQ(scene.image.width, 1920);
  EXPECT_EQ(scene.image.height, 1080);
  EXPECT_EQ(scene.background.type, scene::BackgroundType::kGradient);
  EXPECT_EQ(scene.background.up, (Vec3d{0, 0, 1}));
  EXPECT_EQ(scene.background.backdrop, (Vec3d{1, 1, 1}));
  EXPECT_EQ(scene.spheres.size(), 1u) << "the key light";
  EXPECT_TRUE(made.warnings.empty());
  EXPECT_TRUE(made.frames.empty());
}

TEST_F(PlotPlot, TheCameraOfTheSceneSeesAllSpheres) {
  for (const auto& [width, height] : {std::pair{480, 270}, {100, 1000}}) {
    set("image={width=" + std::to_string(width) + ",height=" + std::to_string(height) + "}");
    make("a.csv", kCorners);
    const scene::Scene scene = read();
    const Vec3d back = math::normalized(scene.camera.look_from - scene.camera.look_at);
    const Vec3d right = math::cross(scene.camera.up, back);
    double reach = 0;
    for (const Vec3d& c : scene.points[0].centers) {
      const Vec3d at = c - scene.camera.look_at;
      reach = std::max(
          {reach, std::abs(math::dot(at, right)) + 2, (std::abs(math::dot(at, scene.camera.up)) + 2) * width / height});
    }
    EXPECT_NEAR(reach / (*scene.camera.width / 2), 0.9, 1e-9);
  }
}

TEST_F(PlotPlot, RadiiOfTheFileAreKept) {
  make("a.csv", "x,y,z,diameter\n0,0,0,3\n");
  EXPECT_TRUE(chose("radius of the file", {"half", "diameter"})) << choices();
  EXPECT_EQ(read().points[0].radii, std::vector<double>{1.5}) << "halved once, although the scene is read again";
  make("a.csv", "x,y,z,radius\n0,0,0,3\n");
  EXPECT_TRUE(chose("radius of the file", {"radius"})) << choices();
  EXPECT_EQ(read().points[0].radii, std::vector<double>{3});
}

TEST_F(PlotPlot, MoleculesHaveRadiiAndColorsOfTheirElements) {
  make("a.pdb",
       "ATOM      1  CA  ALA A   1       1.000   2.000   3.000  1.00  0.00           C\n"
       "ATOM      2  N   ALA B   1       4.000   5.000   6.000  1.00  0.00           N\nEND\n");
  EXPECT_TRUE(chose("radius vdw", {"elements"})) << choices();
  EXPECT_TRUE(chose("colour by chain+element: several chains; --color-by element shows elements alone")) << choices();
  EXPECT_TRUE(test::mentions(choices(), {"view auto", "principal axes"})) << choices();
  const scene::Scene scene = read();
  EXPECT_EQ(scene.points[0].radii, (std::vector<double>{1.70, 1.55}));
  EXPECT_EQ(scene.points[0].color.element, "soft");
  EXPECT_EQ(scene.points[0].palette.size(), 3u);
  EXPECT_EQ(scene.points[0].color_names[0], "C (A)");
  options.points.radius.element = "ball";
  make();
  EXPECT_EQ(read().points[0].radii[0], 0.25 * 1.70);
}

/// Ethanol without most of its hydrogens.
const std::string kMolecule = "4\n\nC 0 0 0\nC 1.5 0 0\nO 2.2 1.2 0\nH -0.6 0.9 0\n";

TEST_F(PlotPlot, ModelsOfBallsAndSticksHaveBonds) {
  options.representation = Representation::kBallAndStick;
  make("a.xyz", kMolecule);
  EXPECT_TRUE(chose("radius ball", {"quarter", "elements"})) << choices();
  EXPECT_TRUE(chose("3 bonds", {"1.2", "covalent"})) << choices();
  scene::Points points = read().points[0];
  EXPECT_EQ(points.radii[0], 0.25 * 1.70);
  EXPECT_EQ(points.bond_pairs.size(), 3u);
  EXPECT_EQ(points.bond_radius, 0.15);
  options.representation = Representation::kSticks;
  make();
  EXPECT_TRUE(chose("radius 0.2", {"sticks", "--radius"})) << choices();
  points = read().points[0];
  EXPECT_EQ(points.bond_radius, 0.2);
  EXPECT_EQ(points.radii[0], 0.2);
  options.points.radius.value = 0.1;
  make();
  EXPECT_EQ(read().points[0].bond_radius, 0.1) << "of spheres and bonds";
  options.bonds = false;
  make();
  EXPECT_TRUE(read().points[0].bond_pairs.empty());
}

TEST_F(PlotPlot, SpheresHaveBondsOnRequest) {
  make("a.xyz", kMolecule);
  EXPECT_EQ(choices().find("bond"), std::string::npos);
  options.bonds = true;
  options.points.bonds.length = 1.45;
  make();
  EXPECT_TRUE(chose("2 bonds: closer than 1.45")) << choices();
  EXPECT_TRUE(chose("radius vdw", {"elements"})) << choices();
  EXPECT_EQ(read().points[0].bond_pairs.size(), 2u);
}

TEST_F(PlotPlot, WithoutElementsBallsHaveHalfTheRadiusOfSpheres) {
  options.representation = Representation::kBallAndStick;
  make("a.data",
       "t\n3 atoms\n2 bonds\n0 9 xlo xhi\n0 9 ylo yhi\n0 9 zlo zhi\n\nAtoms # bond\n\n1 1 1 1 1 1\n2 1 1 2 1 1\n3 1 1 "
       "9 1 "
       "1\n\nBonds\n\n1 1 1 2\n2 1 1 3\n");
  EXPECT_TRUE(chose("radius 0.25", {"half", "0.5", "ball-and-stick"})) << choices();
  EXPECT_TRUE(chose("2 bonds: those of the file")) << choices();
  const scene::Points points = read().points[0];
  EXPECT_EQ(points.bond_stubs.size(), 2u);
  EXPECT_EQ(points.bond_radius, 0.3 * 0.25);
  options.representation = Representation::kSticks;
  make();
  EXPECT_EQ(read().points[0].bond_radius, 0.15);
  EXPECT_EQ(read().points[0].radii[0], 0.15);
  options.representation = Representation::kBallAndStick;
  options.points.bonds.length = 1.5;
  make("b.csv", "x,y,z,diameter\n0,0,0,2\n1,0,0,2\n");
  EXPECT_EQ(read().points[0].radii[0], 0.5) << "half of the file's radius";
}

TEST_F(PlotPlot, BondsByDistanceFollowTheFrames) {
  options.representation = Representation::kBallAndStick;
  options.all_frames = true;
  make("a.xyz", "2\n\nC 0 0 0\nC 1.5 0 0\n2\n\nC 0 0 0\nC 2.5 0 0\n");
  EXPECT_TRUE(chose("0 to 1 bond", {"1.2", "covalent"})) << choices();
  EXPECT_EQ(read(1).points[0].bond_pairs.size(), 1u);
  EXPECT_EQ(read(2).points[0].bond_pairs.size(), 0u);
}

TEST_F(PlotPlot, ArrowsAreAsLongAsTheirNeighborsAreFarInAllFrames) {
  options.points.vectors.columns = {"vx", "vy", "vz"};
  options.all_frames = true;
  const auto frame = [](const char* velocities) {
    return "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n0 9\n0 9\n0 9\n"
           "ITEM: ATOMS id type x y z vx vy vz\n" +
           std::string(velocities);
  };
  make("a.dump", frame("1 1 1 1 1 10 0 0\n2 1 3 1 1 0 0 10\n") + frame("1 1 1 1 1 90 0 0\n2 1 3 1 1 0 0 0\n"));
  EXPECT_TRUE(chose("arrows 0.24 times vx, vy, vz", {"root mean square", "1.2", "neighbour"})) << choices();
  EXPECT_TRUE(chose("radius 0.25", {"half", "0.25", "arrows"})) << choices();
  const scene::Scene first = read(1), second = read(2);
  EXPECT_EQ(first.points[0].arrow_count, 2u);
  EXPECT_DOUBLE_EQ(first.points[0].rms_vector, 2.4);
  EXPECT_EQ(second.points[0].arrow_count, 1u);
  EXPECT_EQ(second.points[0].particle_count(), 2u);
  EXPECT_GT(*first.camera.width, 15) << "the long arrow is in the view";
  EXPECT_EQ(choices().find("spheres:"), std::string::npos) << "those of heads are not counted: " << choices();
}

TEST_F(PlotPlot, AVectorMayHaveOneName) {
  for (const char* columns : {"f[1] f[2] f[3]", "f_x f_y f_z", "fx fy fz"}) {
    options.points.vectors.columns = {"f"};
    make("a.dump", frame("x y z radius " + std::string(columns), {"1 0 0 1 1 2 3", "3 0 0 1 1 0 0"}));
    EXPECT_EQ(base::joined(read().points[0].vectors.columns, " "), columns);
  }
  options.points.vectors.columns = {"g"};
  EXPECT_TRUE(test::mentions(error(), {"--vectors g", "g[1]", "g[3]"}));
}

TEST_F(PlotPlot, ArrowsHaveOneScaleWhateverIsSelected) {
  options.points.vectors.columns = {"vx", "vy", "vz"};
  const auto frame = [](const char* velocities) {
    return "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n3\nITEM: BOX BOUNDS pp pp pp\n0 9\n0 9\n0 9\n"
           "ITEM: ATOMS id type x y z vx vy vz\n" +
           std::string(velocities);
  };
  make("a.dump", frame("1 1 1 1 1 1 0 0\n2 1 3 1 1 0 0 1\n3 2 5 1 1 20 0 0\n") +
                     frame("1 1 1 1 1 3 0 0\n2 1 3 1 1 0 0 3\n3 2 5 1 1 3 0 0\n"));
  const double scale = read().points[0].vectors.scale;
  options.points.select = "type == 1";
  make();
  EXPECT_EQ(read().points[0].vectors.scale, scale);
  options.points.select.clear();
  options.slices = {{0, 4}};
  make();
  EXPECT_EQ(read().points[0].vectors.scale, scale);
  options.slices.clear();
  options.points.frame = 2;
  make();
  EXPECT_EQ(read().points[0].vectors.scale, scale);
}

TEST_F(PlotPlot, BondsBetweenRadiiOfAColumnHaveOneRadiusWhateverIsSelected) {
  options.points.bonds.length = 1.5;
  for (const auto& [representation, radius] :
       {std::pair{Representation::kBallAndStick, 0.3}, std::pair{Representation::kSticks, 0.6}}) {
    options.representation = representation;
    options.points.select.clear();
    make("a.csv", "x,y,z,radius,kind\n0,0,0,3,1\n1,0,0,3,1\n2,0,0,1,2\n3,0,0,1,2\n");
    EXPECT_EQ(read().points[0].bond_radius, radius);
    options.points.select = "kind == 2";
    make();
    EXPECT_EQ(read().points[0].bond_radius, radius);
  }
}

/// A tetragonal cell with an atom at its corners and one in the middle.
const std::string kUnitCell =
    "data_a\n_cell_length_a 4\n_cell_length_b 4\n_cell_length_c 5\n_space_group_IT_number 123\nloop_\n"
    "_atom_site_label\n_atom_site_fract_x\n_atom_site_fract_y\n_atom_site_fract_z\nCs 0 0 0\nCl .5 .5 .5\n";

TEST_F(PlotPlot, AUnitCellIsABallAndStickModelInItsEdges) {
  make("a.cif", kUnitCell);
  EXPECT_TRUE(
      test::mentions(choices(), {"9 spheres", "faces", "representation ball-and-stick", "a red", "view 115,15"}));
  const scene::Scene scene = read();
  EXPECT_TRUE(scene.points[0].bonds.are_drawn);
  EXPECT_EQ(scene.points[0].centers.size(), 9u) << "an atom at each corner";
  ASSERT_EQ(scene.rods.size(), 15u);
  EXPECT_EQ(scene.rods[12].name, "axis_a");
  EXPECT_EQ(scene.rods[14].name, "axis_c");
  options.representation = Representation::kSpheres;
  make();
  EXPECT_EQ(choices().find("ball-and-stick"), std::string::npos) << choices();
  EXPECT_TRUE(read().rods.empty());
  EXPECT_EQ(read().points[0].centers.size(), 2u);
}

TEST_F(PlotPlot, ATopologyIsNamedRelativeToTheScene) {
  const std::filesystem::path seeds = ORRERY_ROOT "/tests/fuzz/corpus/data";
  options.file = seeds / "xtc/water.xtc";
  options.points.topology = seeds / "gro/water.gro";
  make();
  EXPECT_TRUE(test::mentions(choices(), {"XTC", "30 particles", "colour by element"}));
  const scene::Points points = read().points[0];
  EXPECT_EQ(points.topology, std::filesystem::proximate(seeds / "gro/water.gro", folder_.path()));
  EXPECT_EQ(points.centers.size(), 30u);
}

TEST_F(PlotPlot, TheBoxIsTwelveRodsAndTheAxesAreOutsideIt) {
  options.box = options.axes = true;
  options.points.replicate = {2, 1, 1};
  make("a.data", "t\n1 atoms\n-1 3 xlo xhi\n0 3 ylo yhi\n0 5 zlo zhi\n1 0 0 xy xz yz\n\nAtoms # atomic\n\n1 1 1 1 1\n");
  const scene::Scene scene = read();
  ASSERT_EQ(scene.rods.size(), 15u);
  std::multiset<double> lengths;
  math::Vec3d low{9, 9, 9}, high{-9, -9, -9};
  for (std::size_t i = 0; i < 12; ++i) {
    const scene::Rod& rod = scene.rods[i];
    EXPECT_EQ(rod.name, "box");
    lengths.insert(math::length(rod.to - rod.from));
    for (const math::Vec3d& end : {rod.from, rod.to}) {
      low = {std::min(low.x, end.x), std::min(low.y, end.y), std::min(low.z, end.z)};
      high = {std::max(high.x, end.x), std::max(high.y, end.y), std::max(high.z, end.z)};
    }
  }
  EXPECT_EQ(lengths, (std::multiset<double>{8, 8, 8, 8, std::sqrt(10), std::sqrt(10), std::sqrt(10), std::sqrt(10), 5,
                                            5, 5, 5}));
  EXPECT_EQ(low, (math::Vec3d{-1, 0, 0}));
  EXPECT_EQ(high, (math::Vec3d{8, 3, 5}));
  for (std::size_t i = 12; i < 15; ++i) {
    EXPECT_EQ(scene.rods[i].from, scene.rods[12].from);
    EXPECT_LT(scene.rods[i].to.x, -1);
    EXPECT_LT(scene.rods[i].to.y, 0);
    EXPECT_LT(scene.rods[i].to.z, 0);
  }
  options = {};
  options.box = true;
  write("b.csv", kCorners);
  EXPECT_THROW(make(), base::Error);
}

/// Colours as a plot shows them where all light reaches the sphere; the background comes first.
std::vector<std::array<int, 3>> shown(const scene::Scene& scene) {
  std::vector<Vec3d> colors = {scene.background.backdrop.value_or(scene.background.color)};
  for (const scene::Points& points : scene.points)
    colors.insert(colors.end(), points.palette.begin(), points.palette.end());
  film::Picture row;
  row.width = static_cast<int>(colors.size());
  row.height = 1;
  for (const char* name : {"R", "G", "B"}) row.planes.push_back({name, {}, film::PlaneKind::kLight});
  for (const Vec3d& c : colors) {
    const double channels[] = {c.x, c.y, c.z};
    for (std::size_t i = 0; i < 3; ++i) row.planes[i].values.push_back(static_cast<float>(channels[i]));
  }
  display::Settings settings;
  settings.view = scene.color.view;
  settings.backdrop = colors[0];
  row.coverage.assign(colors.size(), 1);
  row.coverage[0] = 0;
  const film::EncodedPicture encoded = display::develop(row, settings, 8);
  std::vector<std::array<int, 3>> out(colors.size());
  for (std::size_t i = 0; i < 3 * colors.size(); ++i) out[i / 3][i % 3] = encoded.values[i];
  return out;
}

TEST_F(PlotPlot, ElementsDifferFromTheBackground) {
  std::string text = "119\nall elements and an unknown one\nXx 0 0 0\n";
  for (int z = 1; z <= 118; ++z)
    text += std::string(data::find_element(z)->symbol) + " " + std::to_string(z) + " 0 0\n";
  write("a.xyz", text);
  options.points.radius.value = 1;
  for (const Style style : {Style::kStudio, Style::kSoft, Style::kFlat, Style::kNight}) {
    options.style = style;
    make();
    const auto colors = shown(read());
    ASSERT_GT(colors.size(), 100u);
    for (std::size_t i = 1; i < colors.size(); ++i) {
      int difference = 0;
      for (std::size_t c = 0; c < 3; ++c) difference = std::max(difference, std::abs(colors[i][c] - colors[0][c]));
      EXPECT_GE(difference, 24) << "colour " << i << " of style " << static_cast<int>(style);
    }
  }
}

TEST_F(PlotPlot, ColorsOfTheFileComeFirst) {
  make("a.csv", "x,y,z,radius,type,red,green,blue\n0,0,0,1,1,255,0,0\n");
  EXPECT_TRUE(chose("colour by rgb", {"own", "--color-by"})) << choices();
  EXPECT_EQ(read().points[0].palette, (std::vector<Vec3d>{{1, 0, 0}}));
}

TEST_F(PlotPlot, TypesAreCategories) {
  make("a.dump", frame("x y z radius type", {"1 0 0 1 2", "2 0 0 1 1"}));
  EXPECT_TRUE(chose("colour by type", {"--color-by"})) << choices();
  const scene::Points points = read().points[0];
  EXPECT_EQ(points.color.map, "set2");
  EXPECT_EQ(points.palette, points::palette(*points::find_color_map("set2"), 2));
  EXPECT_EQ(made.legend.labels, (Labels{{"1", points.palette[0]}, {"2", points.palette[1]}}));
  options.points.color.map = "viridis";
  options.has_map = true;
  make();
  EXPECT_EQ(read().points[0].color.map, "viridis");
}

TEST_F(PlotPlot, NumbersOfGroupsAreCategories) {
  for (const auto& [column, map] :
       {std::pair("mol", "set2"), std::pair("cluster_ID", "set2"), std::pair("n", "fast")}) {
    options.color_by = column;
    make("a.dump", frame("x y z radius " + std::string(column), {"1 0 0 1 2", "2 0 0 1 1"}));
    EXPECT_EQ(read().points[0].color.map, map) << column;
  }
}

TEST_F(PlotPlot, FewValuesThatUseUpTheMapAreReported) {
  std::vector<std::string> rows;
  for (int i = 0; i < 200; ++i) rows.push_back(fmt::format("{} 0 0 1 {}", 3 * i, i == 0 ? 1000 : i % 10));
  options.color_by = "q";
  make("a.dump", frame("x y z radius q", rows));
  EXPECT_TRUE(chose("range 0:1000: minimum and maximum; 99 % of the values are within 0:9, which --range 1%:99% shows"))
      << choices();
}

TEST_F(PlotPlot, ColorByAColumn) {
  options.color_by = "mass";
  make("a.csv", kCorners);
  EXPECT_TRUE(chose("range 1:9", {"minimum and maximum", "--range"})) << choices();
  const scene::Points points = read().points[0];
  EXPECT_EQ(points.color.column, "mass");
  ASSERT_TRUE(points.color.range);
  EXPECT_EQ(points.color.range->low, 1);
  EXPECT_EQ(points.color.range->high, 9);
  EXPECT_NE(choices().find("map " + points.color.map + ": "), std::string::npos) << "a chosen map is printed";
  options.points.color.range = scene::Interval{0, 100};
  options.points.color.map = "magma";
  options.has_map = true;
  make();
  EXPECT_EQ(read().points[0].color.range->high, 100);
  EXPECT_EQ(made.legend.range->high, 100) << "for the legend";
  EXPECT_EQ(read().points[0].color.map, "magma");
  EXPECT_EQ(choices().find("map "), std::string::npos) << choices();
  EXPECT_EQ(choices().find("range "), std::string::npos) << choices();
  options.color_by = "none";
  options.points.color = {};
  options.has_map = false;
  make();
  EXPECT_FALSE(read().points[0].color.is_set());
}

TEST_F(PlotPlot, AConstantColumnHasNoRangeInTheScene) {
  options.color_by = "mass";
  make("a.csv", "x,y,z,mass\n0,0,0,5\n1,0,0,5\n");
  EXPECT_FALSE(read().points[0].color.range) << "its ends must differ";
  EXPECT_TRUE(chose("range 5:5", {"minimum and maximum"})) << choices();
}

TEST_F(PlotPlot, OneRangeAndOneViewForAllFrames) {
  options.color_by = "vx";
  options.all_frames = true;
  make("a.dump", frame("id x y z radius vx", {}) + frame("id x y z radius vx", {"1 0 0 0 1 5", "2 1 0 0 1 nan"}) +
                     frame("id x y z radius vx", {"2 9 0 0 1 -3", "1 0 0 0 1 2"}));
  EXPECT_EQ(made.frames, (std::vector<int>{1, 2, 3}));
  EXPECT_TRUE(chose("frames 1-3: all of the file")) << choices();
  EXPECT_TRUE(chose("range -3:5", {"all frames"})) << choices();
  const scene::Scene second = read(2), third = read(3);
  EXPECT_EQ(second.points[0].color_range->low, -3);
  EXPECT_EQ(third.points[0].color_range->high, 5);
  EXPECT_EQ(second.points[0].centers[1].x, 1);
  EXPECT_EQ(third.points[0].centers[1].x, 9);
  EXPECT_EQ(second.camera.look_at, third.camera.look_at);
  EXPECT_EQ(read(1).points[0].centers.size(), 0u) << "a frame without particles is rendered";
}

TEST_F(PlotPlot, TheLegendExplainsAllFrames) {
  options.all_frames = true;
  make("a.dump", frame("x y z radius type", {"0 0 0 1 2"}) + frame("x y z radius type", {"0 0 0 1 10", "1 0 0 1 1"}));
  const std::vector<Vec3d> set2 = points::palette(*points::find_color_map("set2"), 8);
  EXPECT_EQ(made.legend.labels, (Labels{{"1", set2[0]}, {"2", set2[1]}, {"10", set2[1]}}));
  EXPECT_EQ(made.legend.labels.rbegin()->first, "10") << "numbers by value";
  EXPECT_FALSE(made.legend.has_conflict);
  EXPECT_TRUE(made.warnings.empty());
  options.color_by = "vx";
  make("a.dump", frame("x y z radius vx", {"0 0 0 1 2"}) + frame("x y z radius vx", {"0 0 0 1 nan", "1 0 0 1 1"}));
  EXPECT_EQ(made.legend.bar.size(), 256u);
  EXPECT_EQ(made.legend.nan_color, read().points[0].palette.back()) << "of the second frame";
  make("a.dump", frame("x y z radius vx", {"0 0 0 1 2"}) + frame("x y z radius vx", {"0 0 0 1 3"}));
  EXPECT_FALSE(made.legend.nan_color);
}

TEST_F(PlotPlot, OneValueWithTwoColorsIsReported) {
  options.all_frames = true;
  options.color_by = "vx";
  options.points.color.map = "tab10";
  options.has_map = true;
  make("a.dump", frame("x y z radius vx", {"0 0 0 1 0.5"}) + frame("x y z radius vx", {"0 0 0 1 0.25", "1 0 0 1 0.5"}));
  EXPECT_TRUE(made.legend.has_conflict);
  EXPECT_EQ(made.warnings.size(), 1u);
}

TEST_F(PlotPlot, ChosenFramesOnly) {
  write("a.dump", frame("x y z radius vx", {"0 0 0 1 100"}) + frame("x y z radius vx", {"1 0 0 1 1"}) +
                      frame("x y z radius vx", {"2 0 0 1 2"}));
  options.color_by = "vx";
  options.frames = {2, 3};
  make();
  EXPECT_EQ(made.legend.range->high, 2);
  EXPECT_EQ(made.frames, (std::vector<int>{2, 3}));
  options.frames = {2, 4};
  EXPECT_EQ(error(), "--frames: there is no frame 4; " + (folder_ / "a.dump").string() + " has 3 frames");
  options.frames = {0};
  EXPECT_EQ(error(), "there is no frame 0; a.dump has 3 frames");
  options.frames.clear();
  options.points.frame = 3;
  make();
  EXPECT_EQ(read().points[0].centers[0].x, 2);
}

TEST_F(PlotPlot, RadiusOfTheFirstFrameWithNeighbours) {
  options.all_frames = true;
  make("a.dump", frame("x y z", {}) + frame("x y z", {"0 0 0"}) + frame("x y z", {"0 0 0", "0 3 0"}) +
                     frame("x y z", {"0 0 0", "0 1 0"}));
  EXPECT_EQ(read(3).points[0].radius.value, 1.5) << choices();
  options.all_frames = false;
  options.points.frame = 2;
  make();
  EXPECT_EQ(read().points[0].radius.value, 1.5) << "of the file, whatever is shown: " << choices();
  options.points.frame.reset();
  make("b.dump", frame("x y z", {"0 0 0"}) + frame("x y z", {"1 0 0"}));
  EXPECT_TRUE(chose("radius 1", {"no particle has a neighbour"})) << choices();
}

/// Panels of one figure show a particle in one size.
TEST_F(PlotPlot, TheRadiusDoesNotDependOnWhatIsShown) {
  write("a.dump", frame("x y z q", {"0 0 0 1", "0 2 0 2", "0 4 0 1", "0 9 0 2"}) +
                      frame("x y z q", {"0 0 0 1", "0 1 0 2", "nan 0 0 3"}));
  const auto radius = [&] {
    make();
    return read().points[0].radius.value;
  };
  EXPECT_EQ(radius(), 1.0);
  options.points.select = "q == 1";
  EXPECT_EQ(radius(), 1.0);
  options.points.select.clear();
  options.slices = {{1, 3.0}};
  EXPECT_EQ(radius(), 1.0);
  options.slices.clear();
  options.points.frame = 2;
  options.points.select = "q < 3";
  EXPECT_EQ(radius(), 1.0);
  options.points.frame.reset();
  options.frames = {2};
  EXPECT_EQ(radius(), 1.0);
  options.points.replicate = {2, 2, 2};
  options.frames = {1};
  EXPECT_EQ(radius(), 1.0);
}

TEST_F(PlotPlot, TheNumberOfSpheresIsPrintedIfItIsNotThatOfTheParticles) {
  make("a.csv", kCorners);
  EXPECT_EQ(choices().find("spheres: "), std::string::npos) << choices();
  options.points.select = "mass > 3";
  make();
  EXPECT_EQ(choices().rfind("CSV: 9 particles\n6 spheres: --select\n", 0), 0u) << choices();
  options.slices = {{2, 2.0}};
  make();
  EXPECT_TRUE(chose("2 spheres: --select, --slice")) << choices();
  options = {};
  options.points.replicate = {3, 1, 2};
  make("a.dump", frame("x y z radius", {"1 1 1 1", "2 2 2 1"}) + frame("x y z radius", {"1 1 1 1"}));
  EXPECT_TRUE(chose("12 spheres: --replicate")) << choices();
  options.points.replicate = {1, 1, 1};
  options.all_frames = true;
  make();
  EXPECT_TRUE(chose("1 to 2 spheres", {"all frames"})) << choices();
}

TEST_F(PlotPlot, RangesHaveEnoughDigits) {
  options.color_by = "q";
  const auto range = [&](const std::string& low, const std::string& high) {
    make("a.csv", "x,y,z,radius,q\n0,0,0,1," + low + "\n9,0,0,1," + high + "\n");
    const std::string all = choices();
    const std::size_t begin = all.find("range ") + 6;
    return all.substr(begin, all.find(": ", begin) - begin);
  };
  EXPECT_EQ(range("0.032497108477101466", "5.1823988183562255"), "0.0325:5.182");
  EXPECT_EQ(range("1000.123456", "1000.223456"), "1000.1235:1000.2235");
  EXPECT_EQ(range("0", "1"), "0:1");
  make("a.csv", "x,y,z,radius,q\n0,0,0,1,0.032497108477101466\n9,0,0,1,5.1823988183562255\n");
  EXPECT_EQ(read().points[0].color.range->low, 0.032497108477101466) << "exact in the scene";
}

TEST_F(PlotPlot, SequencesOfFiles) {
  write("a.0001.csv", "x,y,z,radius\n1,0,0,1\n");
  write("a.0002.csv", "x,y,z,radius\n5,0,0,1\n");
  options.file = folder_ / "a.####.csv";
  options.frames = {1, 2};
  make();
  EXPECT_EQ(read(2).points[0].centers[0].x, 5);
  EXPECT_NEAR(read(1).camera.look_at.x, 3, 1e-9);
  options.frames.clear();
  options.all_frames = true;
  EXPECT_TRUE(test::mentions(error(), {"--frames", "`all`", "single file"}));
}

TEST_F(PlotPlot, TheFrameIsPrinted) {
  const std::string one = frame("x y z radius", {"0 0 0 1"});
  write("a.dump", one + one + one);
  make();
  EXPECT_TRUE(chose("frame 1 of 3", {"--frames all"})) << choices();
  options.points.frame = 2;
  make();
  EXPECT_EQ(choices().find("frame 1"), std::string::npos) << "it was not left to the plot: " << choices();
  options.points.frame = -1;
  make();
  EXPECT_TRUE(chose("frame 3: --frame -1")) << choices();
  EXPECT_EQ(read().points[0].frame, 3);
  options.points.frame = -4;
  EXPECT_NE(error().find("there is no frame -4; "), std::string::npos) << error();
  options.points.frame.reset();
  make("a.dump", one);
  EXPECT_EQ(choices().find("frame"), std::string::npos) << choices();
  make("a.dump", one + one + "ITEM: TIMESTEP\n");
  EXPECT_TRUE(chose("frame 1: the first; --frame N selects another")) << "the file ends in a header: " << choices();
}

TEST_F(PlotPlot, NothingToRenderIsAnErrorUnlessAllowed) {
  const std::string none = frame("x y z radius", {}), one = frame("x y z radius", {"0 0 0 1"});
  const auto error = [&](const std::string& text) -> std::string {
    try {
      make("a.dump", text);
    } catch (const base::Error& e) {
      EXPECT_EQ(e.kind(), base::ErrorKind::kBadData);
      EXPECT_NE(std::string(e.what()).find("--allow-empty"), std::string::npos) << e.what();
      return e.what();
    }
    return "no error";
  };
  EXPECT_NE(error(none).find("the file has no particles"), std::string::npos);
  EXPECT_NE(error(none + one).find("--frame N selects another"), std::string::npos);
  options.points.skip_bad = true;
  EXPECT_NE(error(frame("x y z radius", {"0 0 0 -1", "nan 0 0 1"})).find("--skip-bad leaves none of the 2"),
            std::string::npos);
  options.points.skip_bad = false;
  options.allow_empty = true;
  const auto warning = [&](const std::string& text) {
    make("a.dump", text);
    return made.warnings.size() == 1 ? made.warnings[0] : std::to_string(made.warnings.size()) + " warnings";
  };
  EXPECT_TRUE(test::mentions(warning(none), {"nothing to render", "no particles"}));
  EXPECT_EQ(warning(none + one + one), "nothing to render: frame 1 of 3 has no particles");
  options.points.frame = 2;
  EXPECT_EQ(warning(one + none), "nothing to render: frame 2 of 2 has no particles");
  options.points.frame.reset();
  options.frames = {1, 2};
  EXPECT_TRUE(test::mentions(warning(none + none + one), {"nothing to render", "2 frames"}));
  options.frames.clear();
  options.points.select = "x > 5";
  EXPECT_EQ(warning(one), "nothing to render: --select leaves none of the 1 particles");
  options.points.select.clear();
  warning(none);
  options.ground = true;
  make();
  EXPECT_TRUE(read().points[0].centers.empty()) << "the scene is valid";
}

TEST_F(PlotPlot, ASelectionThatLeavesNothingIsAnError) {
  write("a.dump", frame("x y z radius", {"0 0 0 1"}) + frame("x y z radius", {"0 0 9 1"}));
  const auto kind = [&] {
    try {
      make();
    } catch (const base::Error& e) {
      EXPECT_NE(std::string(e.what()).find("--allow-empty"), std::string::npos) << e.what();
      return base::exit_status(e.kind());
    }
    return 0;
  };
  options.points.select = "z > 5";
  EXPECT_EQ(kind(), 65);
  options.all_frames = true;
  EXPECT_EQ(kind(), 0) << "one of the frames has spheres";
  options.points.select = "z > 10";
  EXPECT_EQ(kind(), 65);
  options.points.select.clear();
  options.slices = {{2, -5.0}};
  EXPECT_EQ(kind(), 65);
  options.allow_empty = true;
  EXPECT_EQ(kind(), 0);
}

TEST_F(PlotPlot, SlicesRemoveTheSideOfTheCamera) {
  write("a.csv", "x,y,z,radius\n0,0,-5,1\n0,0,0,1\n0,0,5,1\n");
  const auto kept = [&] {
    make();
    const scene::Scene plotted = read();
    std::vector<double> out;
    for (const Vec3d& c : plotted.points[0].centers) out.push_back(c.z);
    return out;
  };
  options.slices = {{2, 1.0}};
  EXPECT_EQ(kept(), (std::vector<double>{-5, 0})) << "a plane is seen from its axis";
  EXPECT_TRUE(test::mentions(choices(), {"view +z"})) << choices();
  options.slices = {{2, 1.0}, {2, -1.0}};
  EXPECT_EQ(kept(), (std::vector<double>{-5})) << "all slices apply";
  options.slices = {{2, -1.0}, {2, 1.0}};
  EXPECT_EQ(kept(), (std::vector<double>{-5})) << "in any order";
  options.slices = {{1, -1.0}};
  kept();
  EXPECT_TRUE(test::mentions(choices(), {"view -y"})) << "from the front: " << choices();
  options.slices = {{2, 1.0}};
  options.look_from = "-z";
  EXPECT_EQ(kept(), (std::vector<double>{5}));
  options.look_from = "30,-20";
  EXPECT_EQ(kept(), (std::vector<double>{5}));
}

TEST_F(PlotPlot, KeysOfTheUserAreWritten) {
  options.points.frame = 1;
  options.points.radius.types = {{"1", 0.5}, {"2", 0.25}};
  options.points.select = "type in [1, 2]";
  options.points.replicate = {2, 1, 1};
  options.points.unwrap = true;
  options.points.skip_bad = true;
  make("a.dump", frame("x y z type ix iy iz", {"1 0 0 1 0 0 0", "2 0 0 2 0 1 0", "nan 0 0 1 0 0 0", "5 5 5 3 0 0 0"}));
  const scene::Points points = read().points[0];
  EXPECT_EQ(points.frame, 1);
  EXPECT_EQ(points.radius.types, options.points.radius.types);
  EXPECT_EQ(points.select, options.points.select);
  EXPECT_EQ(points.replicate, options.points.replicate);
  EXPECT_TRUE(points.unwrap && points.skip_bad);
  EXPECT_EQ(points.centers, (std::vector<Vec3d>{{1, 0, 0}, {2, 10, 0}, {11, 0, 0}, {12, 10, 0}}));
  EXPECT_EQ(points.radii, (std::vector<double>{0.5, 0.25, 0.5, 0.25}));

  options.points = {};
  options.points.radius.column = "mass";
  options.points.radius.scale = 0.5;
  make("b.csv", kCorners);
  EXPECT_EQ(read().points[0].radii[3], 2);
}

TEST_F(PlotPlot, StylesAndGround) {
  write("a.csv", "x,y,z,radius\n0,0,2,1\n0,0,7,1\n");
  options.style = Style::kFlat;
  make();
  EXPECT_EQ(read().render.shading, scene::Shading::kFlat);
  options.style = Style::kAmbient;
  make();
  EXPECT_EQ(read().background.color, (Vec3d{1, 1, 1}));
  EXPECT_TRUE(read().spheres.empty());
  options.style = Style::kNight;
  options.ground = true;
  make();
  const scene::Scene scene = read();
  EXPECT_LT(scene.background.color.x, 0.1);
  ASSERT_EQ(scene.spheres.size(), 2u);
  const scene::Sphere &ground = scene.spheres[0], &lamp = scene.spheres[1];
  EXPECT_NEAR(ground.center.z + ground.radius, 1, 1e-9) << "touches the lowest sphere from below";
  EXPECT_TRUE(std::holds_alternative<scene::Emitter>(scene.materials[lamp.material].model));
  const Vec3d back = math::normalized(scene.camera.look_from - scene.camera.look_at);
  EXPECT_GT(math::dot(lamp.center - scene.camera.look_from, back), lamp.radius) << "behind the camera";
}

TEST_F(PlotPlot, TheMaterialOfTheSpheres) {
  write("a.csv", "x,y,z,radius,q\n0,0,2,1,1\n0,0,7,1,2\n");
  make();
  EXPECT_TRUE(std::holds_alternative<scene::Lambertian>(read().materials[read().points[0].material].model));
  for (const std::string& name : material_names()) {
    options.material = name;
    make();
    const scene::Scene scene = read();
    EXPECT_EQ(scene.materials[scene.points[0].material].name, name);
    EXPECT_EQ(std::holds_alternative<scene::Plastic>(scene.materials[scene.points[0].material].model),
              name == "plastic");
  }
}

TEST_F(PlotPlot, GlassHasNoColor) {
  write("a.csv", "x,y,z,radius,type\n0,0,2,1,1\n0,0,7,1,2\n");
  options.material = "glass";
  make();
  EXPECT_FALSE(read().points[0].color.is_set());
  EXPECT_NE(choices().find("no colour: glass has none"), std::string::npos) << choices();
  options.color_by = "none";
  make();
  options.color_by = "type";
  EXPECT_THROW(make(), base::Error);
  options.material = "metal";
  make();
  EXPECT_TRUE(read().points[0].color.is_set());
}

/// The radiance of the background in a direction; of a shorter vector, the mean of directions with this mean.
double background_of(const scene::Scene& scene, const Vec3d& direction) {
  const scene::Background& from = scene.background;
  if (from.type == scene::BackgroundType::kConstant) return from.color.x;
  return std::lerp(from.bottom.x, from.top.x, (1 + math::dot(direction, from.up)) / 2);
}

/// The mean over the image of an unoccluded matte sphere's radiance, divided by its albedo: the mean over the visible
/// normals of the irradiance from the lamp, by quadrature, and from the background.
double mean_of_sphere(const scene::Scene& scene) {
  const scene::Sphere& lamp = scene.spheres.at(0);
  const double distance = math::length(lamp.center), size = lamp.radius / distance;
  const Vec3d toward = lamp.center / distance, back = math::normalized(scene.camera.look_from - scene.camera.look_at);
  const double radiance = std::get<scene::Emitter>(scene.materials[lamp.material].model).radiance.x;
  constexpr int kSteps = 40;
  constexpr double kPi = 3.14159265358979;
  const Vec3d u = math::normalized(math::cross(toward, back)), v = math::cross(toward, u);
  const Vec3d across = math::normalized(math::cross(back, toward)), down = math::cross(back, across);
  double sum = 0;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      // Uniform over the visible disc.
      const double r = std::sqrt((i + 0.5) / kSteps), phi = (j + 0.5) / kSteps * 2 * kPi;
      const Vec3d normal = across * (r * std::cos(phi)) + down * (r * std::sin(phi)) + back * std::sqrt(1 - r * r);
      for (int k = 0; k < kSteps; ++k)
        for (int l = 0; l < kSteps; ++l) {
          // Uniform over the cone of directions to the lamp.
          const double cosine = 1 - (k + 0.5) / kSteps * (1 - std::sqrt(1 - size * size));
          const double sine = std::sqrt(1 - cosine * cosine), turn = (l + 0.5) / kSteps * 2 * kPi;
          const Vec3d to = toward * cosine + u * (sine * std::cos(turn)) + v * (sine * std::sin(turn));
          sum += std::max(0.0, math::dot(normal, to)) * (radiance - background_of(scene, to));
        }
    }
  const double solid_angle = 2 * kPi * (1 - std::sqrt(1 - size * size));
  // The lamp hides a part of the background.
  const double from_lamp = solid_angle / kPi * sum / std::pow(kSteps, 4);
  EXPECT_GT(math::dot(lamp.center - scene.camera.look_from, back), lamp.radius) << "behind the camera";
  EXPECT_LT(math::dot(lamp.center, math::cross(scene.camera.up, back)), 0) << "left";
  EXPECT_GT(math::dot(lamp.center, scene.camera.up), 0) << "above";
  return from_lamp + background_of(scene, back * (4.0 / 9));
}

TEST_F(PlotPlot, TheMeanOfASphereIsItsColor) {
  for (const Style style : {Style::kStudio, Style::kSoft, Style::kIllustration})
    for (const char* view : {"iso", "0,0", "30,-40", "+z"}) {
      options.style = style;
      options.look_from = view;
      make("a.csv", "x,y,z,radius\n0,0,0,1\n");
      EXPECT_NEAR(mean_of_sphere(read()), 1, 3e-3) << static_cast<int>(style) << view;
    }
  for (const Style style : {Style::kFlat, Style::kAmbient}) {
    options.style = style;
    make();
    EXPECT_EQ(read().background.color, (Vec3d{1, 1, 1})) << "white light";
    EXPECT_TRUE(read().spheres.empty()) << "alone";
  }
}

TEST_F(PlotPlot, ShadedStylesCompressBrightColors) {
  options.develops = true;
  make("a.csv", kCorners);
  EXPECT_EQ(read().color.view, "Neutral");
  EXPECT_TRUE(chose("view transform Neutral", {"--exact-colors"}));
  options.style = Style::kFlat;
  make();
  EXPECT_EQ(read().color.view, "Un-tone-mapped");
  options.style.reset();
  options.exact_colors = true;
  make();
  EXPECT_EQ(read().color.view, "Un-tone-mapped");
  EXPECT_TRUE(chose("view transform Un-tone-mapped", {"match"}));
}

TEST_F(PlotPlot, ManySpheresHaveMoreLight) {
  const auto light = [&] { return read().background.top.x; };
  options.look_from = "0,0";
  make("a.csv", kCorners);
  const double few = light();
  std::string rows = "x,y,z\n";
  for (int i = 0; i < 500; ++i) rows += std::to_string(i % 10) + "," + std::to_string(i / 10) + ",0\n";
  make("a.csv", rows);
  EXPECT_NEAR(light() / few, std::exp2(0.4), 1e-9);
  EXPECT_TRUE(chose("light +0.4 stops", {"--exact-colors"}));
  options.exact_colors = true;
  make();
  EXPECT_NEAR(light(), few, 1e-9);
}

TEST_F(PlotPlot, MoleculesHaveADepthCue) {
  make("a.csv", kCorners);
  EXPECT_EQ(read().camera.depth_cue, 0);
  options.depth_cue = 0.5;
  make();
  EXPECT_EQ(read().camera.depth_cue, 0.5);
  EXPECT_FALSE(read().camera.depth_cue_range) << "that of the image";
  options.depth_cue.reset();
  make("a.pdb",
       "ATOM      1  CA  ALA A   1       0.000   0.000   0.000  1.00  0.00           C\n"
       "ATOM      2  CA  ALA B   2       0.000   0.000   9.000  1.00  0.00           C\n");
  EXPECT_EQ(read().camera.depth_cue, kDepthCue);
  EXPECT_TRUE(chose("depth cue 0.35", {"molecules", "--depth-cue 0"}));
  options.slices = {{2, 5}};
  make();
  EXPECT_EQ(read().camera.depth_cue, 0) << "it would make the shade inside grey";
  options.slices.clear();
  options.depth_cue = 0;
  make();
  EXPECT_EQ(read().camera.depth_cue, 0);
}

TEST_F(PlotPlot, AtomsWithoutABoxAreMoleculesInAnyFormat) {
  make("a.xyz", "2\n\nO 0 0 0\nH 0 0 1\n");
  EXPECT_EQ(read().camera.depth_cue, kDepthCue);
  EXPECT_NE(choices().find("view auto"), std::string::npos) << choices();
  make("a.xyz", "2\nLattice=\"5 0 0 0 5 0 0 0 5\"\nO 0 0 0\nH 0 0 1\n");
  EXPECT_EQ(read().camera.depth_cue, 0);
}

/// Seen from +z, spheres of radius 1 at 0 and 10 in the frames.
TEST_F(PlotPlot, TheDepthCueOfAllFramesHasOneRange) {
  options.depth_cue = 0.4;
  options.look_from = "+z";
  options.all_frames = true;
  options.points.radius.value = 1;
  make("a.dump", frame("id x y z", {"1 0 0 0"}) + frame("id x y z", {"1 0 0 10"}));
  const scene::Camera camera = read().camera;
  ASSERT_TRUE(camera.depth_cue_range);
  const double nearest = camera.look_from.z - 11, farthest = camera.look_from.z + 1;
  EXPECT_NEAR(camera.depth_cue_range->high, farthest, 1e-9);
  EXPECT_NEAR(camera.depth_cue_range->low, nearest + 0.1 * (farthest - nearest), 1e-9);
}

TEST_F(PlotPlot, OutlinesAreDividedByAColumn) {
  options.outline_by = "mass";
  make("a.csv", kCorners);
  const scene::Scene scene = read();
  EXPECT_EQ(scene.points[0].cryptomatte, std::vector<std::string>{"mass"});
  EXPECT_TRUE(scene.annotation.outline_objects);
  EXPECT_NEAR(scene.annotation.outline, 1080.0 / 400, 0.01) << "as wide in any resolution";
  options.annotation.outline = 5;
  make();
  EXPECT_EQ(read().annotation.outline, 5);
  options.annotation.outline = 0;
  options.outline_by = "";
  options.annotation.outline_depth = 1;
  make();
  EXPECT_NEAR(read().annotation.outline, 1080.0 / 400, 0.01) << "implied";
  options.outline_by = "none";
  EXPECT_TRUE(test::mentions(error(), {"--outline-by", "column `none`"}));
}

TEST_F(PlotPlot, AnIllustrationHasOutlinesBetweenChains) {
  options.style = Style::kIllustration;
  make("a.csv", kCorners);
  EXPECT_FALSE(read().annotation.outline_objects) << "no chains";
  EXPECT_GT(read().annotation.outline, 0);
  EXPECT_EQ(read().camera.depth_cue, kDepthCue);
  make("a.csv", "x,y,z,chain\n0,0,0,A\n1,0,0,B\n");
  EXPECT_EQ(read().points[0].cryptomatte, std::vector<std::string>{"chain"});
  EXPECT_TRUE(chose("outlines by chain", {"style", "--outline-by"}));
}

TEST_F(PlotPlot, TheGroundIsThePage) {
  options.ground = true;
  options.look_from = "30,20";
  for (const Style style : {Style::kStudio, Style::kSoft, Style::kAmbient}) {
    options.style = style;
    make("a.csv", kCorners);
    const scene::Scene scene = read();
    EXPECT_TRUE(scene.spheres[0].is_page);
    // The light on the ground, where nothing shades it.
    double irradiance = background_of(scene, Vec3d{0, 0, 2.0 / 3});
    if (scene.spheres.size() > 1) {
      const scene::Sphere& lamp = scene.spheres[1];
      const double distance = math::length(lamp.center - scene.camera.look_at);
      irradiance += std::get<scene::Emitter>(scene.materials[lamp.material].model).radiance.x *
                    std::pow(lamp.radius / distance, 2) * (lamp.center.z - scene.camera.look_at.z) / distance;
    }
    const double albedo = std::get<scene::Lambertian>(scene.materials[scene.spheres[0].material].model).albedo.x;
    EXPECT_NEAR(albedo * irradiance, 1, 5e-3) << static_cast<int>(style);
  }
  options.style = Style::kNight;
  make();
  EXPECT_FALSE(read().spheres[0].is_page) << "a dark floor";
}

TEST_F(PlotPlot, TheBackgroundIsAColorOrTransparent) {
  options.background = points::parse_color("#ff8000");
  make("a.csv", kCorners);
  EXPECT_EQ(shown(read())[0], (std::array<int, 3>{255, 128, 0}));
  EXPECT_EQ(read().background.alpha, 1);
  options.transparent = true;
  make();
  EXPECT_EQ(read().background.alpha, 0);
  EXPECT_EQ(points::parse_color("black"), (Vec3d{0, 0, 0}));
  EXPECT_EQ(points::parse_color("#f80"), points::parse_color("#ff8800"));
  EXPECT_EQ(points::parse_color("Navy"), points::parse_color("#000080"));
  EXPECT_EQ(points::parse_color("grey"), points::parse_color("gray"));
  for (const char* text : {"", "puce", "#ff800", "#ff", "#ff80000", "#gg0000", "ff8000"})
    EXPECT_THROW(points::parse_color(text), base::Error) << text;
}

TEST_F(PlotPlot, QualitiesAreNoiseOrSamples) {
  make("a.csv", kCorners);
  EXPECT_EQ(made.noise, 0.15);
  EXPECT_TRUE(made.denoise);
  options.quality = Quality::kFinal;
  make();
  EXPECT_EQ(made.noise, 0.02);
  EXPECT_FALSE(made.denoise);
  options.quality = Quality::kDraft;
  make();
  EXPECT_FALSE(made.noise);
  EXPECT_TRUE(made.denoise);
  EXPECT_EQ(read().render.samples, 4);
  options.has_target = true;
  EXPECT_EQ(error(), "--quality excludes --noise, --time and --samples: it sets them");
}

TEST_F(PlotPlot, CenterAndZoomMoveTheCamera) {
  for (const bool is_perspective : {false, true}) {
    if (is_perspective) options.vfov_deg = 30;
    options.center.clear();
    options.zoom = 1;
    make("a.csv", kCorners);
    const scene::Camera all = read().camera;
    options.center = "mass == 8";  // at 4, 4, 4
    options.zoom = 4;
    make();
    const scene::Camera camera = read().camera;
    const Vec3d back = math::normalized(all.look_from - all.look_at);
    EXPECT_LT(math::length(camera.look_at - Vec3d{4, 4, 4}), 1e-12);
    EXPECT_LT(math::length(math::cross(back, camera.look_from - camera.look_at)), 1e-12) << "the same direction";
    if (is_perspective) {
      EXPECT_NEAR(math::dot(camera.look_from - all.look_from, back), 0, 1e-12) << "not into the spheres";
      EXPECT_NEAR(std::tan(camera.vfov / 360 * 3.14159265358979) * 4, std::tan(15.0 / 180 * 3.14159265358979), 1e-9);
    } else {
      EXPECT_NEAR(*camera.width * 4, *all.width, 1e-9);
      EXPECT_EQ(camera.vfov, scene::Camera().vfov) << "it would have no effect";
    }
  }
  options.center = "mass == 10";
  EXPECT_TRUE(test::mentions(error(), {"--center `mass == 10`", "none"}));
  options.points.select = "mass < 8";
  options.center = "mass == 8";
  EXPECT_TRUE(test::mentions(error(), {"--center `mass == 8`", "none"}));
}

/// Elements of many atoms are noise.
TEST_F(PlotPlot, ManyAtomsAreColoredByChain) {
  std::string text;
  for (int i = 0; i < 5000; ++i)
    text += fmt::format("ATOM  {:5}  CA  ALA {} {:3}    {:8.3f}{:8.3f}{:8.3f}  1.00  0.00           C\n", i,
                        i % 2 == 0 ? 'A' : 'B', i % 1000, i % 50 * 2.0, i / 50 % 50 * 2.0, i / 2500 * 2.0);
  make("a.pdb", text + "END\n");
  EXPECT_TRUE(chose("colour by chain: many atoms; --color-by element shows elements")) << choices();
  EXPECT_EQ(read().points[0].color.map, "set2");
  EXPECT_EQ(read().points[0].palette.size(), 2u);
  options.has_map = true;
  options.points.color.map = "set2";
  make();
  EXPECT_EQ(read().points[0].palette.size(), 2u) << "with any map";
  options.has_map = false;
  options.points.color.map = {};
  options.points.select = "residue_number < 10";  // few of them are shown
  make("few.pdb", text + "ATOM   5000  O   ALA A 999      90.000  90.000  90.000  1.00  0.00           O\nEND\n");
  EXPECT_TRUE(chose("colour by chain+element: several chains; --color-by element shows elements alone")) << choices();
  options.points.select.clear();
  write("a.pdb", text + "END\n");
  options.color_by = "element";
  make();
  EXPECT_EQ(read().points[0].color.element, "soft");
  options.color_by.clear();
  const std::string assembly =
      "REMARK 350 BIOMOLECULE: 1\nREMARK 350 APPLY THE FOLLOWING TO CHAINS: A\n"
      "REMARK 350   BIOMT1   1  1.000000  0.000000  0.000000        0.00000\n"
      "REMARK 350   BIOMT2   1  0.000000  1.000000  0.000000        0.00000\n"
      "REMARK 350   BIOMT3   1  0.000000  0.000000  1.000000        0.00000\n";
  options.points.assembly = "1";
  make("b.pdb", assembly + text.substr(0, 81 * 2) + "END\n");
  EXPECT_TRUE(chose("colour by chain: an assembly; --color-by element shows elements")) << choices();
}

TEST_F(PlotPlot, AtomsOfOneElementAreColoredByChain) {
  const auto atom = [](int i, char element) {
    return fmt::format("ATOM  {:5}  CB  ALA {} {:3}    {:8.3f}{:8.3f}{:8.3f}  1.00  0.00           {}\n", i,
                       i % 2 == 0 ? 'A' : 'B', i, i * 2.0, 0.0, 0.0, element);
  };
  make("a.pdb", atom(1, 'C') + atom(2, 'C') + "END\n");
  EXPECT_TRUE(chose("colour by chain", {"one element", "--color-by element"})) << choices();
  EXPECT_EQ(read().points[0].palette.size(), 2u);
  options.points.select = "element == \"C\"";  // not what is shown decides
  make("a.pdb", atom(1, 'C') + atom(2, 'O') + "END\n");
  EXPECT_TRUE(chose("colour by chain+element: several chains; --color-by element shows elements alone")) << choices();
}

/// The columns of a long row would reach below the colour bar.
TEST_F(PlotPlot, SpheresAreBesideTheAnnotation) {
  set("image={width=640,height=360}");
  options.color_by = "mass";
  options.look_from = "-y";
  std::string row = "x,y,z,mass\n";
  for (int x = 0; x < 40; ++x)
    for (int z = 0; z < 12; ++z) row += fmt::format("{},0,{},{}\n", x, z, x);
  make("a.csv", row);
  const double fitted = *read().camera.width;
  options.annotation.color_bar = true;
  options.annotation.scale_bar = 0;
  options.annotation.title = "frame {frame}, from the side";
  make();
  const double beside_the_bar = *read().camera.width;
  EXPECT_GT(beside_the_bar, fitted);
  EXPECT_LT(beside_the_bar, fitted * 1.3);
  expect_spheres_beside_annotation();
  // Long names are cut off.
  const std::string end(50, 'x');
  for (int i = 0; i < 480; ++i)
    row = i == 0 ? "x,y,z,type\n" : row + fmt::format("{},0,{},{}{}\n", i % 40, i / 40, i % 30, end);
  options.color_by = "type";
  make("b.csv", row);
  EXPECT_GT(*read().camera.width, beside_the_bar);
  expect_spheres_beside_annotation();
}

TEST_F(PlotPlot, AtomsOfATraceAreDrawnAsOne) {
  const auto atom = [](int i, const char* name) {
    return fmt::format("ATOM  {:5} {:<4} ALA A {:3}    {:8.3f}{:8.3f}{:8.3f}  1.00  0.00           C\n", i, name, i,
                       i * 3.8, 0.0, 0.0);
  };
  make("a.pdb", atom(1, " CA") + atom(2, " CA") + atom(4, " CA") + "END\n");
  EXPECT_TRUE(test::mentions(choices(), {"representation trace", "material plastic"})) << choices();
  EXPECT_EQ(read().points[0].bond_pairs.size(), 1u) << "residue 3 is missing";
  make("b.pdb", atom(1, " CA") + atom(2, " CB") + "END\n");
  EXPECT_TRUE(read().points[0].bond_pairs.empty());
  options.representation = Representation::kSpheres;
  make("a.pdb", atom(1, " CA") + atom(2, " CA") + "END\n");
  EXPECT_TRUE(read().points[0].bond_pairs.empty());
}

/// A crystal of n^3 cells with atoms at some places.
std::string crystal(const std::vector<std::pair<std::string, Vec3d>>& atoms, double edge, int n) {
  std::string rows;
  for (int i = 0; i < n * n * n; ++i)
    for (const auto& [element, at] : atoms)
      rows += fmt::format("{} {} {} {}\n", element, (i % n + at.x) * edge, (i / n % n + at.y) * edge,
                          (i / n / n + at.z) * edge);
  const double length = n * edge;
  return fmt::format("{}\nLattice=\"{} 0 0 0 {} 0 0 0 {}\" Properties=species:S:1:pos:R:3\n{}",
                     static_cast<int>(atoms.size()) * n * n * n, length, length, length, rows);
}

/// Van der Waals radii would bury the lattice.
TEST_F(PlotPlot, AtomsOfNetworksHaveSmallerRadii) {
  make("cu.xyz",
       crystal({{"Cu", {0, 0, 0}}, {"Cu", {0.5, 0.5, 0}}, {"Cu", {0.5, 0, 0.5}}, {"Cu", {0, 0.5, 0.5}}}, 3.6, 3));
  EXPECT_NEAR(read().points[0].radii[0], 3.6 / std::sqrt(8), 1e-3) << "half the distance to the nearest neighbour";
  EXPECT_TRUE(test::mentions(choices(), {"half the median distance", "metal"})) << choices();
  make("salt.xyz", crystal({{"Na", {0, 0, 0}},
                            {"Cl", {0.5, 0, 0}},
                            {"Na", {0.5, 0.5, 0}},
                            {"Cl", {0, 0.5, 0}},
                            {"Cl", {0, 0, 0.5}},
                            {"Na", {0.5, 0, 0.5}},
                            {"Cl", {0.5, 0.5, 0.5}},
                            {"Na", {0, 0.5, 0.5}}},
                           5.64, 2));
  EXPECT_EQ(read().points[0].radius.element, "covalent");
  make("water.xyz", "3\n\nO 0 0 0\nH 0.96 0 0\nH -0.24 0.93 0\n");
  EXPECT_EQ(read().points[0].radius.element, "vdw");
  make("argon.xyz", crystal({{"Ar", {0, 0, 0}}}, 3.8, 3));
  EXPECT_EQ(read().points[0].radius.element, "vdw");
  options.points.radius.element = "vdw";
  make("cu.xyz", crystal({{"Cu", {0, 0, 0}}}, 2.5, 3));
  EXPECT_EQ(read().points[0].radius.element, "vdw") << "the user's";
}

/// Of many atoms, those around one of them are a sample.
TEST_F(PlotPlot, NetworksOfManyAtomsAreRecognized) {
  make("cu.xyz", crystal({{"Cu", {0, 0, 0}}}, 2.5, 48));
  EXPECT_EQ(read().points[0].radius.value, 1.25) << choices();
}

TEST_F(PlotPlot, MoleculesAreSeenAlongTheirPrincipalAxes) {
  // A planar molecule, tilted.
  std::string rows;
  for (int i = 0; i < 24; ++i) {
    const double x = 3 * std::cos(i * 0.26), y = 2 * std::sin(i * 0.26);
    rows += fmt::format("C {} {} {}\n", x, y * 0.8, y * 0.6);
  }
  options.points.radius.value = 0.1;
  write("a.xyz", "24\n\n" + rows);
  make();
  const auto back = [&] {
    const scene::Camera camera = read().camera;
    return math::normalized(camera.look_from - camera.look_at);
  };
  EXPECT_NEAR(std::abs(math::dot(back(), Vec3d{0, -0.6, 0.8})), 1, 1e-6);
  EXPECT_NEAR(std::abs(read().camera.up.x), 0, 0.01) << "the longest direction is horizontal";
  const Vec3d all = back();
  options.points.select = "x < 0 || y > 0";
  make();
  EXPECT_LT(math::length(math::cross(back(), all)), 1e-6) << "of what is shown, which is as planar";
  options.points.select.clear();
  options.up = "z";
  make();
  EXPECT_TRUE(test::mentions(choices(), {"view 30,20"})) << "an axis that shall point up does: " << choices();
  options.up.clear();
  options.look_from = "auto";
  make("b.csv", "x,y,z,radius\n0,0,0,1\n9,0,0,1\n");
  EXPECT_NEAR(std::abs(read().camera.up.x), 0, 1e-6) << "on request, any data";
}

/// The view is that of the first frame, whichever is shown.
TEST_F(PlotPlot, AllFramesHaveTheViewOfTheFirst) {
  const std::string first = "3\n\nC 0 0 0\nC 1 0 0\nC 0 3 0\n", second = "3\n\nC 0 0 0\nC 0 1 0\nC 0 0 3\n";
  write("a.xyz", first + second);
  make();
  const scene::Camera of_first = read().camera;
  options.points.frame = 2;
  make();
  const scene::Camera of_second = read().camera;
  EXPECT_LT(math::length(math::normalized(of_first.look_from - of_first.look_at) -
                         math::normalized(of_second.look_from - of_second.look_at)),
            1e-9);
  EXPECT_LT(math::length(of_first.up - of_second.up), 1e-9);
}

TEST_F(PlotPlot, TheCameraIsFittedToSomeParticlesAndOthersAreClipped) {
  write("a.csv", kCorners);
  options.look_from = "+z";
  make();
  const double all = *read().camera.width;
  options.fit = "mass in [5, 6]";  // at 0 and 4, 0, 4
  make();
  const scene::Camera camera = read().camera;
  EXPECT_LT(*camera.width, all);
  EXPECT_LT(math::length(camera.look_at - Vec3d{2, 0, 4}), 1e-9);
  const scene::Scene fitted = read();
  EXPECT_EQ(fitted.points[0].centers.size(), 9u);
  for (const Vec3d& center : fitted.points[0].centers)
    EXPECT_LT(center.z + 2, camera.look_from.z) << "the camera is in front of all spheres";
  options.fit = "mass == 9";  // at 1, 0, 0
  options.near = 0;
  make();
  EXPECT_EQ(read().points[0].centers.size(), 5u) << "those in front are removed";
  options.near = 3.9;
  EXPECT_EQ((make(), read().points[0].centers.size()), 9u) << "from the front of the target";
  options.near = 0;
  options.fit = "mass == 5";
  options.far = 0;
  EXPECT_EQ((make(), read().points[0].centers.size()), 4u) << "and those behind";
  options.fit.clear();
  EXPECT_TRUE(test::mentions(error(), {"--near", "--fit CONDITION"}));
  options.fit = "mass == 50";
  EXPECT_TRUE(test::mentions(error(), {"--fit", "matches none"}));
  write("a.dump", frame("x y z radius", {"1 0 0 1", "2 0 0 1"}));
  options.fit = "x == 1";
  options.points.replicate = {2, 1, 1};
  EXPECT_TRUE(test::mentions(error(), {"--near excludes", "--replicate"}));
}

TEST_F(PlotPlot, APerspectiveCameraIsFitted) {
  set("camera.vfov=30");
  make("a.csv", kCorners);
  EXPECT_EQ(choices().find(" wide"), std::string::npos) << choices();
  const scene::Scene scene = read();
  EXPECT_EQ(scene.camera.projection, scene::Projection::kPerspective);
  EXPECT_EQ(scene.camera.vfov, 30);
  const Vec3d back = math::normalized(scene.camera.look_from - scene.camera.look_at);
  const Vec3d right = math::cross(scene.camera.up, back);
  double reach = 0;
  for (const Vec3d& c : scene.points[0].centers) {
    const Vec3d at = c - scene.camera.look_from;
    const double seen = -math::dot(at, back) * std::tan(15.0 / 180 * 3.14159265358979);
    reach = std::max(
        {reach, std::abs(math::dot(at, right)) / seen / (16.0 / 9), std::abs(math::dot(at, scene.camera.up)) / seen});
  }
  EXPECT_LT(reach, 0.9);
  EXPECT_GT(reach, 0.3) << "not a speck";
}

/// A rod that points at the camera is seen from the side after a quarter of the orbit.
TEST_F(PlotPlot, ATurntableFitsTheWholeOrbitAndAllFrames) {
  std::string rod = "x,y,z,radius\n";
  for (int i = -20; i <= 20; ++i) rod += std::to_string(i) + ",0,0,1\n";
  write("a.csv", rod);
  for (const char* view : {"+x", "90,30", "iso", "+z", "0,-40"})
    for (const bool is_perspective : {false, true}) {
      options.look_from = view;
      set("animation.turntable=8");
      if (is_perspective) options.overrides.add("camera.vfov=40");
      options.frames = {1, 2, 3, 4, 5, 6, 7, 8};
      make();
      scene::Scene turning = read();
      turning.animation.turntable = 8;
      double reach = 0;
      for (const int frame : options.frames) {
        const scene::Camera camera = scene::posed(turning, frame).camera;
        const Vec3d back = math::normalized(camera.look_from - camera.look_at);
        const Vec3d right = math::normalized(math::cross(camera.up, back)), up = math::cross(back, right);
        for (const Vec3d& c : turning.points[0].centers) {
          const Vec3d at = c - camera.look_from;
          const double half = is_perspective ? -math::dot(at, back) * std::tan(20.0 / 180 * 3.14159265358979) * 16 / 9
                                             : *camera.width / 2;
          ASSERT_GT(-math::dot(at, back), 1) << view;
          reach = std::max(
              {reach, (std::abs(math::dot(at, right)) + 1) / half, (std::abs(math::dot(at, up)) + 1) / half * 16 / 9});
        }
        EXPECT_EQ(camera.up, std::string(view) == "+z" ? (Vec3d{0, 1, 0}) : (Vec3d{0, 0, 1})) << "upright";
      }
      EXPECT_LE(reach, 0.9 + 0.02) << view << is_perspective;
      EXPECT_GT(reach, 0.4) << view << is_perspective;
    }
}

/// From level or below, the ground would be in front of the spheres, or a bar at the bottom of the image.
TEST_F(PlotPlot, TheGroundIsOmittedIfItWouldHideTheSpheres) {
  write("a.csv", "x,y,z,radius\n0,0,2,1\n0,0,7,1\n");
  options.ground = true;
  const auto has_ground = [&](const std::string& view) {
    options.look_from = view;
    make();
    const bool has_note = choices().find("no ground: ") != std::string::npos;
    const bool has_sphere = read().spheres.size() > 1;  // the other one is the key light
    EXPECT_NE(has_note, has_sphere) << view << ": " << choices();
    return has_sphere;
  };
  for (const char* view : {"iso", "+z", "30,20", "0,90", "200,10"}) EXPECT_TRUE(has_ground(view)) << view;
  for (const char* view : {"-z", "30,-20", "-y", "+x", "0,0", "90,-0.001"}) EXPECT_FALSE(has_ground(view)) << view;
  // The lower corners of a tall image would be below the ground.
  set("image={width=16,height=320}");
  EXPECT_FALSE(has_ground("30,20"));
}

TEST_F(PlotPlot, WithoutLookOptionsTheirDefaultsArePrinted) {
  options.style = Style::kStudio;
  set("image.width=16");
  make("a.csv", kCorners);
  EXPECT_EQ(choices().find("style"), std::string::npos) << choices();
  EXPECT_EQ(choices().find("size"), std::string::npos) << choices();
}

TEST_F(PlotPlot, OptionsOfAMapWithoutAMapAreRefused) {
  write("a.csv", kCorners);
  options.points.color.range = scene::Interval{0, 1};
  EXPECT_TRUE(test::mentions(error(), {"--range", "nothing to map", "--color-by COLUMN"}));
  options.color_by = "none";
  EXPECT_NE(error().find("--range has nothing to map"), std::string::npos) << error();
  options.points.color.range.reset();
  options.points.color.map = "viridis";
  options.has_map = true;
  EXPECT_NE(error().find("--map has nothing to map"), std::string::npos) << error();
  options.color_by = "mass";
  EXPECT_EQ(error(), "no error");
  options.points.color.map = "tab10";
  options.points.color.range = scene::Interval{0, 1};
  EXPECT_TRUE(test::mentions(error(), {"--range", "no effect", "tab10"}));
  write("b.dump", frame("x y z radius type", {"0 0 0 1 2"}));
  options.color_by.clear();
  options.points.color.range.reset();
  options.points.color.map = "viridis";
  EXPECT_EQ(error(), "no error") << "types have values";
}

TEST_F(PlotPlot, AColorBarExplainsColors) {
  write("a.csv", kCorners);
  options.annotation.color_bar = true;
  EXPECT_TRUE(test::mentions(error(), {"--color-bar", "nothing to explain", "--color-by COLUMN"}));
  options.color_by = "mass";
  EXPECT_EQ(error(), "no error");
  options.color_by = "element";
  write("a.xyz", "1\n\nC 0 0 0\n");
  EXPECT_EQ(error(), "no error");
}

TEST_F(PlotPlot, DataOutsideTheRangeOfAPlotAreNamed) {
  const auto remedy_for = [&](const std::string& rows) -> std::string {
    try {
      make("a.csv", "x,y,z\n0,0,0\n" + rows);
    } catch (const base::Error& e) {
      return e.diagnostics().at(0).remedy;
    }
    return "no error";
  };
  options.points.radius.value = 1;
  options.look_from = "iso";
  const std::string far = "0,-1e17,0\n";
  EXPECT_TRUE(test::mentions(remedy_for(far), {"larger unit", "within 7.8e+14"}));
  EXPECT_TRUE(test::mentions(error(), {"1e+17", "lamp", "1.3e+20", "largest", "1e+18"}));
  EXPECT_EQ(remedy_for("0,-7.7e14,0\n"), "no error");
  options.style = Style::kAmbient;
  EXPECT_EQ(remedy_for(far), "no error") << "without a lamp";
  options.ground = true;
  EXPECT_TRUE(test::mentions(remedy_for(far), {"larger unit", "within 2e+15"}));
  EXPECT_EQ(remedy_for("0,-1.9e15,0\n"), "no error");
  options.ground = false;
  options.vfov_deg = 0.1;
  EXPECT_TRUE(test::mentions(remedy_for(far), {"larger unit", "within 6.6e+15"}));
  EXPECT_EQ(remedy_for("0,-6.5e15,0\n"), "no error");
}

TEST_F(PlotPlot, ComponentsOfOtherFormatsAreRefused) {
  write("a.csv", kCorners);
  options.points.component = 1;
  EXPECT_EQ(error(), "--component: " + options.file.string() + " is CSV; only HDF5 files have components");
}

TEST_F(PlotPlot, SeveralFramesAreKnownBeforeTheSecondIsRead) {
  options.all_frames = true;
  write("a.dump", frame("x y z", {"0 0 0"}) + frame("x y z", {"0 0 zero"}) + frame("x y z", {"0 0 0"}));
  std::vector<std::vector<int>> known;
  const auto check = [&](const std::vector<int>& frames) {
    known.push_back(frames);
    throw base::Error(base::ErrorKind::kUsage, "checked");
  };
  try {
    make_plot(options, check);
    FAIL() << "no error";
  } catch (const base::Error& e) {
    EXPECT_STREQ(e.what(), "checked");
  }
  EXPECT_EQ(known, (std::vector<std::vector<int>>{{1, 2}, {1, 2, 3}})) << "the error tells of all";
}

TEST_F(PlotPlot, FileNamesCannotAddLines) {
  make("a\"\n[image]\n.csv", kCorners);
  EXPECT_EQ(read().points[0].file, "a\"\n[image]\n.csv");
}

TEST_F(PlotPlot, PathsAreRelativeToTheScene) {
  write("a.csv", kCorners);
  std::filesystem::create_directory(folder_ / "scenes");
  options.scene_file = folder_ / "scenes/scene.toml";
  made = make_plot(options);
  EXPECT_EQ(made.points.file, "../a.csv");
}

TEST_F(PlotPlot, FaultsNameTheKey) {
  write("a.csv", kCorners);
  options.points.select = "mas > 1";
  EXPECT_NE(error().find("select: at character 1: unknown column mas"), std::string::npos) << error();
  options.points.select.clear();
  options.color_by = "mas";
  EXPECT_TRUE(test::mentions(error(), {"color.column", "`mas`", "`mass`"}));
  options.color_by.clear();
  options.look_from = "above";
  EXPECT_NE(error().find("`above` is not a view"), std::string::npos) << error();
}

}  // namespace
}  // namespace orrery::plot
