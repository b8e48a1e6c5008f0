// SPDX-License-Identifier: Apache-2.0
#include "info/info.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "compile/compiled_scene.h"
#include "compile/emitters.h"
#include "compile/environment.h"
#include "film/layer_film.h"
#include "format/read_scene.h"
#include "job/layers.h"
#include "job/prepared_scene.h"
#include "job/statistics.h"
#include "kernel/isa.h"
#include "kernel/lights.h"
#include "load/load_scene.h"
#include "load/load_textures.h"
#include "scene/layers.h"
#include "scene/schema.h"
#include "scene/texture.h"
#include "scene/value_text.h"
#include "study/bench.h"

namespace orrery::info {
namespace {

/// Describes how an image background is sampled: "sky by texels above the mean and the sun (87 %)"; empty if it is not.
std::string environment_text(const compile::CompiledScene& compiled) {
  if (!compiled.environment || !compiled.environment->view().is_sampled) return {};
  const kernel::Environment& view = compiled.environment->view();
  std::string out;
  if (view.map_density > 0) out = view.weight_offset > 0 ? "texels above the mean" : "all texels";
  if (view.sun_probability > 0) {
    if (!out.empty()) out += " and ";
    base::append(out, "the sun (%.3g %%)", view.sun_probability * 100);
  }
  return out;
}

/// Returns the number of emitters that are rendered, without those that are black. Of coincident spheres, only the
/// first is rendered.
std::uint64_t count_emitters(const compile::CompiledScene& compiled) {
  if (compiled.emission.empty()) return 0;
  std::vector<bool> shines;
  for (const kernel::Emission& e : compiled.emission)
    shines.push_back(e.radiance[0] > 0 || e.radiance[1] > 0 || e.radiance[2] > 0);
  std::vector<std::uint32_t> ids;
  for (std::size_t i = 0; i < compiled.spheres.size(); ++i)
    if (shines[compiled.sphere_materials[i]]) ids.push_back(static_cast<std::uint32_t>(i));
  std::uint64_t rods = 0;
  for (std::size_t i = compiled.spheres.size(); i < compiled.sphere_materials.size(); i += 2)
    rods += shines[compiled.sphere_materials[i]] || shines[compiled.sphere_materials[i + 1]] ? 1 : 0;
  return rods + compile::without_coincident(compiled.view(), compiled.precision, std::move(ids)).size();
}

/// Describes how light is sampled: "40 emitters; light and BSDF sampling; emitters by a light tree of 1.9 KiB". Empty
/// without emitters and image background.
///
/// `count`    number of emitters
std::string lights_text(const compile::CompiledScene& compiled, std::uint64_t count) {
  if (count == 0 && !compiled.environment) return {};
  std::vector<std::string> lights;
  if (count > 0) lights.push_back(fmt::format("{} emitter{}", count, count == 1 ? "" : "s"));
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

/// Describes which pairs of a sharp ball and a light are sampled: "2 of 3 pairs of a ball and a light sampled:
/// sphere[1] and sphere[3], sphere[1] and the sun". Empty if there is no pair, or lights are not sampled.
std::string caustics_text(const compile::CompiledScene& compiled) {
  const compile::CausticList& list = compiled.caustics;
  if (!compiled.samples_caustics || list.pairs == 0) return {};
  std::size_t tables = compiled.spheres.size(), listed = 0;
  for (const std::size_t size : compiled.points_sizes) tables -= size;
  const auto name = [&](std::uint32_t id) {
    if (id == kernel::kNoSphere) return std::string("the sun");
    return id < tables ? fmt::format("sphere[{}]", id) : fmt::format("particle {}", id - tables);
  };
  std::string names;
  for (const kernel::CausticBall& ball : list.balls)
    for (std::uint32_t i = ball.begin; i < ball.end; ++i)
      if (++listed <= kNamedPairs)
        names += fmt::format("{} {} and {}", listed == 1 ? ":" : ",", name(ball.sphere), name(list.lights[i].id));
  return fmt::format("{} of {} pair{} of a ball and a light sampled{}{}", listed, list.pairs,
                     list.pairs == 1 ? "" : "s", names, listed > kNamedPairs ? ", ..." : "");
}

std::vector<Feature> features_of(const compile::CompiledScene& compiled, bool has_layers) {
  const auto some = [&](auto holds) {
    return std::any_of(compiled.materials.begin(), compiled.materials.end(), holds);
  };
  const auto of = [&](kernel::MaterialKind kind) {
    return some([kind](const kernel::Material& m) { return m.kind == kind; });
  };
  const auto feature = [](const char* name, bool required, const char* why_not, const char* why = "") {
    return Feature{name, required, required ? why : why_not};
  };
  return {
      feature("thin lens", compiled.features.lens, "pinhole camera: no lens sampling",
              "camera.defocus_angle is above 0"),
      feature("lambertian", of(kernel::MaterialKind::kLambertian), "not used by any sphere"),
      feature("hemisphere", of(kernel::MaterialKind::kHemisphere), "not used by any sphere"),
      feature("metal", of(kernel::MaterialKind::kMetal), "not used by any sphere"),
      feature("fuzz", some([](const kernel::Material& m) { return m.fuzz > 0; }), "no material has fuzz above 0"),
      feature("dielectric", of(kernel::MaterialKind::kDielectric), "no glass: no Fresnel term, no refraction"),
      feature("plastic", of(kernel::MaterialKind::kPlastic), "not used by any sphere"),
      feature("gradient sky", compiled.features.sky, "no gradient: independent of direction"),
      feature("image background", compiled.environment != nullptr, "no image: no texture lookups"),
      feature("textures", !compiled.textures.textures().empty(), "all materials are constant"),
      feature("motion blur", compiled.features.motion, "nothing moves while the shutter is open",
              "camera, spheres or rods move while the shutter is open"),
      feature("opacity", compiled.features.opacity, "all objects are opaque", "some objects have an opacity below 1"),
      feature("lights", compiled.features.lit, "no emitters: no shadow rays"),
      feature("layers", has_layers, "none requested: paths are not recorded"),
      feature("light paths", compiled.shading == kernel::Shading::kPath, "render.shading uses the first hit only")};
}

/// Describes the textures of a scene.
std::vector<TextureInfo> texture_infos(const scene::Scene& scene, const std::vector<load::LoadedTexture>& loaded) {
  std::vector<TextureInfo> out;
  std::size_t next = 0;
  for (const scene::NamedTexture& named : scene::textures(scene)) {
    TextureInfo info;
    info.key = named.key;
    info.type = scene::texture_types(named.use)[static_cast<std::size_t>(named.texture->type)].name;
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

/// Whether the properties include colours under the names used by scanners and point cloud tools.
bool has_colors(const std::vector<std::string>& properties) {
  static const std::vector<std::vector<std::string>> known = {
      {"red", "green", "blue"}, {"r", "g", "b"}, {"diffuse_red", "diffuse_green", "diffuse_blue"}};
  return std::any_of(known.begin(), known.end(), [&](const std::vector<std::string>& names) {
    return std::all_of(names.begin(), names.end(), [&](const auto& name) { return base::contains(properties, name); });
  });
}

std::string points_text(const std::vector<PointsInfo>& points) {
  std::string out;
  for (const PointsInfo& p : points) {
    base::append(out, "%s %s: %llu %s", out.empty() ? "points     " : "           ", p.file.c_str(),
                 static_cast<unsigned long long>(p.spheres), p.spheres == 1 ? "sphere" : "spheres");
    if (p.bonds > 0) base::append(out, ", %llu rods of bonds", static_cast<unsigned long long>(p.bonds));
    if (!p.unused.empty()) base::append(out, "; unused: %s", base::joined(p.unused).c_str());
    if (has_colors(p.unused)) out += "; point colours are ignored, materials set the colours";
    out += '\n';
  }
  return out;
}

std::vector<std::pair<std::string, std::uint64_t>> count_materials(const compile::CompiledScene& compiled) {
  static constexpr std::array kNames = {"lambertian", "hemisphere", "metal", "dielectric", "emitter", "plastic"};
  std::array<std::uint64_t, kNames.size()> counts{};
  for (const kernel::Material& m : compiled.materials) ++counts[static_cast<std::size_t>(m.kind)];
  std::vector<std::pair<std::string, std::uint64_t>> out;
  for (std::size_t i = 0; i < counts.size(); ++i)
    if (counts[i] > 0) out.emplace_back(kNames[i], counts[i]);
  return out;
}

}  // namespace

SceneInfo scene_info(const load::SceneRequest& request) {
  job::PreparedScene prepared;
  return scene_info(request, prepared);
}

SceneInfo scene_info(const load::SceneRequest& request, job::PreparedScene& prepared) {
  load::SceneRequest with_any_background = request;
  with_any_background.skips_large_background = true;
  const load::LoadedScene& loaded = prepared.load(with_any_background);
  const format::ReadResult& read = loaded.read;
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
  const auto [low, high] = compile::bounds_of(compiled);
  std::copy_n(std::array{low.x, low.y, low.z}.begin(), 3, info.lower);
  std::copy_n(std::array{high.x, high.y, high.z}.begin(), 3, info.upper);
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
  info.caustics = caustics_text(compiled);
  for (std::size_t i = 0; i < read.scene.points.size(); ++i) {
    const scene::Points& p = read.scene.points[i];
    info.points.push_back({p.file.string(), compiled.points_sizes[i], p.unused,
                           compiled.stub_counts[i] + compiled.bond_counts[i] - p.arrow_count});
  }
  info.layers = scene::requested_layers(read.scene);
  info.available_layers = scene::available_layers(read.scene);
  info.features = features_of(compiled, layers.any());
  for (const format::Setting& s : read.settings) {
    info.settings.push_back({s.key, s.value, s.origin});
    if (s.key == "render.precision") info.precision = scene::unquoted(s.value);
    if (s.key == "render.accelerator") info.accelerator = scene::unquoted(s.value);
  }
  info.isa = kernel::isa_name();
  info.traversal = compiled.accelerator == compile::Accelerator::kList || info.spheres + info.rods == 0
                       ? "list"
                       : "packet or single, the faster in the first rays";
  job::MemoryNeeds needs = job::memory_needs(compiled, layers);
  if (loaded.background) {
    needs.background = loaded.background->bytes;
    if (!loaded.background->image) info.scene_hash.clear();  // it depends on the pixels, which were not read
    const bool is_sky = read.scene.background.type == scene::BackgroundType::kSky;
    info.background_file = is_sky ? "sky" : read.scene.background.file.string();
    info.background = loaded.background;
  }
  needs.textures = 0;
  for (const load::LoadedTexture& texture : loaded.textures) {
    if (!texture.is_shared) needs.textures += texture.map.bytes;
    if (!texture.map.image) info.scene_hash.clear();
  }
  info.textures = texture_infos(read.scene, loaded.textures);
  info.memory = job::estimate_memory(needs);
  info.warnings = loaded.warnings;
  for (const std::string& advice : precision_advice(compiled)) {
    info.warnings.push_back(base::file_diagnostic(base::Severity::kWarning, request.source.file.string(), advice));
  }
  return info;
}

void measure_savings(const load::SceneRequest& request, SceneInfo& info) {
  study::BenchRequest bench;
  bench.scene = request.source;
  for (const study::FeatureCost& cost : study::bench_features(bench))
    for (Feature& feature : info.features)
      if (feature.name == cost.name && !cost.required) feature.saves = cost.saves;
}

std::string info_text(const SceneInfo& info) {
  std::string out;
  base::append(out, "scene       %s\n", info.scene_hash.empty() ? "unknown" : info.scene_hash.c_str());
  base::append(out, "frame       %d\n", info.frame);
  base::append(out, "image       %d x %d, %d samples per pixel, max depth %d\n", info.width, info.height, info.samples,
               info.max_depth);
  base::append(out, "spheres     %llu", static_cast<unsigned long long>(info.spheres));
  if (info.rods > 0) base::append(out, "\nrods        %llu", static_cast<unsigned long long>(info.rods));
  if (info.spheres + info.rods > 0)
    base::append(out, ", radius %g .. %g, from (%g, %g, %g) to (%g, %g, %g)", info.smallest_radius, info.largest_radius,
                 info.lower[0], info.lower[1], info.lower[2], info.upper[0], info.upper[1], info.upper[2]);
  out += info.materials.empty() ? "\nmaterials   none" : "\nmaterials  ";
  for (std::size_t i = 0; i < info.materials.size(); ++i)
    base::append(out, "%s %llu %s", i == 0 ? "" : ",", static_cast<unsigned long long>(info.materials[i].second),
                 info.materials[i].first.c_str());
  out += '\n' + points_text(info.points);
  if (info.background)
    base::append(out, "background  %s: %d x %d, %s\n", info.background_file.c_str(), info.background->width,
                 info.background->height, info.background->color_space.c_str());
  for (const TextureInfo& texture : info.textures) {
    base::append(out, "texture     %s: %s", texture.key.c_str(), texture.type.c_str());
    if (texture.width > 0)
      base::append(out, ", %s: %d x %d, %s", texture.file.c_str(), texture.width, texture.height,
                   texture.color_space.empty() ? "data" : texture.color_space.c_str());
    out += '\n';
  }
  if (!info.lights.empty()) base::append(out, "lights      %s\n", info.lights.c_str());
  if (!info.caustics.empty()) base::append(out, "caustics    %s\n", info.caustics.c_str());
  base::append(out, "layers      %s; available: %s\n", info.layers.empty() ? "none" : base::joined(info.layers).c_str(),
               base::joined(info.available_layers).c_str());
  base::append(out, "kernel      %s, precision %s, accelerator %s\n", info.isa.c_str(), info.precision.c_str(),
               info.accelerator.c_str());
  base::append(out, "traversal   %s\n", info.traversal.c_str());
  base::append(out, "memory      about %s: %s\n", base::bytes_text(info.memory.total()).c_str(),
               job::text_of(info.memory).c_str());
  for (const bool required : {true, false}) {
    out += required ? "requires   " : "unused     ";
    bool first = true;
    for (const Feature& f : info.features) {
      if (f.required != required) continue;
      base::append(out, "%s %s", first ? "" : (required ? "," : ";"), f.name.c_str());
      if (!required && !f.note.empty()) base::append(out, " (%s", f.note.c_str());
      if (f.saves) base::append(out, "; saves %.1f %% of the time", *f.saves * 100);
      if (!required && !f.note.empty()) out += ')';
      first = false;
    }
    out += first ? " none\n" : "\n";
  }
  return out;
}

std::string settings_text(const SceneInfo& info) {
  std::string out;
  for (const auto& s : info.settings)
    base::append(out, "%-26s %-24s %s\n", s.key.c_str(), s.value.c_str(), s.origin.c_str());
  return out;
}

std::string info_json(const SceneInfo& info) {
  using nlohmann::json;
  json features = json::array(), settings = json::array(), materials = json::object(), warnings = json::array();
  json points = json::array(), textures = json::array();
  for (const TextureInfo& t : info.textures) {
    textures.push_back({{"key", t.key}, {"type", t.type}});
    if (t.width > 0)
      textures.back().update(
          {{"file", t.file}, {"width", t.width}, {"height", t.height}, {"color_space", t.color_space}});
  }
  for (const PointsInfo& p : info.points)
    points.push_back({{"file", p.file},
                      {"spheres", p.spheres},
                      {"bonds", p.bonds},
                      {"unused", p.unused},
                      {"unused_colors", has_colors(p.unused)}});
  for (const Feature& f : info.features)
    features.push_back({{"name", f.name},
                        {"required", f.required},
                        {"note", f.note},
                        {"saves", f.saves ? json(*f.saves) : json(nullptr)}});
  for (const auto& s : info.settings) settings.push_back({{"key", s.key}, {"value", s.value}, {"origin", s.origin}});
  for (const auto& [name, count] : info.materials) materials[name] = count;
  for (const base::Diagnostic& w : info.warnings)
    warnings.push_back({{"file", w.file}, {"line", w.line}, {"column", w.column}, {"text", w.text}});
  json out = {{"schema", "orrery.info/1"},
              {"scene_hash", info.scene_hash.empty() ? json(nullptr) : json(info.scene_hash)},
              {"frame", info.frame},
              {"width", info.width},
              {"height", info.height},
              {"samples", info.samples},
              {"max_depth", info.max_depth},
              {"spheres", info.spheres},
              {"rods", info.rods},
              {"bounds", nullptr},
              {"radius", nullptr},
              {"materials", materials},
              {"emitters", info.emitters},
              {"caustics", info.caustics},
              {"points", points},
              {"layers", {{"requested", info.layers}, {"available", info.available_layers}}},
              {"features", features},
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
              {"background", nullptr},
              {"textures", textures},
              {"settings", settings},
              {"warnings", warnings}};
  if (info.background)
    out["background"] = {{"file", info.background_file},
                         {"width", info.background->width},
                         {"height", info.background->height},
                         {"color_space", info.background->color_space}};
  if (info.spheres + info.rods > 0) {
    out["bounds"] = {{"lower", info.lower}, {"upper", info.upper}};
    out["radius"] = {{"smallest", info.smallest_radius}, {"largest", info.largest_radius}};
  }
  return job::json_text(out);
}

}  // namespace orrery::info
