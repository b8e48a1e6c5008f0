// SPDX-License-Identifier: Apache-2.0
#include "noise_scenes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <random>
#include <stdexcept>

#include "load/load_scene.h"
#include "scene/lat_long_map.h"
#include "scene/texture.h"
#include "support/lit_scenes.h"
#include "support/room.h"

namespace orrery::bench {
namespace {

using math::Vec3d;

/// Uniform random numbers in 0..1, the same with every library.
class Numbers {
 public:
  explicit Numbers(unsigned seed) : engine_(seed) {}
  double operator()() { return static_cast<double>(engine_()) * 0x1p-32; }
  double operator()(double low, double high) { return low + (high - low) * (*this)(); }

 private:
  std::mt19937 engine_;
};

scene::Scene stage() { return test::dark_stage(64, 36); }

/// A dim room with a mirror ball between camera and wall. The ball reflects the gaps behind the camera as small bright
/// spots, each in one pixel of some hundreds.
NoiseScene room_with_mirror() {
  scene::Scene s = test::room(3.7, 5, 64, 36);
  s.materials.push_back({"mirror", scene::Metal{{0.9, 0.9, 0.9}, 0}});
  s.spheres.push_back({{0.15, 0.1, -0.7}, 0.3, 1, ""});
  return {s};
}

/// Lamps of equal power far behind the focus plane of a wide lens, above a lit floor.
NoiseScene bokeh(int count, double radius) {
  scene::Scene s = stage();
  s.background.color = {0.02, 0.02, 0.03};
  s.camera.defocus_angle = 4;
  s.camera.focus_distance = 6;
  test::add_lamp(s, {2, 5, 3}, 0.5, {8, 8, 8});
  Numbers number(5);
  for (int i = 0; i < count; ++i) {
    const double x = count == 1 ? 2 : number(-18, 18), y = count == 1 ? 4 : number(1, 9);
    const double light = 40 / (radius * radius);
    test::add_lamp(s, {x, y, -30}, radius, {light, 0.8 * light, 0.5 * light});
  }
  return {s};
}

/// Small lamps that move while the shutter is open.
NoiseScene moving_lamps() {
  scene::Scene s = stage();
  s.background.color = {0.05, 0.05, 0.06};
  Numbers number(7);
  for (int i = 0; i < 8; ++i) test::add_lamp(s, {number(-4, 4), number(0.5, 3), -4}, 0.03, {400, 300, 200});
  scene::Scene closing = s;
  for (std::size_t i = 2; i < closing.spheres.size(); ++i) {
    closing.spheres[i].center.x += number(-2, 2);
    closing.spheres[i].center.y += number(-0.5, 0.5);
  }
  return {s, closing};
}

/// Distant lamps, each a small fraction of a pixel, before a dim sky.
NoiseScene stars() {
  scene::Scene s;
  s.camera.vfov = 50;
  s.background.type = scene::BackgroundType::kConstant;
  s.background.color = {0.02, 0.03, 0.05};
  Numbers number(3);
  for (int i = 0; i < 60; ++i)
    test::add_lamp(s, {number(-90, 90), number(-50, 50), -100}, number(0.05, 0.3), {300, 300, 250});
  return {s};
}

/// Glass balls inside each other above a lamp.
NoiseScene glass_stack() {
  scene::Scene s = stage();
  s.background.color = {0.02, 0.02, 0.02};
  s.spheres.pop_back();
  test::add_lamp(s, {0, 0.4, -0.5}, 0.05, {200, 200, 200});
  test::add_ball(s, {0, 1.2, 0}, 1, scene::Dielectric{1.5, scene::Fresnel::kExact});
  test::add_ball(s, {0, 1.2, 0}, 0.8, scene::Dielectric{1 / 1.5, scene::Fresnel::kExact});
  test::add_ball(s, {0, 1.2, 0}, 0.5, scene::Dielectric{1.5, scene::Fresnel::kExact});
  return {s};
}

/// A dark floor that only glass lights: all fireflies are equally bright, since the lamp has one radiance.
NoiseScene equal_fireflies() {
  scene::Scene s = stage();
  s.render.direct_lighting = scene::DirectLighting::kBsdf;
  test::add_lamp(s, {-3, 4, -2}, 0.15, {500, 500, 500});
  test::add_ball(s, {1.6, 0.6, 0.5}, 0.6, scene::Dielectric{1.5});
  return {s};
}

/// Few bright texels in an environment that the camera sees.
NoiseScene bright_texels(int width, float light) {
  scene::Scene s = stage();
  s.background.type = scene::BackgroundType::kImage;
  const auto map = std::make_shared<scene::LatLongMap>(width, width / 2);
  Numbers number(11);
  for (int y = 0; y < map->height(); ++y)
    std::fill_n(map->row(y), 3 * map->width(), y < map->height() / 2 ? 0.3f : 0.1f);
  for (int i = 0; i < 12; ++i) {
    // Around the left and right edges, -z, at which the camera looks.
    const auto x = static_cast<int>(number(0.9, 1.1) * width) % width,
               y = static_cast<int>(number(0.40, 0.5) * width / 2);
    for (int c = 0; c < 3; ++c) map->row(y)[3 * x + c] = light;
  }
  s.background.image = map;
  return {s};
}

/// A lit stage, in one corner of which a lamp behind glass adds rare light.
NoiseScene rare_patch() {
  scene::Scene s = stage();
  s.background.color = {0.6, 0.7, 0.8};
  test::add_lamp(s, {2.2, 0.5, 0.6}, 0.02, {30000, 30000, 20000});
  test::add_ball(s, {2.2, 0.5, 0.6}, 0.2, scene::Dielectric{1.5});
  return {s};
}

/// A bulb: a lamp in hollow glass.
NoiseScene bulb() {
  scene::Scene s = stage();
  test::add_lamp(s, {1.5, 1.6, 1}, 0.1, {60, 50, 40});
  test::add_ball(s, {1.5, 1.6, 1}, 0.3, scene::Dielectric{1.5});
  test::add_ball(s, {1.5, 1.6, 1}, -0.28, scene::Dielectric{1.5});
  return {s};
}

/// Small glass balls on a floor below one lamp.
NoiseScene beads() {
  scene::Scene s = stage();
  s.background.color = {0.05, 0.05, 0.05};
  test::add_lamp(s, {-3, 6, 2}, 0.6, {40, 40, 40});
  s.materials.push_back({"bead", scene::Dielectric{1.5}});
  const auto bead = static_cast<std::uint32_t>(s.materials.size() - 1);
  Numbers number(13);
  for (int i = 0; i < 40; ++i) {
    const double r = number(0.08, 0.2);
    s.spheres.push_back({{number(-3, 3), r, number(-1, 3)}, r, bead, ""});
  }
  return {s};
}

// Made after the rule.

/// Small bright balls close to a wide lens, before a dim stage.
NoiseScene foreground_blur() {
  scene::Scene s = stage();
  s.background.color = {0.1, 0.1, 0.12};
  s.camera.defocus_angle = 3;
  s.camera.focus_distance = 6;
  Numbers number(21);
  for (int i = 0; i < 6; ++i)
    test::add_lamp(s, {number(-0.5, 0.5), 1.7 + number(-0.2, 0.3), 4.5}, 0.004, {900, 700, 900});
  return {s};
}

/// A lamp in a sphere of soot with a narrow opening, between soot and stage.
NoiseScene lamp_behind_a_gap() {
  scene::Scene s = stage();
  test::add_ball(s, {0, 3.2, 0}, 0.9, scene::Lambertian{{0.02, 0.02, 0.02}});
  test::add_ball(s, {1.8, 3.2, 0}, 0.88, scene::Lambertian{{0.02, 0.02, 0.02}});
  test::add_lamp(s, {0.9, 4.4, 0}, 0.1, {3000, 3000, 3000});
  s.render.direct_lighting = scene::DirectLighting::kBsdf;
  return {s};
}

/// An environment with a sun of two texels, visible and reflected.
NoiseScene sun_of_two_texels() {
  scene::Scene s = stage();
  s.background.type = scene::BackgroundType::kImage;
  const auto map = std::make_shared<scene::LatLongMap>(2048, 1024);
  for (int y = 0; y < map->height(); ++y) std::fill_n(map->row(y), 3 * map->width(), 0.2f);
  for (int c = 0; c < 3; ++c) map->row(480)[3 * 40 + c] = map->row(480)[3 * 41 + c] = 40000;
  s.background.image = map;
  test::add_ball(s, {1.6, 0.6, 0.6}, 0.6, scene::Metal{{0.9, 0.9, 0.9}, 0});
  return {s};
}

/// A fast lamp and a shaking camera.
NoiseScene lamp_streak() {
  scene::Scene s = stage();
  test::add_lamp(s, {-3, 1, -1}, 0.02, {8000, 6000, 3000});
  test::add_lamp(s, {3, 5, 3}, 0.4, {10, 10, 10});
  scene::Scene closing = s;
  closing.spheres[2].center = {3, 2.5, -1};
  closing.camera.look_at.x += 0.15;
  return {s, closing};
}

/// Lamps of which a ball in front hides all but a thin crescent.
NoiseScene crescents() {
  scene::Scene s = stage();
  s.background.color = {0.05, 0.05, 0.08};
  s.spheres.pop_back();
  for (int i = 0; i < 5; ++i) {
    const double x = i - 2.0, y = 0.6 + 0.3 * i;
    test::add_ball(s, {x, y, 0}, 0.25, scene::Lambertian{{0.1, 0.1, 0.1}});
    test::add_lamp(s, {x * 1.5 + 0.012, y - (2 - y) * 0.5 + 0.01, -3}, 0.378, {400, 400, 300});
  }
  return {s};
}

/// A lamp behind a ball of which only fine cells of its texture emit.
NoiseScene emitting_texture() {
  scene::Scene s = stage();
  auto texture = std::make_shared<scene::Texture>();
  texture->type = scene::TextureType::kMarble;
  texture->scale = 6;
  texture->low = {0, 0, 0};
  texture->high = {60, 20, 5};
  scene::Emitter lamp;
  lamp.radiance_texture = texture;
  test::add_ball(s, {-1.8, 0.7, 0.5}, 0.7, lamp);
  auto checker = std::make_shared<scene::Texture>();
  checker->scale = 0.05;
  checker->high = {0.9, 0.9, 0.9};
  scene::Lambertian checked;
  checked.albedo_texture = checker;
  test::add_ball(s, {1.8, 0.6, 0.5}, 0.6, checked);
  return {s};
}

/// Glass balls in a row between a lamp and the camera.
NoiseScene glass_row() {
  scene::Scene s = stage();
  s.background.color = {0.1, 0.1, 0.1};
  for (int i = 0; i < 5; ++i) test::add_ball(s, {0.3 * i - 0.6, 0.5, 2.0 - i}, 0.45, scene::Dielectric{1.5});
  test::add_lamp(s, {0.5, 0.9, -5}, 0.2, {150, 150, 150});
  return {s};
}

/// A lit stage with one small, very bright reflection.
NoiseScene one_bright_pixel() {
  scene::Scene s = stage();
  s.background.color = {0.7, 0.8, 0.9};
  test::add_ball(s, {1.5, 0.4, 1}, 0.4, scene::Metal{{0.9, 0.9, 0.9}, 0});
  test::add_lamp(s, {6, 8, 9}, 0.04, {60000, 60000, 60000});
  return {s};
}

/// Red, green and blue lamps that light the floor through glass.
NoiseScene colored_caustics() {
  scene::Scene s = stage();
  s.background.color = {0.02, 0.02, 0.02};
  const Vec3d colors[3] = {{90, 0, 0}, {0, 90, 0}, {0, 0, 90}};
  for (int i = 0; i < 3; ++i) {
    test::add_ball(s, {2.0 * i - 2, 0.5, 1.5}, 0.4, scene::Dielectric{1.5});
    test::add_lamp(s, {2.0 * i - 3, 4, -1}, 0.25, colors[i]);
  }
  return {s};
}

/// Mirrors and a small lamp between them.
NoiseScene mirrors() {
  scene::Scene s = stage();
  Numbers number(31);
  for (int i = 0; i < 7; ++i)
    test::add_ball(s, {i - 3.0, number(0.4, 1.5), number(-1, 1.5)}, 0.45, scene::Metal{{0.95, 0.9, 0.9}, i % 2 * 0.05});
  test::add_lamp(s, {0.2, 2.2, 1.5}, 0.06, {250, 250, 250});
  return {s};
}

/// Scenes whose noise is hard to estimate: rare, small, blurred or moving light.
std::vector<NoiseCase> hard_scenes() {
  const auto room = [](const char* name, double radius, double sky) {
    return NoiseCase{name, [=] { return NoiseScene{test::room(radius, sky, 64, 36)}; }};
  };
  return {{"mirror", room_with_mirror},
          room("room 3.7, sky 5", 3.7, 5),
          room("room 3.8, sky 50", 3.8, 50),
          room("room 3.88, sky 500", 3.88, 500),
          room("room 3.9, sky 500", 3.9, 500),
          room("room 3.95, sky 50", 3.95, 50),
          {"bokeh 0.5", [] { return bokeh(15, 0.5); }},
          {"bokeh 0.2", [] { return bokeh(15, 0.2); }},
          {"one blurred lamp", [] { return bokeh(1, 0.1); }},
          {"moving lamps", moving_lamps},
          {"stars", stars},
          {"glass stack", glass_stack},
          {"equal fireflies", equal_fireflies},
          {"bright texels", [] { return bright_texels(1024, 2000); }},
          {"fine texels", [] { return bright_texels(4096, 20000); }},
          {"rare patch", rare_patch},
          {"bulb", bulb},
          {"beads", beads}};
}

/// Scenes that were made after the rule, to test it.
std::vector<NoiseCase> held_out_scenes() {
  return {{"foreground blur", foreground_blur},
          {"lamp behind a gap", lamp_behind_a_gap},
          {"sun of two texels", sun_of_two_texels},
          {"lamp streak", lamp_streak},
          {"crescents", crescents},
          {"emitting texture", emitting_texture},
          {"glass row", glass_row},
          {"one bright pixel", one_bright_pixel},
          {"coloured caustics", colored_caustics},
          {"mirrors", mirrors}};
}

}  // namespace

std::vector<NoiseCase> scenes_of(const std::string& set) {
  const std::filesystem::path folder = ORRERY_SCENES;
  const auto files = [&](const std::vector<std::filesystem::path>& names) {
    std::vector<NoiseCase> out;
    for (const auto& name : names) {
      out.push_back({name.stem().string(), [path = folder / name] {
                       load::SceneRequest request;
                       request.source.file = path;
                       return NoiseScene{load::read_with_data(request).scene};
                     }});
    }
    return out;
  };
  if (set == "ordinary")
    return files({"trade/contrast.toml", "book/final.toml", "trade/glass.toml", "trade/defocus.toml"});
  if (set == "hard") return hard_scenes();
  if (set == "held-out") return held_out_scenes();
  if (set != "committed") throw std::runtime_error("unknown set: " + set);
  std::vector<std::filesystem::path> names;
  for (const char* kind : {"book", "extremes", "light", "molecules", "next-week", "trade"})
    for (const auto& entry : std::filesystem::directory_iterator(folder / kind))
      if (entry.path().extension() == ".toml") names.push_back(std::filesystem::path(kind) / entry.path().filename());
  std::sort(names.begin(), names.end());
  return files(names);
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> out(1);
  for (const char c : text) {
    if (c == ',') {
      out.emplace_back();
    } else {
      out.back() += c;
    }
  }
  return out;
}

void NoiseScore::add(std::vector<double> ratios, int not_reached_runs) {
  std::sort(ratios.begin(), ratios.end());
  const auto count_above = [&](double limit) {
    return static_cast<int>(std::count_if(ratios.begin(), ratios.end(), [&](double r) { return r > limit; }));
  };
  runs += static_cast<int>(ratios.size());
  above += count_above(1.1);
  far_above += count_above(1.3);
  not_reached += not_reached_runs;
  std::printf("%.2f %.2f  %3d %3d  of %3zu, %d not reached", ratios[ratios.size() / 2], ratios.back(), count_above(1.1),
              count_above(1.3), ratios.size(), not_reached_runs);
}

int NoiseScore::report() const {
  std::printf("%d runs: %d above 1.1, %d above 1.3 times the target; %d not reached\n", runs, above, far_above,
              not_reached);
  return above * 50 <= runs && far_above == 0 ? 0 : 1;
}

}  // namespace orrery::bench
