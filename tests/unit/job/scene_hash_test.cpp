// SPDX-License-Identifier: Apache-2.0
#include "job/scene_hash.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <set>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "generate/generate.h"
#include "scene/lat_long_map.h"
#include "scene/scene.h"

namespace orrery::job {
namespace {

scene::Scene small_scene() { return generate::make_final_scene({1, 2}); }

std::string hash_of(const scene::Scene& scene) { return scene_hash(compile::compile(scene)); }

TEST(JobSceneHash, IsSixteenDigitsAndReproducible) {
  const std::string hash = hash_of(small_scene());
  EXPECT_EQ(hash.size(), 16u);
  EXPECT_EQ(hash.find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_EQ(hash, hash_of(small_scene()));
}

TEST(JobSceneHash, ChangesWithEverythingThatChangesTheImage) {
  using Change = std::function<void(scene::Scene&)>;
  const std::vector<Change> changes = {
      [](scene::Scene&) {},
      [](scene::Scene& s) { s.image.width += 1; },
      [](scene::Scene& s) { s.image.height += 1; },
      [](scene::Scene& s) { s.camera.look_from.x += 1e-12; },
      [](scene::Scene& s) { s.camera.vfov += 1e-12; },
      [](scene::Scene& s) { s.camera.defocus_angle += 1e-12; },
      [](scene::Scene& s) { s.background.top.z = 0.999; },
      [](scene::Scene& s) {
        s.background.backdrop = {1, 1, 1};
      },
      [](scene::Scene& s) { s.render.samples += 1; },
      [](scene::Scene& s) { s.render.max_depth += 1; },
      [](scene::Scene& s) { s.render.seed += 1; },
      [](scene::Scene& s) { s.render.precision = scene::Precision::kFast; },
      [](scene::Scene& s) { s.render.shading = scene::Shading::kNormal; },
      [](scene::Scene& s) { s.spheres[0].center.y = 0.25; },
      [](scene::Scene& s) { s.spheres[s.spheres.size() - 3].radius *= -1; },  // inverts the glass
      [](scene::Scene& s) { s.spheres[1].radius *= 2; },
      [](scene::Scene& s) { std::swap(s.spheres[1], s.spheres[2]); },
      [](scene::Scene& s) { s.spheres.pop_back(); },
      [](scene::Scene& s) { s.spheres[1].material = s.spheres[0].material; },
      [](scene::Scene& s) { s.materials[s.spheres[0].material].model = scene::Hemisphere{}; },
      [](scene::Scene& s) { s.materials[s.spheres[0].material].model = scene::Metal{}; },
      [](scene::Scene& s) {
        s.materials[s.spheres[0].material].model = scene::Metal{{0.5, 0.5, 0.5}, 0.25};
      },
      [](scene::Scene& s) { s.materials[s.spheres[0].material].model = scene::Dielectric{}; },
      [](scene::Scene& s) {
        s.materials[s.spheres[0].material].model = scene::Dielectric{1.5, scene::Fresnel::kExact};
      },
  };
  std::set<std::string> hashes;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    scene::Scene scene = small_scene();
    changes[i](scene);
    EXPECT_TRUE(hashes.insert(hash_of(scene)).second) << "change " << i << " is not seen";
  }
}

TEST(JobSceneHash, ChangesWithRods) {
  const auto with_rod = [] {
    scene::Scene s = small_scene();
    s.rods.resize(1);
    s.rods[0].to = {1, 0, 0};
    return s;
  };
  using Change = std::function<void(scene::Scene&)>;
  const std::vector<Change> changes = {
      [](scene::Scene&) {},
      [](scene::Scene& s) { s.rods.clear(); },
      [](scene::Scene& s) { s.rods.push_back(s.rods[0]); },
      [](scene::Scene& s) { s.rods[0].from.y = 1e-12; },
      [](scene::Scene& s) { s.rods[0].to.z = 1e-12; },
      [](scene::Scene& s) { s.rods[0].radius = 2; },
      [](scene::Scene& s) {
        s.rods[0].materials = {0, 1};
      },
      [](scene::Scene& s) {
        s.rods[0].materials = {1, 0};
      },
  };
  std::set<std::string> hashes;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    scene::Scene scene = with_rod();
    changes[i](scene);
    EXPECT_TRUE(hashes.insert(hash_of(scene)).second) << "change " << i << " is not seen";
  }
  scene::Scene reversed = with_rod();
  std::swap(reversed.rods[0].from, reversed.rods[0].to);
  EXPECT_EQ(hash_of(reversed), hash_of(with_rod())) << "the image is the same";
}

/// A scene with a lamp and an image background.
scene::Scene lit_scene(float texel = 1) {
  scene::Scene s = small_scene();
  s.materials[s.spheres[1].material].model = scene::Emitter{};
  auto image = std::make_shared<scene::LatLongMap>(3, 1);
  std::fill_n(image->row(0), 9, 1.0F);
  image->row(0)[8] = texel;
  s.background.type = scene::BackgroundType::kImage;
  s.background.image = image;
  return s;
}

TEST(JobSceneHash, ChangesWithLights) {
  using Change = std::function<void(scene::Scene&)>;
  const auto emitter = [](scene::Scene& s) -> scene::Emitter& {
    return std::get<scene::Emitter>(s.materials[s.spheres[1].material].model);
  };
  const std::vector<Change> changes = {
      [](scene::Scene&) {},
      [&](scene::Scene& s) { emitter(s).radiance.y += 1e-12; },
      [&](scene::Scene& s) { emitter(s).exposure = 1; },
      [&](scene::Scene& s) { emitter(s).light_group = "key"; },
      [](scene::Scene& s) { s.background = lit_scene(2).background; },
      [](scene::Scene& s) { s.background.rotation = 10; },
      [](scene::Scene& s) { s.background.exposure = 1; },
      [](scene::Scene& s) { s.background.visible = false; },
      [](scene::Scene& s) { s.background.light_group = "sky"; },
      [](scene::Scene& s) { s.background = {}; },
      [](scene::Scene& s) { s.render.direct_lighting = scene::DirectLighting::kBsdf; },
      [](scene::Scene& s) { s.render.direct_lighting = scene::DirectLighting::kLight; },
  };
  std::set<std::string> hashes;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    scene::Scene scene = lit_scene();
    changes[i](scene);
    EXPECT_TRUE(hashes.insert(hash_of(scene)).second) << "change " << i << " is not seen";
  }
}

TEST(JobSceneHash, CausticsMatterOnlyWithASharpBall) {
  const auto hash = [](const scene::MaterialModel& ball, bool caustics) {
    scene::Scene s;
    s.materials = {{"lamp", scene::Emitter{}}, {"ball", ball}};
    s.spheres = {{{0, 5, 0}, 1, 0, ""}, {{0, 0, 0}, 1, 1, ""}};
    s.render.caustics = caustics;
    return hash_of(s);
  };
  const scene::Metal mirror{{0.5, 0.5, 0.5}, 0}, brushed{{0.5, 0.5, 0.5}, 0.1};
  EXPECT_NE(hash(mirror, true), hash(mirror, false));
  EXPECT_EQ(hash(brushed, true), hash(brushed, false));
}

TEST(JobSceneHash, DirectLightingDoesNotMatterWithoutLights) {
  scene::Scene scene = small_scene();
  scene.render.direct_lighting = scene::DirectLighting::kBsdf;
  EXPECT_EQ(hash_of(scene), hash_of(small_scene()));
}

TEST(JobSceneHash, IgnoresWhatDoesNotChangeTheImage) {
  scene::Scene scene = small_scene();
  scene.render.accelerator = scene::Accelerator::kList;
  scene.spheres[0].name = "renamed";
  for (scene::Material& material : scene.materials) material.name += "_";
  EXPECT_EQ(hash_of(scene), hash_of(small_scene()));
}

TEST(JobSceneHash, ChangesOfSeveralSpheresDoNotCancel) {
  // Each change affects only the highest bits of a double.
  std::set<std::string> hashes;
  for (int i = 0; i < 512; ++i) {
    scene::Scene scene = small_scene();
    for (int bit = 0; bit < 9; ++bit)
      if ((i >> bit & 1) != 0) scene.spheres[static_cast<std::size_t>(bit)].center.x += 1024;
    hashes.insert(hash_of(scene));
  }
  EXPECT_EQ(hashes.size(), 512u);
}

}  // namespace
}  // namespace orrery::job
