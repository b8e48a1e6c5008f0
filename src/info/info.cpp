// SPDX-License-Identifier: Apache-2.0
#include "info/info.h"

#include <algorithm>
#include <initializer_list>
#include <limits>
#include <utility>

#include <nlohmann/json.hpp>

#include <fmt/core.h>

#include "accel/accel.h"
#include "accel/traversal.h"
#include "base/text.h"
#include "compile/compiled_scene.h"
#include "compile/environment.h"
#include "film/layer_planes.h"
#include "job/layers.h"
#include "job/prepared_scene.h"
#include "job/report_text.h"
#include "kernel/isa.h"
#include "kernel/lights.h"
#include "load/load_images.h"
#include "load/load_scene.h"
#include "load/read_scene.h"
#include "math/vec3.h"
#include "render/render.h"
#include "scene/layers.h"
#include "scene/schema.h"
#include "scene/texture.h"
#include "scene/validate.h"
#include "scene/value_text.h"

namespace orrery::info {

using nlohmann::json;

namespace {

/// Describes how an image background is sampled: "sky by texels above the mean and the sun (87 %)"; empty if it is not.
std::string environment_text(const compile::CompiledScene& compiled) {
  if (!compiled.environment || !compiled.environment->view().is_sampled) return {};
  const kernel::Environment& view = compiled.environment->view();
  std::vector<std::string> chosen;
  if (view.map_density > 0) chosen.push_back(view.weight_offset > 0 ? "texels above the mean" : "all texels");
  if (view.sun_probability > 0) chosen.push_back(fmt::format("the sun ({:.3g} %)", view.sun_probability * 100));
  return base::joined(chosen, " and ");
}

/// Returns the number of emitters that are rendered, without those that are black. Of coincident objects, only the
/// first is rendered.
std::uint64_t count_emitters(const compile::CompiledScene& compiled) {
  if (compiled.emission.empty()) return 0;
  const kernel::SceneView view = compiled.view();
  const auto shines = [&](std::uint32_t id) {
    const double(&rgb)[3] = compiled.emission[compiled.object_materials[id]].radiance;
    return (rgb[0] > 0 || rgb[1] > 0 || rgb[2] > 0) && !view.is_duplicate(id);
  };
  std::uint64_t count = 0;
  for (std::uint32_t id = 0; id < view.sphere_count; ++id) count += shines(id) ? 1 : 0;
  for (std::size_t i = 0; i < view.rods.count; ++i)
    count += shines(view.rods.id(i)) || shines(view.rods.id(i) + 1) ? 1 : 0;
  return count;
}

/// Describes how light is sampled: "40 emitters; light and BSDF sampling; emitters by a light tree of 1.9 KiB". Empty
/// without emitters and image background.
///
/// `count`    number of emitters
std::string lights_text(const compile::CompiledScene& compiled, std::uint64_t count) {
  if (count == 0 && !compiled.environment) return {};
  std::vector<std::string> lights;
  if (count > 0) lights.push_back(base::counted(count, "emitter"));
  if (compiled.environment) lights.push_back("background");
  std::string out = base::joined(lights);
  const std::string environment = environment_text(compiled);
  switch (compiled.direct_lighting) {
    case kernel::DirectLighting::kBsdf: return out + "; found by BSDF sampling only";
    case kernel::DirectLighting::kMis: out += "; light and BSDF sampling"; break;
    case kernel::DirectLighting::kLight: out += "; light sampling"; break;
  }
  if (count == 0 && environment.empty()) return out.substr(0, out.find(';')) + "; uniform, found by BSDF sampling only";
  if (count > 0 && !environment.empty()) out += ", half of the light samples to each";
  if (compiled.light_tree.spheres.size() > kernel::Lights::kFew) {
    out += "; emitters by a light tree of " + base::bytes_text(compiled.light_tree.bytes());
  } else if (count > 1) {
    out += "; emitters by their irradiance";
  }
  if (!environment.empty()) {
    out += "; background by " + environment;
  } else if (compiled.environment) {
    out += "; background by BSDF sampling only";
  }
  return out;
}

/// Maximum number of pairs of balls and lights that are named.
constexpr std::size_t kNamedPairs = 4;

/// Whether a listed ball is hollow or within another. Light passes two spheres to points in it, which is not sampled.
bool has_glass_in_glass(const compile::CausticList& list) {
  const auto is_within = [](const kernel::CausticBall& inner, const kernel::CausticBall& outer) {
    const math::Vec3d between = math::vector_of(inner.center) - math::vector_of(outer.center);
    return length(between) + inner.radius < outer.radius;
  };
  return std::any_of(list.balls.begin(), list.balls.end(), [&](const kernel::CausticBall& ball) {
    return ball.inner != kernel::kNone ||
           std::any_of(list.balls.begin(), list.balls.end(),
                       [&](const kernel::CausticBall& other) { return is_within(ball, other); });
  });
}

/// Describes which pairs of a sharp ball and a light are sampled: "2 of 3 pairs of a ball and a light sampled:
/// sphere[1] and sphere[3], sphere[1] and the sun". Empty if there is no pair, or lights are not sampled.
std::string caustics_text(const scene::Scene& scene, const compile::CompiledScene& compiled) {
  const compile::CausticList& list = compiled.caustics;
  if (!compiled.samples_caustics || list.pairs == 0) return {};
  const auto name = [&](std::uint32_t id) {
    if (id == kernel::kSun) return std::string("the sun");
    if (id < scene.spheres.size()) return fmt::format("sphere[{}]", id);
    std::size_t index = id - scene.spheres.size(), table = 0;
    for (; index >= compiled.points_sizes[table]; ++table) index -= compiled.points_sizes[table];
    return scene::sphere_name(scene, table, index);
  };
  std::size_t listed = 0;
  std::string names;
  for (const kernel::CausticBall& ball : list.balls)
    for (std::uint32_t i = ball.begin; i < ball.end; ++i)
      if (++listed <= kNamedPairs)
        names += fmt::format("{} {} and {}", listed == 1 ? ":" : ",", name(ball.sphere), name(list.lights[i].id));
  return fmt::format("{} of {} of a ball and a light sampled{}{}{}", listed, base::counted(list.pairs, "pair"), names,
                     listed > kNamedPairs ? ", ..." : "",
                     has_glass_in_glass(list) ? "; points in hollow or nested balls by BSDF sampling" : "");
}

std::vector<Feature> features_of(const compile::CompiledScene& compiled, bool has_layers) {
  const auto some = [&](auto holds) {
    return std::any_of(compiled.materials.begin(), compiled.materials.end(), holds);
  };
  const auto feature = [](const char* name, bool required, const char* why_not, const char* why = "") {
    return Feature{name, required, required ? why : why_not};
  };
  std::vector<Feature> out = {feature("thin lens", compiled.features.lens, "pinhole camera: no lens sampling",
                                      "camera.defocus_angle is above 0")};
  for (const kernel::MaterialTraits& traits : kernel::kMaterialTraits)
    if (!traits.absorbs)  // those are lights
      out.push_back(feature(traits.name,
                            some([&](const kernel::Material& m) { return &kernel::traits_of(m.kind) == &traits; }),
                            "not used by any sphere"));
  const std::initializer_list<Feature> others = {
      feature("fuzz", some([](const kernel::Material& m) { return m.fuzz > 0; }), "no material has fuzz above 0"),
      feature("gradient sky", compiled.features.gradient, "no gradient: independent of direction"),
      feature("image background", compiled.environment != nullptr, "no image: no texture lookups"),
      feature("textures", !compiled.textures.textures().empty(), "all materials are constant"),
      feature("motion blur", compiled.features.motion, "nothing moves while the shutter is open",
              "camera, spheres or rods move while the shutter is open"),
      feature("opacity", compiled.features.opacity, "all objects are opaque", "some objects have an opacity below 1"),
      feature("depth cue", compiled.features.depth_cue, "camera.depth_cue is 0"),
      feature("lights", compiled.features.lit, "no emitters: no shadow rays"),
      feature("layers", has_layers, "none requested: paths are not recorded"),
      feature("light paths", compiled.shading == kernel::Shading::kPath, "render.shading uses the first hit only")};
  out.insert(out.end(), others);
  return out;
}

/// Describes the textures of a scene.
std::vector<TextureInfo> texture_infos(const scene::Scene& scene, const std::vector<load::LoadedTexture>& loaded) {
  std::vector<TextureInfo> out;
  std::size_t next = 0;
  for (const scene::NamedTexture& named : scene::textures(scene)) {
    TextureInfo info;
    info.key = named.key;
    info.type = scene::type_of(*named.texture, named.use).name;
    if (named.texture->type == scene::TextureType::kImage) {
      const load::LoadedMap& map = loaded.at(next++).map;
      info.file = named.texture->file.string();
      info.width = map.width;
      info.height = map.height;
      info.color_space = map.color_space;
    }
    out.push_back(info);
  }
  return out;
}

std::string text_of(const PointsInfo& p) {
  std::string out = fmt::format("{}: {}", p.file, base::counted(p.spheres, "sphere"));
  if (p.bonds > 0) out += fmt::format(", {} rods of bonds", p.bonds);
  if (!p.unused.empty()) out += "; unused: " + base::joined(p.unused);
  return out;
}

std::string text_of(const TextureInfo& t) {
  std::string out = fmt::format("{}: {}", t.key, t.type);
  if (t.width > 0)
    out += fmt::format(", {}: {} x {}, {}", t.file, t.width, t.height, t.color_space.empty() ? "data" : t.color_space);
  return out;
}

std::string text_of(const Feature& f) {
  if (f.required) return f.name;
  return fmt::format("{} ({})", f.name, f.note);
}

std::vector<std::pair<std::string, std::uint64_t>> count_materials(const compile::CompiledScene& compiled) {
  const std::vector<scene::MaterialType>& types = scene::material_types();  // in the order of MaterialKind
  std::vector<std::uint64_t> counts(types.size());
  for (const kernel::Material& m : compiled.materials) ++counts[static_cast<std::size_t>(m.kind)];
  std::vector<std::pair<std::string, std::uint64_t>> out;
  for (std::size_t i = 0; i < counts.size(); ++i)
    if (counts[i] > 0) out.emplace_back(types[i].name, counts[i]);
  return out;
}

}  // namespace

// Called by the JSON library.

static void to_json(json& out, const PointsInfo& p) {
  out = {{"file", p.file}, {"spheres", p.spheres}, {"bonds", p.bonds}, {"unused", p.unused}};
}

static void to_json(json& out, const TextureInfo& t) {
  out = {{"key", t.key}, {"type", t.type}};
  if (t.width > 0)
    out.update({{"file", t.file}, {"width", t.width}, {"height", t.height}, {"color_space", t.color_space}});
}

static void to_json(json& out, const Feature& f) {
  out = {{"name", f.name}, {"required", f.required}, {"note", f.note}};
}

SceneInfo scene_info(const load::SceneRequest& request) {
  job::PreparedScene prepared;
  return scene_info(request, prepared);
}

SceneInfo scene_info(const load::SceneRequest& request, job::PreparedScene& prepared) {
  load::SceneRequest with_any_background = request;
  with_any_background.skips_large_background = true;
  const load::LoadedScene& loaded = prepared.load(with_any_background);
  const load::ReadResult& read = loaded.read;
  const compile::CompiledScene& compiled = prepared.compile(request.memory_limit);
  const film::LayerRequest layers = job::choose_layers(read.scene, compiled).request;
  SceneInfo info;
  info.scene_hash = prepared.hashes().of_image;
  info.frame = request.source.frame;
  info.width = compiled.width;
  info.height = compiled.height;
  info.samples = compiled.samples;
  info.max_depth = static_cast<int>(compiled.max_depth);
  info.spheres = compiled.spheres.size();
  info.rods = compiled.rod_count();
  info.bounds = compile::bounds_of(compiled);
  if (info.spheres + info.rods > 0) {
    info.smallest_radius = std::numeric_limits<double>::infinity();
    const auto add_radius = [&](double radius) {
      info.smallest_radius = std::min(info.smallest_radius, radius);
      info.largest_radius = std::max(info.largest_radius, radius);
    };
    for (std::size_t i = 0; i < compiled.spheres.size(); ++i) add_radius(compiled.spheres[i].radius);
    const kernel::RodArray rods = compiled.view().rods;
    for (std::size_t i = 0; i < rods.count; ++i) add_radius(rods[i].radius);
  }
  info.materials = count_materials(compiled);
  info.emitters = count_emitters(compiled);
  info.lights = lights_text(compiled, info.emitters);
  info.caustics = caustics_text(read.scene, compiled);
  for (std::size_t i = 0; i < read.scene.points.size(); ++i) {
    const scene::Points& p = read.scene.points[i];
    info.points.push_back({p.file.string(), compiled.points_sizes[i], p.unused,
                           compiled.stub_counts[i] + compiled.bond_counts[i] - p.arrow_count});
  }
  info.layers = scene::requested_layers(read.scene);
  info.available_layers = scene::available_layers(read.scene);
  info.features = features_of(compiled, layers.any());
  info.settings = read.settings;
  for (const load::Setting& s : read.settings) {
    if (s.key == "render.precision") info.precision = scene::unquoted(s.value);
    if (s.key == "render.accelerator") info.accelerator = scene::unquoted(s.value);
  }
  info.isa = kernel::isa_name();
  const bool is_in_bvh = accel::objects_in_bvh(compiled.view()).all() > 0;
  info.traversal = compiled.accelerator == compile::Accelerator::kList || info.spheres + info.rods == 0
                       ? "list"
                       : accel::name_of(accel::fastest_traversals(compiled.view(), is_in_bvh));
  job::MemoryUse use;
  // A background that has not been read may differ from pixel to pixel.
  if (!loaded.background) use.share_with_objects = render::share_with_objects(compiled, layers, job::default_threads());
  info.memory = job::estimate_memory(compiled, layers, use);
  if (loaded.background) {
    info.memory.background = loaded.background->bytes;
    if (!loaded.background->image) info.scene_hash.clear();  // it depends on the pixels, which were not read
    const bool is_sky = read.scene.background.type == scene::BackgroundType::kSky;
    info.background_file = is_sky ? "sky" : read.scene.background.file.string();
    info.background = loaded.background;
  }
  info.memory.textures = 0;
  for (const load::LoadedTexture& texture : loaded.textures) {
    if (!texture.is_shared) info.memory.textures += texture.map.bytes;
    if (!texture.map.image) info.scene_hash.clear();
  }
  info.textures = texture_infos(read.scene, loaded.textures);
  info.warnings = loaded.warnings;
  for (const std::string& advice : precision_advice(compiled)) {
    info.warnings.push_back(base::file_diagnostic(base::Severity::kWarning, request.source.file.string(), advice));
  }
  return info;
}

std::string info_text(const SceneInfo& info) {
  using job::add_row;
  std::string out;
  add_row(out, "scene", "{}", info.scene_hash.empty() ? "unknown" : info.scene_hash);
  add_row(out, "frame", "{}", info.frame);
  add_row(out, "image", "{} x {}, {} samples per pixel, max depth {}", info.width, info.height, info.samples,
          info.max_depth);
  const auto& [low, high] = info.bounds;
  const std::string extent =
      fmt::format(", radius {:g} .. {:g}, from ({:g}, {:g}, {:g}) to ({:g}, {:g}, {:g})", info.smallest_radius,
                  info.largest_radius, low.x, low.y, low.z, high.x, high.y, high.z);
  add_row(out, "spheres", "{}{}", info.spheres, info.spheres > 0 && info.rods == 0 ? extent : "");
  if (info.rods > 0) add_row(out, "rods", "{}{}", info.rods, extent);
  std::vector<std::string> materials;
  for (const auto& [name, count] : info.materials) materials.push_back(fmt::format("{} {}", count, name));
  add_row(out, "materials", "{}", materials.empty() ? "none" : base::joined(materials));
  for (const PointsInfo& p : info.points) add_row(out, &p == &info.points[0] ? "points" : "", "{}", text_of(p));
  if (info.background)
    add_row(out, "background", "{}: {} x {}, {}", info.background_file, info.background->width, info.background->height,
            info.background->color_space);
  for (const TextureInfo& texture : info.textures) add_row(out, "texture", "{}", text_of(texture));
  if (!info.lights.empty()) add_row(out, "lights", "{}", info.lights);
  if (!info.caustics.empty()) add_row(out, "caustics", "{}", info.caustics);
  add_row(out, "layers", "{}; available: {}", info.layers.empty() ? "none" : base::joined(info.layers),
          base::joined(info.available_layers));
  add_row(out, "kernel", "{}, precision {}, accelerator {}", info.isa, info.precision, info.accelerator);
  add_row(out, "traversal", "{}", info.traversal);
  add_row(out, "memory", "about {}: {}", base::bytes_text(info.memory.total()), job::text_of(info.memory));
  std::vector<std::string> required, unused;
  for (const Feature& f : info.features) (f.required ? required : unused).push_back(text_of(f));
  add_row(out, "requires", "{}", required.empty() ? "none" : base::joined(required));
  add_row(out, "unused", "{}", unused.empty() ? "none" : base::joined(unused, "; "));
  return out;
}

std::string settings_text(const SceneInfo& info) {
  std::string out;
  for (const load::Setting& s : info.settings) out += fmt::format("{:26} {:24} {}\n", s.key, s.value, s.origin);
  return out;
}

std::string info_json(const SceneInfo& info) {
  json settings = json::array(), materials = json::object(), warnings = json::array(), background, bounds, radius;
  for (const load::Setting& s : info.settings)
    settings.push_back({{"key", s.key}, {"value", s.value}, {"origin", s.origin}});
  for (const auto& [name, count] : info.materials) materials[name] = count;
  for (const base::Diagnostic& w : info.warnings)
    warnings.push_back({{"file", w.file}, {"line", w.line}, {"column", w.column}, {"text", w.text}});
  if (info.background)
    background = {{"file", info.background_file},
                  {"width", info.background->width},
                  {"height", info.background->height},
                  {"color_space", info.background->color_space}};
  if (info.spheres + info.rods > 0) {
    const auto& [low, high] = info.bounds;
    bounds = {{"lower", {low.x, low.y, low.z}}, {"upper", {high.x, high.y, high.z}}};
    radius = {{"smallest", info.smallest_radius}, {"largest", info.largest_radius}};
  }
  return job::json_text({{"schema", "orrery.info/1"},
                         {"scene_hash", info.scene_hash.empty() ? json() : json(info.scene_hash)},
                         {"frame", info.frame},
                         {"width", info.width},
                         {"height", info.height},
                         {"samples", info.samples},
                         {"max_depth", info.max_depth},
                         {"spheres", info.spheres},
                         {"rods", info.rods},
                         {"bounds", bounds},
                         {"radius", radius},
                         {"materials", materials},
                         {"emitters", info.emitters},
                         {"caustics", info.caustics},
                         {"points", info.points},
                         {"layers", {{"requested", info.layers}, {"available", info.available_layers}}},
                         {"features", info.features},
                         {"precision", info.precision},
                         {"accelerator", info.accelerator},
                         {"isa", info.isa},
                         {"traversal", info.traversal},
                         {"memory_bytes",
                          {{"film", info.memory.film},
                           {"spheres", info.memory.spheres},
                           {"accelerator", info.memory.accelerator},
                           {"background", info.memory.background},
                           {"textures", info.memory.textures},
                           {"lights", info.memory.lights}}},
                         {"background", background},
                         {"textures", info.textures},
                         {"settings", settings},
                         {"warnings", warnings}});
}

}  // namespace orrery::info
