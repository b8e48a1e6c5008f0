// SPDX-License-Identifier: Apache-2.0
#include "baseline/program.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <variant>

#include "base/error.h"
#include "baseline/native_points.h"
#include "baseline/sphere.h"

namespace orrery::bench::baseline {
namespace {

/// The book's ray epsilon against self-intersection, scene units.
constexpr double kShortestDistance = 0.001;

[[noreturn]] void refuse(const std::string& what) {
  throw base::Error(
      base::ErrorKind::kUsage,
      "the baseline does not support " + what + "; benchmark scenes may only use features of the book's final program");
}

struct MakeMaterial {
  std::unique_ptr<const Material> operator()(const scene::Lambertian& m) const {
    return std::make_unique<Lambertian>(m.albedo);
  }
  std::unique_ptr<const Material> operator()(const scene::Hemisphere&) const { refuse("the hemisphere material"); }
  std::unique_ptr<const Material> operator()(const scene::Metal& m) const {
    return std::make_unique<Metal>(m.albedo, m.fuzz);
  }
  std::unique_ptr<const Material> operator()(const scene::Dielectric& m) const {
    if (m.fresnel != scene::Fresnel::kSchlick) refuse("reflectance models other than Schlick's");
    return std::make_unique<Dielectric>(m.ior);
  }
  std::unique_ptr<const Material> operator()(const scene::Emitter&) const { refuse("emitters"); }
  std::unique_ptr<const Material> operator()(const scene::Plastic&) const { refuse("plastic"); }
};

std::unique_ptr<const Hittable> make_list(const std::vector<PlacedSphere>& spheres) {
  auto list = std::make_unique<HittableList>();
  for (const PlacedSphere& s : spheres) list->add(std::make_unique<Sphere>(s.center, s.radius, s.material));
  return list;
}

double tangent_of_half(double angle_deg) { return std::tan(angle_deg * std::numbers::pi / 360); }

}  // namespace

Program::Program(const scene::Scene& scene, Spheres spheres)
    : background_(scene.background),
      width_(scene.image.width),
      height_(scene.image.height),
      samples_(scene.render.samples),
      max_depth_(scene.render.max_depth),
      has_lens_(scene.camera.defocus_angle > 0) {
  if (scene.render.shading != scene::Shading::kPath) refuse("shading modes other than path tracing");
  if (background_.type == scene::BackgroundType::kImage || background_.type == scene::BackgroundType::kSky)
    refuse("image backgrounds");
  if (background_.type == scene::BackgroundType::kConstant) background_.bottom = background_.top = background_.color;

  if (scene.rod_count() > 0) refuse("rods");
  for (const scene::Material& m : scene.materials)
    if (scene::opacity_of(m.model) < 1) refuse("opacity");
  for (const scene::Material& m : scene.materials) materials_.push_back(std::visit(MakeMaterial(), m.model));
  std::vector<PlacedSphere> placed;
  for (const scene::Sphere& s : scene.spheres) placed.push_back({s.center, s.radius, materials_[s.material].get()});
  for (const scene::Points& p : scene.points) {
    for (std::size_t i = 0; i < p.centers.size(); ++i) {
      const std::uint32_t material = p.materials.empty() ? p.material : p.materials[i];
      placed.push_back({p.centers[i], p.radii[i], materials_[material].get()});
    }
  }
  world_ = spheres == Spheres::kList ? make_list(placed) : make_native_points(std::move(placed));

  const scene::Camera& c = scene.camera;
  const double focus = c.focus_distance.value_or(math::length(c.look_from - c.look_at));
  const double viewport_height = 2 * tangent_of_half(c.vfov) * focus;
  const double viewport_width = viewport_height * width_ / height_;
  const Vec3d w = math::normalized(c.look_from - c.look_at);
  const Vec3d u = math::normalized(math::cross(c.up, w));
  const Vec3d v = math::cross(w, u);
  origin_ = c.look_from;
  right_ = u * (viewport_width / width_);
  down_ = -v * (viewport_height / height_);
  first_pixel_ = origin_ - focus * w - u * (viewport_width / 2) + v * (viewport_height / 2) + 0.5 * (right_ + down_);
  lens_u_ = u * (focus * tangent_of_half(c.defocus_angle));
  lens_v_ = v * (focus * tangent_of_half(c.defocus_angle));
}

Ray Program::camera_ray(int x, int y, Random& random) const {
  const Vec3d to = first_pixel_ + (x + random.unit() - 0.5) * right_ + (y + random.unit() - 0.5) * down_;
  if (!has_lens_) return {origin_, to - origin_};
  const Vec3d p = random.in_disc();
  const Vec3d from = origin_ + p.x * lens_u_ + p.y * lens_v_;
  return {from, to - from};
}

Vec3d Program::ray_color(const Ray& ray, int depth, Random& random) {
  if (depth <= 0) return {0, 0, 0};
  ++rays_;
  HitRecord hit;
  if (!world_->hit(ray, {kShortestDistance, std::numeric_limits<double>::infinity()}, hit)) {
    const double up = 0.5 * (math::normalized(ray.direction).y + 1);
    return (1 - up) * background_.bottom + up * background_.top;
  }
  Scattered next;
  if (!hit.material->scatter(ray, hit, random, next)) return {0, 0, 0};
  return next.attenuation * ray_color(next.ray, depth - 1, random);
}

std::vector<Vec3d> Program::render(std::uint64_t seed) {
  Random random(seed);
  std::vector<Vec3d> pixels;
  pixels.reserve(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      Vec3d sum;
      for (int i = 0; i < samples_; ++i) sum = sum + ray_color(camera_ray(x, y, random), max_depth_, random);
      pixels.push_back(sum / samples_);
    }
  }
  return pixels;
}

}  // namespace orrery::bench::baseline
