// SPDX-License-Identifier: Apache-2.0
#include "compile/compile.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>

#include "base/parallel.h"
#include "base/stop_point.h"
#include "compile/camera_basis.h"
#include "compile/caustic_list.h"
#include "compile/coincident.h"
#include "compile/compiled_scene.h"
#include "compile/environment.h"
#include "compile/light_tree.h"
#include "compile/material_table.h"
#include "compile/pixel_filter.h"
#include "kernel/sobol_columns.h"
#include "math/scalar.h"
#include "scene/layers.h"
#include "sky/daylight.h"

namespace orrery::compile {
namespace {

using math::set;
using math::Vec3d;

// Enumerations of scene and kernel have the same order.
static_assert(static_cast<int>(scene::Precision::kBook) == static_cast<int>(Precision::kBook));
static_assert(static_cast<int>(scene::Shading::kFlat) == static_cast<int>(kernel::Shading::kFlat));
static_assert(static_cast<int>(scene::Sampler::kBlueNoise) == static_cast<int>(kernel::SamplerKind::kBlueNoise));
static_assert(static_cast<int>(scene::DirectLighting::kLight) == static_cast<int>(kernel::DirectLighting::kLight));

kernel::Sphere sphere_of(Vec3d center, double radius) { return {center.x, center.y, center.z, std::abs(radius)}; }

/// Whether the ends of a rod are exchanged: they are put in order, since the order changes roundings.
bool is_reversed(Vec3d from, Vec3d to) { return std::tie(to.x, to.y, to.z) < std::tie(from.x, from.y, from.z); }

/// Calls f(points, sphere) for each half of the rods of bonds, in the order of their ids, with the sphere of the scene
/// that it belongs to: for both halves of the shaft of an arrow, one of its head. The rods are compiled.
template <class F>
void each_bond_half(const scene::Scene& scene, const CompiledScene& compiled, F f) {
  std::size_t first = scene.spheres.size();
  for (const scene::Points& points : scene.points) {
    for (const scene::BondStub& stub : points.bond_stubs)
      for (int half = 0; half < 2; ++half) f(points, first + stub.sphere);
    first += points.centers.size();
  }
  const base::StopPoint stop;
  std::size_t bond = 0;
  for (const scene::Points& points : scene.points) {
    const std::size_t end = bond + points.bond_pairs.size(), first_shaft = end - points.arrow_count;
    for (; bond < end; ++bond) {
      stop.check(bond);
      f(points, bond < first_shaft ? compiled.bonds[bond].a : compiled.bonds[bond].b);
      f(points, compiled.bonds[bond].b);
    }
  }
}

/// Calls f(from, to, radius, materials) for each rod of a table, then for those of files.
template <class F>
void each_rod(const scene::Scene& scene, F f) {
  for (const scene::Rod& rod : scene.rods) f(rod.from, rod.to, rod.radius, rod.materials);
  const base::StopPoint stop;
  for (const scene::RodFile& file : scene.rod_files)
    for (std::size_t i = 0; i < file.from.size(); ++i) {
      stop.check(i);
      f(file.from[i], file.to[i], file.radii[i], file.materials);
    }
}

/// Calls f(material) for the halves of these rods, in the order of their ids.
template <class F>
void each_rod_half(const scene::Scene& scene, F f) {
  each_rod(scene, [&](Vec3d from, Vec3d to, double, std::array<std::uint32_t, 2> halves) {
    if (is_reversed(from, to)) std::swap(halves[0], halves[1]);
    for (const std::uint32_t material : halves) f(material);
  });
}

/// Sets the rods.
void set_rods(const scene::Scene& scene, CompiledScene& compiled) {
  compiled.rods.clear();
  std::size_t bonds = 0;
  for (const scene::Points& points : scene.points) bonds += points.bond_pairs.size();
  compiled.bonds.reserve(bonds);
  compiled.rods.reserve(scene.rod_count() - bonds);
  compiled.rod_file_sizes.clear();
  for (const scene::RodFile& file : scene.rod_files) compiled.rod_file_sizes.push_back(file.from.size());
  const auto add = [&](Vec3d from, Vec3d to, double radius) {
    const bool reversed = is_reversed(from, to);
    kernel::Rod out;
    set(out.a, reversed ? to : from);
    set(out.b, reversed ? from : to);
    out.radius = radius;
    compiled.rods.push_back(out);
  };
  each_rod(scene, [&](Vec3d from, Vec3d to, double radius, const auto&) { add(from, to, radius); });
  compiled.stub_counts.clear();
  compiled.bond_counts.clear();
  compiled.bonds.clear();
  compiled.bond_radii.clear();
  const base::StopPoint stop;
  auto first = static_cast<std::uint32_t>(scene.spheres.size());  // sphere of the points table
  for (const scene::Points& points : scene.points) {
    for (const scene::BondStub& stub : points.bond_stubs)
      add(points.centers[stub.sphere], stub.end, points.bond_radius_of(stub.sphere));
    const auto radius = static_cast<std::uint32_t>(compiled.bond_radii.size());
    for (std::size_t i = 0; i < points.bond_pairs.size(); ++i) {
      stop.check(i);
      auto [a, b] = points.bond_pairs[i];
      if (is_reversed(points.centers[a], points.centers[b])) std::swap(a, b);
      const bool is_trace = !points.are_traces.empty() && points.are_traces[a] != 0;
      compiled.bonds.push_back({first + a, first + b, radius + (is_trace ? 1 : 0)});
    }
    compiled.stub_counts.push_back(points.bond_stubs.size());
    compiled.bond_counts.push_back(points.bond_pairs.size());
    compiled.bond_radii.insert(compiled.bond_radii.end(), {points.bond_radius, points.trace_radius});
    first += static_cast<std::uint32_t>(points.centers.size());
  }
}

/// Sets the spheres.
void set_spheres(const scene::Scene& scene, const SphereStore::OnCopied& on_copied, CompiledScene& compiled) {
  compiled.spheres = {};
  for (const scene::Sphere& s : scene.spheres) compiled.spheres.push_back(sphere_of(s.center, s.radius));
  compiled.spheres.append(scene.points, on_copied);
  compiled.points_sizes.clear();
  for (const scene::Points& points : scene.points) compiled.points_sizes.push_back(points.centers.size());
  compiled.distinct_in.reset();
  compiled.compared_in.reset();
  if (scene.distinct_in) compiled.distinct_in = static_cast<Precision>(*scene.distinct_in);
}

/// Numbers the materials of the spheres and of the halves of rods.
void set_object_materials(const scene::Scene& scene, CompiledScene& compiled) {
  const base::StopPoint stop;
  compiled.object_materials = {};
  compiled.object_materials.reserve(scene.sphere_count() + 2 * scene.rod_count());
  compiled.material_sources.clear();
  MaterialTable table(scene, compiled.material_sources);
  for (const scene::Sphere& s : scene.spheres)
    compiled.object_materials.push_back(table.index(s.material, s.radius < 0));
  for (std::size_t p = 0; p < scene.points.size(); ++p) {
    const scene::Points& points = scene.points[p];
    for (std::size_t i = 0; i < points.centers.size(); ++i) {
      stop.check(i);
      const std::uint32_t material = points.materials.empty() ? points.material : points.materials[i];
      const bool inside_out = points.radii[i] < 0;
      compiled.object_materials.push_back(points.colors.empty()
                                              ? table.index(material, inside_out)
                                              : table.colored_index(material, inside_out, p, points.colors[i]));
    }
  }
  each_rod_half(scene,
                [&](std::uint32_t material) { compiled.object_materials.push_back(table.index(material, false)); });
  each_bond_half(scene, compiled, [&](const scene::Points& points, std::size_t sphere) {
    const std::optional<std::uint32_t> material = points.bonds.material;
    compiled.object_materials.push_back(material ? table.index(*material, false) : compiled.object_materials[sphere]);
  });
}

/// Sets the opacities of the spheres and of the halves of rods, unless all are 1.
void set_opacity(const scene::Scene& scene, CompiledScene& compiled) {
  const base::StopPoint stop;
  const std::size_t count = scene.sphere_count() + 2 * scene.rod_count();
  std::vector<float>().swap(compiled.opacity);
  compiled.features.opacity = false;
  const auto is_opaque = [](const auto& of) { return opacity_of(of.model) == 1; };
  const auto has_none = [](const scene::Points& points) { return !points.opacity.is_set(); };
  if (std::all_of(scene.materials.begin(), scene.materials.end(), is_opaque) &&
      std::all_of(scene.points.begin(), scene.points.end(), has_none))
    return;
  std::size_t next = 0;
  const auto add = [&](double opacity) {
    stop.check(next);
    if (opacity < 1 && compiled.opacity.empty()) compiled.opacity.assign(count, 1.0F);
    if (!compiled.opacity.empty()) compiled.opacity[next] = static_cast<float>(opacity);
    ++next;
  };
  std::vector<double> of_materials;
  for (const scene::Material& material : scene.materials) of_materials.push_back(opacity_of(material.model));
  for (const scene::Sphere& s : scene.spheres) add(of_materials[s.material]);
  for (const scene::Points& points : scene.points)
    for (std::size_t i = 0; i < points.centers.size(); ++i) {
      const bool is_head = i >= points.particle_count();  // of an arrow
      const double own = !points.opacities.empty() ? double{points.opacities[i]}
                         : is_head                 ? -1
                                                   : points.opacity.value.value_or(-1);
      add(own >= 0 ? own : of_materials[points.materials.empty() ? points.material : points.materials[i]]);
    }
  each_rod_half(scene, [&](std::uint32_t material) { add(of_materials[material]); });
  each_bond_half(scene, compiled, [&](const scene::Points& points, std::size_t sphere) {
    const std::optional<std::uint32_t> material = points.bonds.material;
    add(material ? of_materials[*material] : compiled.opacity.empty() ? 1 : double{compiled.opacity[sphere]});
  });
  compiled.features.opacity = !compiled.opacity.empty();
}

/// Sets the camera, and its motion from shutter open to shutter close.
void set_camera(const scene::Scene& opening, const scene::Scene* closing, CompiledScene& compiled) {
  kernel::Features& features = compiled.features;
  features.lens = opening.camera.defocus_angle > 0 || (closing != nullptr && closing->camera.defocus_angle > 0);
  const double scale = features.lens ? 1 : view_scale(opening.camera);
  compiled.camera = compile_camera(opening.camera, opening.image, scale);
  compiled.camera_motion = {};
  features.motion = !compiled.motion.empty() || !compiled.rod_motion.empty();
  if (closing == nullptr) return;
  const kernel::Camera last = compile_camera(closing->camera, closing->image, scale);
  for (const auto vector : kernel::kCameraVectors) {
    const Vec3d change = last.*vector - compiled.camera.*vector;
    compiled.camera_motion.*vector = change;
    features.motion = features.motion || change != Vec3d{0, 0, 0};
  }
}

/// Nearest and farthest point of the spheres of points tables and of all rods along the view axis, as distances from
/// the camera; empty if there are none.
std::optional<scene::Interval> depth_range(const scene::Scene& scene, const CompiledScene& compiled) {
  const Vec3d origin = scene.camera.look_from, forward = math::normalized(scene.camera.look_at - origin);
  const kernel::SceneView view = compiled.view();
  const std::size_t first = scene.spheres.size(), spheres = view.sphere_count - first;
  constexpr scene::Interval kEmpty{math::kInfinity, -math::kInfinity};
  const auto join = [](scene::Interval& range, const scene::Interval& other) {
    range = {std::min(range.low, other.low), std::max(range.high, other.high)};
  };
  const auto add = [&](scene::Interval& range, const Vec3d& at, double radius) {
    const double z = math::dot(at - origin, forward);
    join(range, {z - radius, z + radius});
  };
  const scene::Interval range = base::accumulate_parallel(
      spheres + view.rods.count, kEmpty,
      [&](scene::Interval& so_far, std::size_t i) {
        if (i < spheres) {
          const kernel::Sphere s = view.spheres[first + i];
          return add(so_far, {s.x, s.y, s.z}, s.radius);
        }
        const kernel::Rod rod = view.rods[i - spheres];
        add(so_far, math::vector_of(rod.a), rod.radius);
        add(so_far, math::vector_of(rod.b), rod.radius);
      },
      join);
  if (!(range.low <= range.high)) return {};
  return range;
}

kernel::DepthCue cue_of(const scene::Camera& camera, double strength, const scene::Interval& range) {
  const double slope = strength / (range.high - range.low);
  return {strength, slope * range.low, math::normalized(camera.look_at - camera.look_from) * slope};
}

/// Sets the depth cue, and that of the page. Unless the scene sets it, the cue begins behind the camera and a tenth of
/// what is shown, whose colours are exact. The page ends behind all of it.
void set_depth_cue(const scene::Scene& scene, CompiledScene& compiled) {
  constexpr double kExactPart = 0.1, kPageBegin = 1, kPageEnd = 3;
  const scene::Camera& camera = scene.camera;
  const auto page = std::find_if(scene.spheres.begin(), scene.spheres.end(), [](const auto& s) { return s.is_page; });
  const bool has_page = page != scene.spheres.end();
  compiled.page = has_page ? static_cast<std::uint32_t>(page - scene.spheres.begin()) : kernel::kNone;
  compiled.depth_cue = compiled.page_fade = {};
  std::optional<scene::Interval> range;
  if (has_page || (camera.depth_cue > 0 && !camera.depth_cue_range)) range = depth_range(scene, compiled);
  if (range) {
    range->low = std::max(range->low, 0.0);
    const double depth = range->high - range->low;
    if (has_page && depth > 0)
      compiled.page_fade = cue_of(camera, 1, {range->high + kPageBegin * depth, range->high + kPageEnd * depth});
    range->low += kExactPart * depth;
  }
  if (camera.depth_cue_range) range = camera.depth_cue_range;
  if (camera.depth_cue > 0 && range && range->low < range->high)  // otherwise all is behind the camera
    compiled.depth_cue = cue_of(camera, camera.depth_cue, *range);
  compiled.features.depth_cue = compiled.depth_cue.strength > 0 || compiled.page_fade.strength > 0;
}

/// Compiles an image background or a sky; without one, the gradient or constant colour.
void set_background(const scene::Scene& scene, CompiledScene& compiled) {
  const scene::Background& from = scene.background;
  compiled.backdrop = from.backdrop;
  compiled.environment = nullptr;
  compiled.features.gradient = compiled.features.tilted = false;
  std::shared_ptr<const scene::LatLongMap> image = from.image;
  if (!image && from.type == scene::BackgroundType::kSky)
    image = std::make_shared<const scene::LatLongMap>(sky::bake_sky(from));
  if (image) {
    EnvironmentSettings settings;
    settings.rotation = from.rotation;
    settings.scale = stops_to_factor(from.exposure);
    settings.sampling = environment_sampling(compiled.direct_lighting);
    settings.light_group = light_group(compiled, from.light_group);
    settings.visible = from.visible;
    compiled.environment = std::make_shared<const EnvironmentMap>(image, settings);
    compiled.background = {{0, 0, 0}, {0, 0, 0}};
    return;
  }
  const bool gradient = from.type == scene::BackgroundType::kGradient;
  compiled.background.up = math::normalized(from.up);
  compiled.background.bottom = gradient ? from.bottom : from.color;
  compiled.background.top = gradient ? from.top : from.color;
  compiled.features.gradient = gradient && !(from.bottom == from.top);
  compiled.features.tilted = compiled.features.gradient && !(compiled.background.up == Vec3d{0, 1, 0});
}

/// With blue noise, a pixel owns a power of two of consecutive points of the sequence, at least as many as its samples;
/// its neighbours own the next ones.
kernel::Sampler compile_sampler(const scene::Render& render) {
  kernel::Sampler out;
  out.seed = render.seed;
  out.kind = static_cast<kernel::SamplerKind>(render.sampler);
  out.blue_noise_bits = blue_noise_bits(render.samples);
  return out;
}

/// Sets the camera, the window, and how paths are sampled.
void set_view(const scene::Scene& scene, const scene::Scene* closing, CompiledScene& compiled) {
  const scene::Window window = scene.image.data_window();
  compiled.window_x = window.x;
  compiled.window_y = window.y;
  compiled.width = window.width;
  compiled.height = window.height;
  compiled.frame_width = scene.image.width;
  compiled.frame_height = scene.image.height;
  compiled.pixel_aspect = scene.image.pixel_aspect;
  compiled.samples = scene.render.samples;
  compiled.max_depth = static_cast<std::uint32_t>(scene.render.max_depth);
  compiled.roulette_depth =
      scene.render.roulette_depth > 0 ? static_cast<std::uint32_t>(scene.render.roulette_depth) : kernel::kNoRoulette;
  compiled.sampler = compile_sampler(scene.render);
  compiled.shading = static_cast<kernel::Shading>(scene.render.shading);
  compiled.filter = compile_filter(scene.render);
  set_camera(scene, closing, compiled);
  set_depth_cue(scene, compiled);
}

void update_parts(const scene::Scene& scene, const scene::Scene* closing, scene::Parts changed,
                  const SphereStore::OnCopied& on_copied, CompiledScene& compiled) {
  if (changed.geometry) {
    compiled.precision = static_cast<Precision>(scene.render.precision);
    // The book's own method. It has no BVH, and the kernel has no vector loop for its precision.
    compiled.accelerator = compiled.precision == Precision::kBook ? Accelerator::kList : scene.render.accelerator;
    set_rods(scene, compiled);
    compiled.motion.clear();
    compiled.rod_motion.clear();
    if (closing != nullptr) {
      const double frames = scene.camera.shutter_close - scene.camera.shutter_open;
      compiled.motion = sphere_motion(scene, *closing, frames);
      compiled.rod_motion = rod_motion(scene, *closing, frames);
    }
    compiled.bonds_move = compiled.motion.size() > scene.spheres.size() && !compiled.bonds.empty();
    set_spheres(scene, on_copied, compiled);
    compiled.features.rods = compiled.rod_count() > 0;
  }
  if (changed.geometry || changed.assignment) {
    set_object_materials(scene, compiled);
    set_opacity(scene, compiled);
  }
  if (changed.geometry || changed.assignment || changed.look) {
    compiled.direct_lighting = static_cast<kernel::DirectLighting>(scene.render.direct_lighting);
    compiled.samples_caustics = scene.render.caustics;
    compile_materials(scene, compiled);
    set_background(scene, compiled);
    light_group(compiled, scene::background_light_group(scene.background));
    compiled.features.lit = !compiled.emission.empty() || compiled.environment != nullptr;
    compiled.light_tree = {};
    update_lights(compiled);
  }
  if (changed.geometry || changed.view) set_view(scene, closing, compiled);
}

}  // namespace

std::vector<kernel::Sphere> sphere_motion(const scene::Scene& scene, const scene::Scene& other, double frames) {
  std::vector<kernel::Sphere> out;
  std::size_t id = scene.sphere_count();
  const auto add = [&](Vec3d displacement, double growth) {
    --id;
    const kernel::Sphere change{displacement.x, displacement.y, displacement.z, growth};
    const bool rests = change.x == 0 && change.y == 0 && change.z == 0 && change.radius == 0;
    if (out.empty() && !rests) out.resize(id + 1, kernel::Sphere{0, 0, 0, 0});
    if (!rests) out[id] = change;
  };
  for (auto points = scene.points.rbegin(); points != scene.points.rend(); ++points) {
    if (points->to_next.empty()) id -= points->centers.size();
    for (std::size_t i = points->to_next.size(); i-- > 0;) add(points->displacement(i, frames), 0);
  }
  for (std::size_t i = scene.spheres.size(); i-- > 0;) {
    const scene::Sphere &from = scene.spheres[i], &to = other.spheres[i];
    add(to.center - from.center, std::abs(to.radius) - std::abs(from.radius));
  }
  return out;
}

std::vector<kernel::Rod> rod_motion(const scene::Scene& scene, const scene::Scene& other, double frames) {
  std::vector<kernel::Rod> out;
  std::size_t rod = scene.rod_count();
  for (const scene::Points& points : scene.points) rod -= points.bond_pairs.size();
  const auto add = [&](bool reversed, Vec3d of_from, Vec3d of_to, double growth) {
    --rod;
    const bool rests = of_from == Vec3d{0, 0, 0} && of_to == Vec3d{0, 0, 0} && growth == 0;
    if (out.empty() && !rests) out.resize(rod + 1, kernel::Rod{{0, 0, 0}, 0, {0, 0, 0}, 0});
    if (rests) return;
    set(out[rod].a, reversed ? of_to : of_from);
    set(out[rod].b, reversed ? of_from : of_to);
    out[rod].radius = growth;
  };
  for (auto points = scene.points.rbegin(); points != scene.points.rend(); ++points)
    for (auto stub = points->bond_stubs.rbegin(); stub != points->bond_stubs.rend(); ++stub) {
      const bool moves = !points->to_next.empty();
      const Vec3d from = moves ? points->displacement(stub->sphere, frames) : Vec3d{},
                  partner = moves ? points->displacement(stub->partner, frames) : Vec3d{};
      add(is_reversed(points->centers[stub->sphere], stub->end), from, (from + partner) / 2, 0);
    }
  for (const scene::RodFile& file : scene.rod_files) rod -= file.from.size();
  for (std::size_t i = scene.rods.size(); i-- > 0;) {
    const scene::Rod &from = scene.rods[i], &to = other.rods[i];
    add(is_reversed(from.from, from.to), to.from - from.from, to.to - from.to, to.radius - from.radius);
  }
  return out;
}

kernel::SceneView CompiledScene::view() const noexcept {
  kernel::SceneView v;
  static_cast<kernel::SceneSettings&>(v) = *this;
  v.spheres = spheres.view();
  v.object_materials = object_materials.view();
  v.materials = materials.data();
  v.sphere_count = spheres.size();
  static constexpr kernel::Sphere kReadable;  // the kernel reads a sphere in lanes that hit a rod
  if (spheres.empty()) v.spheres = &kReadable;
  v.rods = {rods.data(), rod_count(), rod_motion.data(), rod_motion.size(), spheres.size()};
  v.rods.bonds = bonds.data();
  v.rods.bond_count = bonds.size();
  v.rods.bond_radii = bond_radii.data();
  v.rods.spheres = v.spheres;
  v.rods.sphere_motion = motion.data();
  v.rods.moving_spheres = bonds_move ? motion.size() : 0;
  v.duplicates = duplicates;
  v.opacity = opacity.empty() ? nullptr : opacity.data();
  v.emission = emission.empty() ? nullptr : emission.data();
  if (!textures.textures().empty()) {
    v.textures = textures.textures().data();
    v.material_textures = textures.materials().data();
    if (textures.has_levels()) v.cone_width = kConeWidth;
  }
  v.lights = light_tree.view();
  v.caustics = caustics.view();
  v.motion = motion.data();
  v.moving_count = motion.size();
  v.environment = environment ? &environment->view() : nullptr;
  v.background_visible = backdrop || !environment || environment->view().visible;
  v.has_backdrop = backdrop.has_value();
  v.backdrop = backdrop.value_or(math::Vec3d());
  v.page = page;
  if (!filter.empty()) v.filter.places = filter.data();
  v.window_x = static_cast<std::uint32_t>(window_x) & 0xffff;
  v.window_y = static_cast<std::uint32_t>(window_y) & 0xffff;
  return v;
}

Bounds bounds_of(const CompiledScene& scene) {
  Bounds b = bounds_of(scene.spheres);
  bool is_empty = scene.spheres.empty();
  const auto add = [&](const double(&p)[3], double radius) {
    const Vec3d at = math::vector_of(p), reach{radius, radius, radius}, low = at - reach, high = at + reach;
    b.lower = is_empty ? low : math::least(b.lower, low);
    b.upper = is_empty ? high : math::greatest(b.upper, high);
    is_empty = false;
  };
  const kernel::RodArray rods = scene.view().rods;
  for (std::size_t i = 0; i < rods.count; ++i) {
    const kernel::Rod rod = rods[i];
    add(rod.a, rod.radius);
    add(rod.b, rod.radius);
  }
  return b;
}

void update_lights(CompiledScene& scene) {
  const auto is_fast = [](Precision precision) { return precision == Precision::kFast; };
  if (!scene.compared_in || is_fast(*scene.compared_in) != is_fast(scene.precision)) {
    scene.duplicates = coincident_objects(scene);
    scene.compared_in = scene.precision;
    scene.light_tree = {};
  }
  if (scene.emission.empty() || scene.direct_lighting == kernel::DirectLighting::kBsdf) {
    scene.light_tree = {};
  } else if (scene.light_tree.spheres.empty()) {
    scene.light_tree = build_light_tree(scene.view());
  }
  scene.caustics = {};
  if (scene.samples_caustics && scene.direct_lighting != kernel::DirectLighting::kBsdf)
    scene.caustics = caustic_list(scene.view(), scene.precision);
  scene.features.caustics = !scene.caustics.balls.empty();
}

int blue_noise_bits(int samples) noexcept {
  return std::min(static_cast<int>(std::bit_width(static_cast<unsigned>(samples) - 1)), kernel::kSobolBits);
}

CompiledScene compile(const scene::Scene& scene, const scene::Scene* closing) {
  CompiledScene compiled;
  update(scene, closing, scene::Parts::all(), compiled);
  return compiled;
}

void update(const scene::Scene& scene, const scene::Scene* closing, scene::Parts changed, CompiledScene& compiled) {
  update_parts(scene, closing, changed, {}, compiled);
}

void update_and_release(scene::Scene& scene, const scene::Scene* closing, scene::Parts changed,
                        CompiledScene& compiled) {
  const auto release = [&](std::size_t points, std::size_t begin, std::size_t end) {
    scene.points[points].centers.release(begin, end);
  };
  update_parts(scene, closing, changed, release, compiled);
}

}  // namespace orrery::compile
