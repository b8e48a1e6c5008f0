// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scene/lat_long_map.h"
#include "scene/scene.h"

namespace orrery::test {

struct NamedScene {
  std::string name;
  scene::Scene scene;
  std::optional<scene::Scene> closing = {};  ///< at shutter close, if something moves
};

/// A floor, a diffuse ball and a black sky; material 0 is the floor, 1 the ball.
inline scene::Scene dark_stage(int width_px, int height_px) {
  scene::Scene s;
  s.image = {width_px, height_px};
  s.camera.look_from = {0, 2, 6};
  s.camera.look_at = {0, 0.7, 0};
  s.camera.vfov = 40;
  s.background.type = scene::BackgroundType::kConstant;
  s.background.color = {0, 0, 0};
  s.materials = {{"floor", scene::Lambertian{{0.5, 0.5, 0.5}}}, {"ball", scene::Lambertian{{0.7, 0.3, 0.2}}}};
  s.spheres = {{{0, -1000, 0}, 1000, 0, "floor"}, {{0, 0.8, 0}, 0.8, 1, "ball"}};
  return s;
}

/// Adds an emitter with a separate material.
inline void add_lamp(scene::Scene& s, math::Vec3d center, double radius, math::Vec3d radiance,
                     const std::string& group = {}) {
  s.materials.push_back({"lamp" + std::to_string(s.materials.size()), scene::Emitter{radiance, 0, group}});
  s.spheres.push_back({center, radius, static_cast<std::uint32_t>(s.materials.size() - 1)});
}

/// Adds a rod that emits, with a separate material.
inline void add_rod_lamp(scene::Scene& s, math::Vec3d from, math::Vec3d to, double radius, math::Vec3d radiance) {
  s.materials.push_back({"lamp" + std::to_string(s.materials.size()), scene::Emitter{radiance}});
  const auto material = static_cast<std::uint32_t>(s.materials.size() - 1);
  s.rods.push_back({from, to, radius, {material, material}});
}

/// Adds a ball next to the diffuse one.
inline void add_ball(scene::Scene& s, math::Vec3d center, double radius, const scene::MaterialModel& model) {
  s.materials.push_back({"ball" + std::to_string(s.materials.size()), model});
  s.spheres.push_back({center, radius, static_cast<std::uint32_t>(s.materials.size() - 1)});
}

/// Adds emitters to any scene that has the extent of test::everything(): near, far, touching and in glass.
inline scene::Scene with_lamps(scene::Scene s) {
  s.background.type = scene::BackgroundType::kConstant;
  s.background.color = {0.01, 0.02, 0.03};
  add_lamp(s, {2, 3, 1}, 0.2, {20, 15, 10}, "key");
  add_lamp(s, {-2, 1.5, 1}, 0.1, {20, 15, 10});
  add_lamp(s, {1.2, 0.1, 1.4}, 0.1, {0.5, 1, 3});
  add_lamp(s, {30, 200, -60}, 50, {0.5, 1, 3});
  add_lamp(s, {0, 0.5, 1}, 0.2, {0.2, 0.2, 0.1});
  return s;
}

/// A latitude-longitude map: dim sky above, dark ground below, and a bright texel.
inline std::shared_ptr<scene::LatLongMap> bright_texel_map(float radiance) {
  auto map = std::make_shared<scene::LatLongMap>(32, 16);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 32; ++x)
      for (int c = 0; c < 3; ++c) map->row(y)[3 * x + c] = (y < 8 ? 0.2F : 0.05F) + 0.05F * static_cast<float>(c);
  for (int c = 0; c < 3; ++c) map->row(4)[3 * 11 + c] = radiance;
  return map;
}

/// The stage under lights that are each hard in another way.
inline std::vector<NamedScene> lit_scenes(int width_px, int height_px) {
  std::vector<NamedScene> out;
  const auto add = [&](const char* name) -> scene::Scene& {
    out.push_back({name, dark_stage(width_px, height_px)});
    return out.back().scene;
  };
  add_lamp(add("small lamp"), {1.5, 2.5, 1}, 0.25, {60, 50, 40});
  add_lamp(add("huge lamp"), {4, 9, -3}, 6, {1, 0.8, 0.6});
  scene::Scene& many = add("many lamps");
  for (int i = 0; i < 80; ++i)  // more than a list holds
    add_lamp(many, {-3 + 0.75 * (i % 8), 0.5 + 0.25 * (i / 8), -1.5 + 0.4 * (i % 5)}, 0.05 + 0.01 * (i % 7),
             {5.0 + i % 3, 5.0 + i % 5, 5.0 + i % 7});
  scene::Scene& glass = add("glass in front of a lamp");
  add_lamp(glass, {1.2, 2.2, 1}, 0.4, {20, 20, 20});
  add_ball(glass, {0.9, 1.8, 1}, 0.35, scene::Dielectric{1.5, scene::Fresnel::kExact});
  scene::Scene& metal = add("fuzzy metal");
  add_lamp(metal, {1.5, 2.5, 1}, 0.5, {15, 15, 15});
  add_ball(metal, {1.6, 0.6, 0.5}, 0.6, scene::Metal{{0.9, 0.7, 0.5}, 0.3});
  add_ball(metal, {-1.6, 0.6, 0.5}, 0.6, scene::Metal{{0.8, 0.8, 0.8}, 1});
  scene::Scene& plastic = add("plastic, smooth and rough");
  plastic.materials[0].model = scene::Plastic{{0.5, 0.5, 0.5}, 1.5, 0.2};
  plastic.materials[1].model = scene::Plastic{{0.7, 0.3, 0.2}, 1.5, 0};
  add_lamp(plastic, {1.5, 2.5, 1}, 0.5, {15, 15, 15});
  add_ball(plastic, {1.6, 0.6, 0.5}, 0.6, scene::Plastic{{0.2, 0.3, 0.7}, 2.5, 0.3});
  add_ball(plastic, {-1.6, 0.6, 0.5}, 0.6, scene::Plastic{{0.1, 0.1, 0.1}, 1.5, 1});
  scene::Scene& inside = add("camera inside an emitter");
  add_lamp(inside, {0, 2, 6}, 8, {0.5, 0.4, 0.3});
  add_lamp(inside, {1.5, 2.5, 1}, 0.4, {10, 10, 10});
  scene::Scene& hemisphere = add("hemisphere material beside a lamp that touches the floor");
  hemisphere.materials[1].model = scene::Hemisphere{{0.6, 0.6, 0.6}};
  add_lamp(hemisphere, {1.5, 0.4, 1}, 0.4, {8, 8, 8});
  scene::Scene& moving = add("moving lamps");
  add_lamp(moving, {-2, 2, 1}, 0.5, {15, 12, 10});
  add_lamp(moving, {1, 1.5, 1}, 0.3, {5, 10, 15});
  out.back().closing = moving;
  out.back().closing->spheres[2].center = {2, 2.5, 1.5};
  out.back().closing->spheres[3].center.y = 3;
  out.back().closing->spheres[3].radius = 0.5;
  scene::Scene& rods = add("rods");
  add_rod_lamp(rods, {-2, 2, 0.5}, {1.5, 2.6, 1}, 0.05, {20, 15, 10});
  add_rod_lamp(rods, {1.2, 0.3, 1.2}, {1.2, 0.3, 1.2}, 0.15, {5, 10, 15});  // without length
  add_rod_lamp(rods, {-1.5, 0.05, 1}, {-1.2, 1.5, 1.2}, 0.05, {5, 10, 5});  // touches the floor
  rods.rods.back().materials[1] = 1;                                        // one half is dark
  add_rod_lamp(rods, {0.5, 0.4, 1.5}, {0.5, 40, 1.5}, 0.02, {20, 20, 20});
  add_rod_lamp(rods, {-0.4, 1.4, 1}, {0.2, 1.4, 1}, 0.3, {5, 10, 15});  // its caps are as large as its body
  scene::Scene& moving_rods = add("moving rods and a lamp");
  add_rod_lamp(moving_rods, {-2, 2, 0.5}, {1.5, 2.6, 1}, 0.05, {20, 15, 10});
  add_lamp(moving_rods, {1, 1.5, 1}, 0.3, {5, 10, 15});
  out.back().closing = moving_rods;
  out.back().closing->rods[0].to = {1, 1.5, 2};
  out.back().closing->rods[0].radius = 0.1;
  scene::Scene& image = add("image sky with a bright texel");
  image.background.type = scene::BackgroundType::kImage;
  image.background.image = bright_texel_map(60);
  add_ball(image, {1.6, 0.6, 0.5}, 0.6, scene::Metal{{0.9, 0.7, 0.5}, 0.3});
  scene::Scene& sun = add("image sky with the sun, and a lamp");
  const auto map = bright_texel_map(1);
  map->sun.direction = math::normalized(math::Vec3d{1, 2, 2});
  map->sun.one_minus_cos = 0.0024;  // 8 degrees across
  map->sun.radiance = {150, 140, 120};
  sun.background.type = scene::BackgroundType::kImage;
  sun.background.image = map;
  sun.background.rotation = 30;
  add_lamp(sun, {-1.5, 1.5, 1}, 0.2, {40, 20, 10});
  return out;
}

}  // namespace orrery::test
