// SPDX-License-Identifier: Apache-2.0
#include "scene/validate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <set>
#include <utility>

#include <fmt/core.h>

#include "base/error.h"

#include "base/parallel.h"
#include "base/stop_point.h"
#include "scene/layers.h"
#include "scene/limits.h"
#include "scene/texture.h"
#include "scene/value_text.h"

namespace orrery::scene {
namespace {

std::string length_range() { return fmt::format("{}..{}", number_text(kSmallestRadius), number_text(kLargestLength)); }

bool in_domain(Vec3d c) {
  // Written so that a NaN is outside.
  return std::abs(c.x) <= kLargestLength && std::abs(c.y) <= kLargestLength && std::abs(c.z) <= kLargestLength;
}
/// Length of a scale bar, in widths of the image.
constexpr double kLargestScaleBar = 0.95;

double max(Vec3d v) { return std::max({v.x, v.y, v.z}); }
bool has_direction(Vec3d v) { return math::length(v) >= kSmallestRadius; }

void check_image(const Image& image, KeyFaults& diagnostics) {
  if (image.crop) {
    const Window& w = *image.crop;
    if (w.width < 1 || w.height < 1 || w.x < 0 || w.y < 0 || w.width > image.width - w.x ||
        w.height > image.height - w.y)
      diagnostics.error("image.crop", fmt::format("must be a non-empty [x, y, width, height] inside the {} x {} frame",
                                                  image.width, image.height));
    if (image.overscan > 0) diagnostics.error("image.overscan", "cannot be combined with crop; remove one of them");
  }
  const Window all = image.data_window();
  if (all.width > kLargestSide || all.height > kLargestSide)
    diagnostics.error("image.overscan",
                      fmt::format("frame plus overscan exceeds the limit of {} pixels per side", kLargestSide));
}

void check_annotation(const Scene& scene, KeyFaults& diagnostics) {
  const bool has_labels =
      std::any_of(scene.points.begin(), scene.points.end(), [](const Points& p) { return !p.labels.empty(); });
  if (scene.annotation.scale_bar && scene.camera.projection == Projection::kPerspective)
    diagnostics.error("annotation.scale_bar",
                      "requires camera.projection = \"orthographic\": in a perspective image, the length of an object "
                      "depends on its distance");
  if (scene.annotation.scale_bar && scene.camera.width) {
    const double share = *scene.annotation.scale_bar / *scene.camera.width;
    if (share > kLargestScaleBar || share * scene.image.width < 1)
      diagnostics.warning("annotation.scale_bar",
                          fmt::format("a bar of {} is too {} for an image that is {:.4g} wide",
                                      number_text(*scene.annotation.scale_bar),
                                      share > kLargestScaleBar ? "long" : "short", *scene.camera.width));
  }
  if (scene.annotation.color_bar &&
      std::none_of(scene.points.begin(), scene.points.end(), [](const Points& p) { return p.color.has_legend(); }))
    diagnostics.warning("annotation.color_bar",
                        "has no effect: no points table is coloured by a column, by types or by elements");
  if ((scene.annotation.is_set() || has_labels) && (scene.image.crop || scene.image.overscan > 0))
    diagnostics.error("annotation", "cannot be combined with image.crop or image.overscan");
}

void check_camera(const Camera& camera, KeyFaults& diagnostics) {
  bool usable = true;
  for (const auto& [name, v] :
       {std::pair{"look_from", camera.look_from}, {"look_at", camera.look_at}, {"up", camera.up}}) {
    if (in_domain(v)) continue;
    diagnostics.error(std::string("camera.") + name,
                      fmt::format("{} is not finite or exceeds {}", vector_text(v), number_text(kLargestLength)));
    usable = false;
  }
  if (!usable) return;  // the checks below would report the same mistake again
  const Vec3d view = camera.look_at - camera.look_from;
  if (!has_direction(view)) {
    diagnostics.error("camera.look_at",
                      view == Vec3d{}
                          ? "look_at is the same point as look_from, so the camera has no direction"
                          : fmt::format("look_at is closer to look_from than {}, so the camera has no direction",
                                        number_text(kSmallestRadius)));
  } else if (!has_direction(camera.up)) {
    diagnostics.error("camera.up",
                      camera.up == Vec3d{}
                          ? "up is zero; use any direction that is not parallel to the view"
                          : fmt::format("up is shorter than {}; use any direction that is not parallel to the view",
                                        number_text(kSmallestRadius)));
  } else if (math::length(math::cross(math::normalized(view), math::normalized(camera.up))) < kSmallestUpSine) {
    diagnostics.error("camera.up", "up is parallel to the view; choose another direction");
  }
}

/// Checks that the keys of the camera belong to its projection.
void check_projection(const Camera& camera, KeyFaults& diagnostics) {
  const bool is_orthographic = camera.projection == Projection::kOrthographic;
  if (is_orthographic && !camera.width)
    diagnostics.error("camera.projection", "orthographic needs `width`, the width of the image in scene units");
  if (is_orthographic && camera.vfov != Camera().vfov)
    diagnostics.warning("camera.vfov", "has no effect; an orthographic camera has `width`");
  if (!is_orthographic && camera.width)
    diagnostics.warning("camera.width", "has no effect; set camera.projection to \"orthographic\"");
}

void check_shutter(const Camera& camera, KeyFaults& diagnostics) {
  if (camera.shutter_close < camera.shutter_open)
    diagnostics.error("camera.shutter_close",
                      fmt::format("the shutter closes at {}, before it opens at {}", number_text(camera.shutter_close),
                                  number_text(camera.shutter_open)));
}

/// Checks that a depth cue knows where it begins and ends.
void check_depth_cue(const Scene& scene, KeyFaults& diagnostics) {
  const Camera& camera = scene.camera;
  if (camera.depth_cue > 0 && !camera.depth_cue_range && scene.points.empty() && scene.rods.empty() &&
      scene.rod_files.empty())
    diagnostics.error("camera.depth_cue",
                      "needs `depth_cue_range` in a scene without [[points]] and rods, whose depth is the default");
  if (camera.depth_cue == 0 && camera.depth_cue_range)
    diagnostics.warning("camera.depth_cue_range", "has no effect; set camera.depth_cue");
}

/// Checks that there is at most one page.
void check_page(const Scene& scene, KeyFaults& diagnostics) {
  bool has_page = false;
  for (std::size_t i = 0; i < scene.spheres.size(); ++i) {
    if (has_page && scene.spheres[i].is_page)
      diagnostics.error(fmt::format("sphere[{}].page", i), "another sphere is the page; a scene has one");
    has_page = has_page || scene.spheres[i].is_page;
  }
}

/// Checks that the keys of the background belong to its type. The colours of other types are ignored silently, so that
/// switching the type with --set is convenient; a setting of an image or a sky that is not used is probably
/// a mistake.
void check_background(const Background& background, KeyFaults& diagnostics) {
  const bool is_image = background.type == BackgroundType::kImage;
  const bool is_sky = background.type == BackgroundType::kSky, has_map = is_image || is_sky;
  const Background unset;
  if (!in_domain(background.up) || !has_direction(background.up))
    diagnostics.error("background.up", fmt::format("{} has no direction", vector_text(background.up)));
  if (is_image && background.file.empty())
    diagnostics.error("background.file", "type \"image\" needs an EXR or HDR file");
  const auto unused_unless = [&](bool is_used, const char* types, const char* key, bool is_set) {
    if (is_set && !is_used)
      diagnostics.warning(std::string("background.") + key,
                          std::string("has no effect; set background.type to ") + types);
  };
  constexpr const char *kImage = "\"image\"", *kSky = "\"sky\"", *kMap = "\"image\" or \"sky\"";
  unused_unless(is_image, kImage, "file", !background.file.empty());
  unused_unless(is_image, kImage, "color_space", !background.color_space.empty());
  unused_unless(has_map, kMap, "rotation", background.rotation != unset.rotation);
  unused_unless(has_map, kMap, "exposure", background.exposure != unset.exposure);
  unused_unless(has_map, kMap, "light_group", background.light_group != unset.light_group);
  unused_unless(has_map, kMap, "visible", background.visible != unset.visible);
  unused_unless(is_sky, kSky, "sun_elevation", background.sun_elevation != unset.sun_elevation);
  unused_unless(is_sky, kSky, "sun_azimuth", background.sun_azimuth != unset.sun_azimuth);
  unused_unless(is_sky, kSky, "turbidity", background.turbidity != unset.turbidity);
  unused_unless(is_sky, kSky, "ground_albedo", background.ground_albedo != unset.ground_albedo);
  unused_unless(is_sky, kSky, "sun", background.sun != unset.sun);
}

/// Checks the exposure of emitters, except where the radiance is an image.
void check_emitters(const Scene& scene, KeyFaults& diagnostics) {
  for (const Material& material : scene.materials) {
    const auto* const emitter = std::get_if<Emitter>(&material.model);
    if (emitter == nullptr) continue;
    const Texture* const texture = emitter->radiance_texture.get();
    if (texture != nullptr && texture->type == TextureType::kImage) continue;
    const double radiance =
        texture != nullptr ? std::max(max(texture->low), max(texture->high)) : max(emitter->radiance);
    diagnostics.error_if_any(fmt::format("material.{}.exposure", material.name),
                             exposure_fault(radiance, emitter->exposure));
  }
}

/// Ray origins on the lens must be inside the domain of coordinates.
void check_lens(const Camera& camera, KeyFaults& diagnostics) {
  if (!(camera.defocus_angle > 0)) return;
  const double focus = camera.focus_distance.value_or(math::length(camera.look_at - camera.look_from));
  const double radius = std::tan(camera.defocus_angle / 360 * std::numbers::pi) * focus;
  if (radius <= kLargestLength) return;
  diagnostics.error("camera.defocus_angle",
                    fmt::format("the lens radius would be {}; the maximum is {}; reduce the angle or focus_distance",
                                number_text(radius), number_text(kLargestLength)));
}

/// Returns what is wrong with a radius; empty if it is valid.
std::string radius_fault(double radius, Precision precision) {
  if (!std::isfinite(radius)) return "radius is not finite; must be in " + length_range();
  if (radius == 0) return fmt::format("radius is 0; must be in {}, or negative for an inward normal", length_range());
  if (std::abs(radius) < kSmallestRadius || std::abs(radius) > kLargestLength)
    return fmt::format("radius is {}; its magnitude must be in {}", number_text(radius), length_range());
  if (precision == Precision::kFast && std::abs(radius) < kSmallestFastRadius)
    return fmt::format("radius is {}, too small for precision `fast`, which needs {} at least; use `exact`",
                       number_text(radius), number_text(kSmallestFastRadius));
  return {};
}

std::string material_fault(std::uint32_t material, const Scene& scene) {
  if (material < scene.materials.size()) return {};
  return fmt::format("there is no material with index {}; the scene has {}, counted from 0", material,
                     scene.materials.size());
}

std::string center_fault(Vec3d center) {
  if (in_domain(center)) return {};
  return fmt::format("center {} is not finite or exceeds {}", vector_text(center), number_text(kLargestLength));
}

/// Calls `report(key suffix, text)` for each fault of a sphere.
template <class Report>
void check_sphere(Vec3d center, double radius, std::uint32_t material, const Scene& scene, Report report) {
  if (const std::string fault = center_fault(center); !fault.empty()) report(".center", fault);
  if (const std::string fault = radius_fault(radius, scene.render.precision); !fault.empty()) report(".radius", fault);
  if (const std::string fault = material_fault(material, scene); !fault.empty()) report(".material", fault);
}

void check_spheres(const Scene& scene, KeyFaults& diagnostics) {
  for (std::size_t i = 0; i < scene.spheres.size(); ++i) {
    const Sphere& s = scene.spheres[i];
    check_sphere(s.center, s.radius, s.material, scene, [&](const char* part, std::string text) {
      diagnostics.error(fmt::format("sphere[{}]{}", i, part), std::move(text));
    });
  }
}

/// Returns what is wrong with the radius of a rod; empty if it is valid.
std::string rod_radius_fault(double radius, Precision precision) {
  if (!(radius > 0)) return fmt::format("radius is {}; must be in {}", number_text(radius), length_range());
  return radius_fault(radius, precision);
}

std::string rod_material_fault(std::uint32_t material, const Scene& scene) {
  if (const std::string fault = material_fault(material, scene); !fault.empty()) return fault;
  if (!std::holds_alternative<Dielectric>(scene.materials[material].model)) return {};
  return fmt::format(
      "{} is a dielectric, but rods transmit no light: a ray hits them from outside only; use another type of "
      "material, or spheres",
      string_text(scene.materials[material].name));
}

/// Calls `report(key suffix, text)` for each fault of a rod's ends and radius.
template <class Report>
void check_rod(Vec3d from, Vec3d to, double radius, Precision precision, Report report) {
  for (const auto& [name, end] : {std::pair{".from", from}, {".to", to}})
    if (!in_domain(end))
      report(name, fmt::format("{} is not finite or exceeds {}", vector_text(end), number_text(kLargestLength)));
  if (const std::string fault = rod_radius_fault(radius, precision); !fault.empty()) report(".radius", fault);
}

void check_rod_materials(const std::string& key, const std::array<std::uint32_t, 2>& materials, const Scene& scene,
                         KeyFaults& diagnostics) {
  for (std::size_t half = 0; half < 2; ++half) {
    if (half > 0 && materials[1] == materials[0]) continue;
    diagnostics.error_if_any(key + ".material", rod_material_fault(materials[half], scene));
  }
}

void check_rods(const Scene& scene, KeyFaults& diagnostics) {
  for (std::size_t i = 0; i < scene.rods.size(); ++i) {
    const Rod& rod = scene.rods[i];
    const std::string key = fmt::format("rod[{}]", i);
    check_rod(rod.from, rod.to, rod.radius, scene.render.precision,
              [&](const char* part, std::string text) { diagnostics.error(key + part, std::move(text)); });
    check_rod_materials(key, rod.materials, scene, diagnostics);
  }
  for (std::size_t f = 0; f < scene.rod_files.size(); ++f) {
    const RodFile& rods = scene.rod_files[f];
    const std::string key = fmt::format("rods[{}]", f);
    check_rod_materials(key, rods.materials, scene, diagnostics);
    std::size_t faults = 0;
    const base::StopPoint stop;
    for (std::size_t i = 0; i < rods.from.size(); ++i) {
      stop.check(i);
      check_rod(rods.from[i], rods.to[i], rods.radii[i], scene.render.precision,
                [&](const char* part, std::string text) {
                  if (++faults <= kMaxReported)
                    diagnostics.error(
                        key + ".file",
                        fmt::format("row {} of {}: {}{}", i + 1, rods.file.string(),
                                    part == std::string(".radius") ? "" : std::string(part).substr(1) + " ", text));
                });
    }
    diagnostics.error_if_any(key + ".file", rest_text(faults));
  }
}

/// Checks the rods of bonds and arrows.
void check_bonds(const Points& points, const std::string& key, const Scene& scene, KeyFaults& diagnostics) {
  const bool are_bonds = points.bonds.are_drawn || points.bond_count() > points.arrow_count;
  if (!are_bonds && points.vectors.columns.empty()) return;
  const std::string part = key + (are_bonds ? ".bonds" : ".vectors");
  if (points.bonds.material) {
    diagnostics.error_if_any(key + ".bonds.material", rod_material_fault(*points.bonds.material, scene));
  } else {
    std::vector<bool> is_used(scene.materials.size());
    const auto use = [&](std::uint32_t material) {
      if (material < is_used.size()) is_used[material] = true;
    };
    if (points.materials.empty() && points.material_where.empty()) use(points.material);
    if (points.materials.size() == points.centers.size()) {
      for (const SphereBond& bond : points.bond_pairs)
        for (const std::uint32_t end : {bond.a, bond.b}) use(points.materials[end]);
      for (const BondStub& stub : points.bond_stubs) use(points.materials[stub.sphere]);
    }
    for (std::size_t m = 0; m < is_used.size(); ++m)
      if (is_used[m] && std::holds_alternative<Dielectric>(scene.materials[m].model))
        diagnostics.error(
            part, fmt::format("{} are opaque, but have the material of their spheres, {}, which is a "
                              "dielectric; {}",
                              are_bonds ? "bonds" : "arrows", string_text(scene.materials[m].name),
                              are_bonds ? "set `bonds.material`, or use another material" : "use another material"));
  }
  if (points.bond_count() == 0) return;
  diagnostics.error_if_any(part + ".radius", rod_radius_fault(points.bond_radius, scene.render.precision));
  for (const BondStub& stub : points.bond_stubs)
    if (!in_domain(stub.end))
      return diagnostics.error(key + ".bonds", fmt::format("the middle of a bond, {}, is not finite or exceeds {}",
                                                           vector_text(stub.end), number_text(kLargestLength)));
}

/// Reports spheres of dielectrics with an opacity below 1, the first one of a table.
void check_opacity(std::size_t number, const Scene& scene, KeyFaults& diagnostics) {
  const Points& points = scene.points[number];
  if (!points.opacity.is_set()) return;
  const base::StopPoint stop;
  for (std::size_t i = 0; i < points.centers.size(); ++i) {
    stop.check(i);
    const double opacity = points.opacities.empty() ? points.opacity.value.value_or(1) : points.opacities[i];
    const std::uint32_t material = points.materials.empty() ? points.material : points.materials[i];
    if (opacity < 0 || opacity == 1 || material >= scene.materials.size() ||
        !std::holds_alternative<Dielectric>(scene.materials[material].model))
      continue;
    return diagnostics.error(
        fmt::format("points[{}].opacity", number),
        fmt::format("{} has opacity {} and the dielectric {}, but glass is transparent already; "
                    "use another type of material",
                    sphere_name(scene, number, i), number_text(opacity), string_text(scene.materials[material].name)));
  }
}

void check_points(std::size_t number, const Scene& scene, KeyFaults& diagnostics) {
  const Points& points = scene.points[number];
  const std::string key = fmt::format("points[{}]", number);
  const bool is_released = points.centers.empty();  // Points::objects are kept
  if (points.radii.size() != points.centers.size() ||
      (!points.materials.empty() && points.materials.size() != points.centers.size()) ||
      (!points.colors.empty() && points.colors.size() != points.centers.size()) ||
      (!points.opacities.empty() && points.opacities.size() != points.centers.size()) ||
      (!points.objects.empty() && !is_released &&
       points.objects.size() != points.centers.size() + points.bond_stubs.size())) {
    diagnostics.error(key, fmt::format("has {} centres, {} radii and {} materials", points.centers.size(),
                                       points.radii.size(), points.materials.size()));
    return;
  }
  if (points.materials.empty()) diagnostics.error_if_any(key + ".material", material_fault(points.material, scene));
  const auto check = [&](std::size_t i, auto report) {
    const std::uint32_t material = points.materials.empty() ? 0 : points.materials[i];
    check_sphere(points.centers[i], points.radii[i], material, scene, [&](const std::string& part, std::string text) {
      if (points.materials.empty() && part == ".material") return;  // reported once, above
      report(std::move(text));
    });
  };
  const auto is_good = [&](std::size_t i) {
    bool good = true;
    check(i, [&](const std::string&) { good = false; });
    return good;
  };
  std::size_t faults = 0;
  if (!base::are_all(points.centers.size(), is_good)) {
    const base::StopPoint stop;
    for (std::size_t i = 0; i < points.centers.size(); ++i) {
      stop.check(i);
      check(i, [&](const std::string& text) {
        if (++faults <= kMaxReported)
          diagnostics.error(key + ".file", fmt::format("{}: {}", sphere_name(scene, number, i), text));
      });
    }
  }
  diagnostics.error_if_any(key + ".file", rest_text(faults));
  check_opacity(number, scene, diagnostics);
}

void check_layers(const Scene& scene, KeyFaults& diagnostics) {
  for (std::size_t i = 0; i < scene.output.layers.size(); ++i)
    diagnostics.error_if_any(fmt::format("output.layers[{}]", i), layer_fault(scene, scene.output.layers[i]));
}

void check_light_groups(const Scene& scene, KeyFaults& diagnostics) {
  std::set<std::string> names = {kDefaultLightGroup};  // the background's light, or that of an emitter without a group
  const auto check = [&](const std::string& key, const std::string& name) {
    if (const std::string fault = light_group_fault(name); !fault.empty())
      diagnostics.error(key, fmt::format("{} {}", string_text(name), fault));
    const bool is_new = !name.empty() && names.insert(name).second;
    if (is_new && names.size() == kMaxLightGroups + 1)
      diagnostics.error(
          key, fmt::format("the scene has more than {} light groups, with the default group", kMaxLightGroups));
  };
  for (const Material& material : scene.materials)
    if (const auto* emitter = std::get_if<Emitter>(&material.model))
      check(fmt::format("material.{}.light_group", material.name), emitter->light_group);
  if (background_light_group(scene.background) != kDefaultLightGroup)
    check("background.light_group", scene.background.light_group);
}

}  // namespace

std::string exposure_fault(double radiance, double exposure) {
  const double product = radiance * std::exp2(exposure);
  if (product <= kBrightestLight) return {};
  return fmt::format("the radiance with exposure would be {}; the maximum is {}; {}", number_text(product),
                     number_text(kBrightestLight), kBrighterLightRemedy);
}

std::vector<std::string> sphere_faults(Vec3d center, double radius, Precision precision) {
  std::vector<std::string> out;
  for (std::string fault : {center_fault(center), radius_fault(radius, precision)})
    if (!fault.empty()) out.push_back(std::move(fault));
  return out;
}

std::string sphere_name(const Scene& scene, std::size_t points, std::size_t index) {
  const Points& file = scene.points[points];
  return fmt::format("{}{} of {}", file.spheres_are_rows ? "row " : "sphere ", index + 1,
                     file.file.empty() ? "points[" + std::to_string(points) + "]" : file.file.string());
}

std::vector<SceneDiagnostic> validate(const Scene& scene) {
  KeyFaults diagnostics;
  check_image(scene.image, diagnostics);
  check_camera(scene.camera, diagnostics);
  check_annotation(scene, diagnostics);
  check_background(scene.background, diagnostics);
  check_emitters(scene, diagnostics);
  check_lens(scene.camera, diagnostics);
  check_projection(scene.camera, diagnostics);
  check_shutter(scene.camera, diagnostics);
  check_depth_cue(scene, diagnostics);
  check_spheres(scene, diagnostics);
  check_page(scene, diagnostics);
  for (std::size_t p = 0; p < scene.points.size(); ++p) {
    check_points(p, scene, diagnostics);
    check_bonds(scene.points[p], fmt::format("points[{}]", p), scene, diagnostics);
  }
  check_rods(scene, diagnostics);
  if (scene.sphere_count() + 2 * scene.rod_count() > kMaxSpheres)
    diagnostics.error("",
                      scene.rod_count() == 0
                          ? fmt::format("has {} spheres; the maximum is {}", scene.sphere_count(), kMaxSpheres)
                          : fmt::format("has {} spheres and {} rods; the maximum is {}, in which a rod counts twice",
                                        scene.sphere_count(), scene.rod_count(), kMaxSpheres));
  check_light_groups(scene, diagnostics);
  check_layers(scene, diagnostics);
  return diagnostics.take();
}

}  // namespace orrery::scene
