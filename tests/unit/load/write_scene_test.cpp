// SPDX-License-Identifier: Apache-2.0
#include "load/write_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <random>
#include <set>

#include <fmt/core.h>

#include "base/error.h"
#include "scene/animation.h"
#include "scene/schema.h"
#include "scene/texture.h"
#include "support/scene_files.h"

namespace orrery::load {
namespace {

using math::Vec3d;
using scene::Value;
using scene::ValueType;
using support::SceneFiles;

/// Makes scenes of random values, one of each key that the schema describes.
class RandomScene {
 public:
  explicit RandomScene(std::uint64_t seed) : random_(seed) {}

  scene::Scene make() {
    scene::Scene s;
    for (const scene::Table& table : scene::tables()) fill(table.keys, s);
    for (std::size_t i = below(4); i < 4; ++i) s.materials.push_back({fmt::format("{}{}", word(), i), material()});
    if (s.materials.empty()) s.materials.push_back({"a.b", scene::Dielectric{}});
    for (std::size_t i = below(4); i < 4; ++i) {
      scene::Sphere sphere;
      fill_all(scene::sphere_keys(), sphere);
      sphere.name = fmt::format("{}{}", word(), i);
      sphere.material = static_cast<std::uint32_t>(below(s.materials.size()));
      s.spheres.push_back(sphere);
    }
    for (std::size_t i = below(4); i < 4; ++i) {
      scene::Rod rod;
      fill_all(scene::rod_keys(), rod);
      rod.name = fmt::format("{}{}", word(), i);
      for (std::uint32_t& half : rod.materials) half = static_cast<std::uint32_t>(below(s.materials.size()));
      s.rods.push_back(rod);
    }
    for (std::size_t i = below(4); i < 3; ++i) {
      scene::Points points;
      fill<scene::PointsKeys>(scene::points_keys(), points);
      points.file = word() + ".ply";
      points.material = static_cast<std::uint32_t>(below(s.materials.size()));
      if (below(2) == 0) points.bonds.material = static_cast<std::uint32_t>(below(s.materials.size()));
      if (points.opacity.value) points.opacity = {*points.opacity.value, "", {}, {}};
      if (points.radius.value)
        points.radius = {*points.radius.value, "", "", {}, 1, {}};  // excludes the keys of its table
      s.points.push_back(points);
    }
    for (std::size_t i = below(4); i < 3; ++i) {
      scene::RodFile rods;
      fill(scene::rod_file_keys(), rods);
      rods.file = word() + ".csv";
      for (std::uint32_t& half : rods.materials) half = static_cast<std::uint32_t>(below(s.materials.size()));
      s.rod_files.push_back(rods);
    }
    for (const std::string& name : scene::animated_names(s))
      if (const auto target = below(8) == 0 ? scene::find_animated(s, name) : std::nullopt)
        s.tracks.push_back(track(name, *target));
    return s;
  }

 private:
  std::size_t below(std::size_t n) { return random_() % n; }

  double number(const scene::Range& range) {
    const double ends[] = {range.from, range.to, 0.0, -0.0, 1.0 / 3};
    for (;;) {
      const double u = std::uniform_real_distribution<double>(0, 1)(random_), at = ends[below(5)];
      const double x = below(3) == 0   ? at
                       : below(2) == 0 ? range.from + u * (range.to - range.from)
                                       : std::ldexp(u - 0.5, static_cast<int>(below(100)) - 60);
      if (range.contains(x)) return x;
    }
  }
  Vec3d vector(const scene::Range& range) { return {number(range), number(range), number(range)}; }
  std::string word() {
    const char* const parts[] = {"a", "B", "7", " ", ".", "\"", "\\", "\n", "\x1b", "\xC3\xBC", "#", "=", "]", "'"};
    std::string out = "w";
    for (std::size_t i = below(6); i > 0; --i) out += parts[below(std::size(parts))];
    return out;
  }

  template <class Target>
  Value value(const scene::Key<Target>& key) {
    switch (key.type) {
      case ValueType::kInteger:
        return std::uniform_int_distribution<std::int64_t>(static_cast<std::int64_t>(key.range.from),
                                                           static_cast<std::int64_t>(key.range.to))(random_);
      case ValueType::kNumber: return number(key.range);
      case ValueType::kVector: return vector(key.range);
      case ValueType::kText: return word();
      case ValueType::kName: return below(2) == 0 ? word() : "12";
      case ValueType::kInterval: {
        const double low = number(key.range);
        return scene::Interval{std::min(low, 0.5), std::max(low, 0.5) + 1};
      }
      case ValueType::kChoice: return key.choices[below(key.choices.size())];
      case ValueType::kWindow: return scene::Window{1, 2, static_cast<int>(below(9)), 4};
      case ValueType::kBoolean: return below(2) == 0;
      case ValueType::kChoices: return std::vector<std::string>{key.choices.back(), key.choices.front()};
      case ValueType::kTexts: return std::vector<std::string>{word(), word()};
      case ValueType::kNumbersByType:
        return scene::NumbersByType{{"1", number(key.range)}, {word(), number(key.range)}};
      case ValueType::kColorsByType: return scene::ColorsByType{{"1", vector(key.range)}, {word(), vector(key.range)}};
    }
    return {};
  }
  template <class Target>
  void fill_all(const std::vector<scene::Key<Target>>& keys, Target& target) {
    for (const auto& key : keys) key.set(target, value(key));
  }
  template <class Target>
  void fill(const std::vector<scene::Key<Target>>& keys, Target& target) {
    for (const auto& key : keys)
      if (below(2) == 0) key.set(target, value(key));
  }
  scene::MaterialModel material() {
    const scene::MaterialType& type = scene::material_types()[below(scene::material_types().size())];
    scene::MaterialModel out = type.model;
    fill(type.keys, out);
    for (const scene::TexturedKey& key : type.textured) {
      if (below(2) == 0) continue;
      for (const auto& constant : type.keys)
        if (constant.name == key.name) constant.set(out, constant.get(type.model).value());
      const scene::TextureTypeKeys& keys = scene::texture_types(key.use)[below(5)];
      scene::Texture texture;
      texture.type = keys.type;
      fill_all(keys.keys, texture);
      key.at(out) = std::make_shared<const scene::Texture>(texture);
    }
    return out;
  }
  scene::Track track(const std::string& name, const scene::Animated& target) {
    scene::Track out{name, static_cast<scene::Interpolation>(below(3)), {-1.5, 0.25, 1e5}, {}};
    for (std::size_t i = 0; i < 3; ++i)
      out.values.push_back(target.type == ValueType::kVector ? vector(target.range)
                                                             : Vec3d{number(target.range), 0, 0});
    return out;
  }

  std::mt19937_64 random_;
};

template <class Target>
void expect_same(const std::vector<scene::Key<Target>>& keys, const Target& a, const Target& b) {
  for (const auto& key : keys) EXPECT_EQ(key.text(a), key.text(b)) << key.name;
}

void expect_same(const scene::Scene& a, const scene::Scene& b) {
  for (const scene::Table& table : scene::tables()) expect_same(table.keys, a, b);
  ASSERT_EQ(a.materials.size(), b.materials.size());
  for (std::size_t i = 0; i < a.materials.size(); ++i) {
    EXPECT_EQ(a.materials[i].name, b.materials[i].name);
    ASSERT_EQ(a.materials[i].model.index(), b.materials[i].model.index());
    const scene::MaterialType& type = scene::material_types()[a.materials[i].model.index()];
    expect_same(type.keys, a.materials[i].model, b.materials[i].model);
    for (const scene::TexturedKey& key : type.textured) {
      const scene::TextureSlot from = key.get(a.materials[i].model), to = key.get(b.materials[i].model);
      ASSERT_EQ(from == nullptr, to == nullptr);
      if (from == nullptr) continue;
      ASSERT_EQ(from->type, to->type);
      expect_same(scene::texture_types(key.use)[static_cast<std::size_t>(from->type)].keys, *from, *to);
    }
  }
  ASSERT_EQ(a.spheres.size(), b.spheres.size());
  for (std::size_t i = 0; i < a.spheres.size(); ++i) {
    expect_same(scene::sphere_keys(), a.spheres[i], b.spheres[i]);
    EXPECT_EQ(a.spheres[i].material, b.spheres[i].material);
  }
  ASSERT_EQ(a.rod_files.size(), b.rod_files.size());
  for (std::size_t i = 0; i < a.rod_files.size(); ++i) {
    expect_same(scene::rod_file_keys(), a.rod_files[i], b.rod_files[i]);
    EXPECT_EQ(a.rod_files[i].materials, b.rod_files[i].materials);
  }
  ASSERT_EQ(a.rods.size(), b.rods.size());
  for (std::size_t i = 0; i < a.rods.size(); ++i) {
    expect_same(scene::rod_keys(), a.rods[i], b.rods[i]);
    EXPECT_EQ(a.rods[i].materials, b.rods[i].materials);
  }
  ASSERT_EQ(a.points.size(), b.points.size());
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    expect_same<scene::PointsKeys>(scene::points_keys(), a.points[i], b.points[i]);
    EXPECT_EQ(a.points[i].material, b.points[i].material);
  }
  ASSERT_EQ(a.tracks.size(), b.tracks.size());
  for (std::size_t i = 0; i < a.tracks.size(); ++i) {
    EXPECT_EQ(a.tracks[i].target, b.tracks[i].target);
    EXPECT_EQ(a.tracks[i].interpolation, b.tracks[i].interpolation);
    EXPECT_EQ(a.tracks[i].frames, b.tracks[i].frames);
    EXPECT_EQ(a.tracks[i].values, b.tracks[i].values);
  }
}

/// A scene file as authored; fails the test if the reader rejects it.
scene::Scene read_authored(const std::string& text, const Overrides& overrides = {}) {
  const SceneSource source{
      .file = "scene.toml", .overrides = overrides, .text = std::make_shared<const std::string>(text)};
  SceneReader reader(source, Pose::kAuthored);
  scene::Scene out = reader.scene();
  try {
    reader.finish();
  } catch (const base::Error& error) {
    ADD_FAILURE() << base::formatted(error.diagnostics().at(0)) << "\n" << text;
  }
  return out;
}

TEST(LoadWriteScene, AnySceneReadsBackToTheSameScene) {
  for (std::uint64_t seed = 0; seed < 300 && !testing::Test::HasFailure(); ++seed) {
    const scene::Scene written = RandomScene(seed).make();
    const std::string text = scene_text(written, "a comment");
    expect_same(written, read_authored(text));
    EXPECT_EQ(scene_text(read_authored(text), "a comment"), text);
  }
}

/// A scene file whose sequences and animated keys have values that depend on the frame.
constexpr const char* kAuthored = R"(# a comment
[camera]
vfov = 12
[background]
type = "image"
file = "sky.####.exr"
[material]
zinc = { type = "metal", albedo = [0.1, 0.30000000000000004, 1], fuzz = 1e-7 }
[material."a b"]
type = "lambertian"
albedo = { texture = "image", file = "earth.%04d.png" }
[[points]]
file = "a.####.ply"
material = "zinc"
[[key]]
target = "camera.vfov"
frames = [1, 2]
values = [30, 40.5]
)";

TEST(LoadWriteScene, AnAuthoredSceneKeepsWhatDependsOnTheFrame) {
  const scene::Scene authored = read_authored(kAuthored);
  EXPECT_EQ(authored.camera.vfov, 12);
  const std::string text = scene_text(authored, {});
  for (const char* kept : {"\"sky.####.exr\"", "\"earth.%04d.png\"", "\"a.####.ply\"", "vfov = 12", "[30, 40.5]"})
    EXPECT_NE(text.find(kept), std::string::npos) << kept << "\n" << text;
}

TEST(LoadWriteScene, OverridesAreApplied) {
  const scene::Scene written = read_authored(kAuthored, {"camera.vfov=30", "material.zinc.type=dielectric",
                                                         "material.copper={type=\"metal\",albedo=[1,0,0]}"});
  expect_same(written, read_authored(scene_text(written, {})));
  EXPECT_EQ(written.camera.vfov, 30);
  ASSERT_EQ(written.materials.size(), 3u);
  EXPECT_EQ(written.materials[0].name, "zinc") << "points files count materials in the order of the file";
  EXPECT_TRUE(std::holds_alternative<scene::Dielectric>(written.materials[0].model));
}

TEST(LoadWriteScene, DefaultsAreNotWritten) {
  EXPECT_EQ(scene_text({}, ""), "");
  scene::Scene s;
  s.render.samples = 7;
  s.materials = {{"glass", scene::Dielectric{}}};
  EXPECT_EQ(scene_text(s, "two\n\nlines"),
            "# two\n#\n# lines\n\n[render]\nsamples = 7\n\n[material]\nglass = { type = \"dielectric\" }\n");
}

TEST(LoadWriteScene, CommentsAcceptAnyFileName) {
  SceneFiles files;
  scene::Scene s;
  s.camera.vfov = 33;
  const std::string text = scene_text(s, "made of a\rb\x1b[31m.toml \x7f");
  EXPECT_EQ(text.find_first_of("\r\x1b\x7f"), std::string::npos) << "control characters are not valid in a comment";
  EXPECT_EQ(files.read(text).scene.camera.vfov, 33);
}

TEST(LoadWriteScene, AnUnwritableSceneIsAnInternalError) {
  const auto kind_of = [](const scene::Scene& s) {
    try {
      scene_text(s, "");
    } catch (const base::Error& error) {
      return error.kind();
    }
    return base::ErrorKind::kIo;
  };
  scene::Scene s;
  s.spheres.resize(1);
  EXPECT_EQ(kind_of(s), base::ErrorKind::kInternal);
  s = {};
  s.materials = {{"a", scene::Dielectric{}}, {"a", scene::Dielectric{}}};
  EXPECT_EQ(kind_of(s), base::ErrorKind::kInternal);
}

TEST(LoadWriteScene, MissingFolderIsCannotCreate) {
  const support::TempDir folder;
  try {
    write_scene({}, "", folder / "none" / "s.toml");
    FAIL() << "no error";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kCannotCreate);
  }
}

/// The error of check_unedited() for a file of these bytes; empty: none.
std::string refusal(const std::string& bytes) {
  const support::TempDir folder;
  support::write_bytes(folder / "a.toml", bytes);
  try {
    check_unedited(folder / "a.toml");
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kCannotCreate);
    return error.what();
  }
  return "";
}

TEST(LoadWriteScene, AMarkedTextIsAComment) {
  const std::string text = marked_text("[image]\n");
  EXPECT_TRUE(text.starts_with("# Written by orrery")) << text;
  EXPECT_TRUE(text.ends_with("\n[image]\n")) << text;
  EXPECT_EQ(text, marked_text("[image]\n"));
}

TEST(LoadWriteScene, UneditedAndMissingFilesMayBeReplaced) {
  EXPECT_EQ(refusal(marked_text("[image]\nwidth = 3\n")), "");
  EXPECT_EQ(refusal(marked_text("")), "");
  const support::TempDir folder;
  EXPECT_NO_THROW(check_unedited(folder / "none.toml"));
}

TEST(LoadWriteScene, EditedAndForeignFilesMayNot) {
  const std::string text = marked_text("[image]\nwidth = 3\n");
  for (const std::string& edited : {text + "\n", text.substr(0, text.size() - 1), text + "# note\n"})
    EXPECT_NE(refusal(edited).find("edited since orrery wrote it"), std::string::npos) << edited;
  std::string digit = text;
  digit[digit.find('\n') - 1] ^= 1;
  EXPECT_NE(refusal(digit).find("edited since orrery wrote it"), std::string::npos) << digit;
  for (const std::string& foreign : {std::string("[image]\nwidth = 3\n"), std::string(), "\n" + text})
    EXPECT_NE(refusal(foreign).find("not written by orrery"), std::string::npos) << foreign;
}

}  // namespace
}  // namespace orrery::load
