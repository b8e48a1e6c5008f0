// SPDX-License-Identifier: Apache-2.0
#include "scene/schema.h"

#include <charconv>
#include <cstdio>
#include <limits>

#include "scene/limits.h"

namespace orrery::scene {
namespace {

constexpr Range kAnyLength{-kLargestLength, kLargestLength};
constexpr Range kUnit{0, 1};
constexpr Range kLight{0, kBrightestBackground};

/// A key for a member that `at` finds in its target.
template <class Target, class At>
Key<Target> integer(const char* name, Range range, const char* unit, At at) {
  return {name, ValueType::kInteger, range, {}, unit, false,
          [at](Target& t, const Value& v) {
            using Member = std::remove_reference_t<decltype(at(t))>;
            at(t) = static_cast<Member>(std::get<std::int64_t>(v));
          },
          [at](const Target& t) { return std::to_string(at(const_cast<Target&>(t))); }};
}
template <class Target, class At>
Key<Target> number(const char* name, Range range, const char* unit, At at, bool required = false) {
  return {name, ValueType::kNumber, range, {}, unit, required,
          [at](Target& t, const Value& v) { at(t) = std::get<double>(v); },
          [at](const Target& t) { return number_text(at(const_cast<Target&>(t))); }};
}
template <class Target, class At>
Key<Target> vector(const char* name, Range range, const char* unit, At at, bool required = false) {
  return {name, ValueType::kVector, range, {}, unit, required,
          [at](Target& t, const Value& v) { at(t) = std::get<Vec3d>(v); },
          [at](const Target& t) { return vector_text(at(const_cast<Target&>(t))); }};
}
template <class Target, class At>
Key<Target> text(const char* name, At at, bool required = false) {
  return {name, ValueType::kText, {}, {}, "", required,
          [at](Target& t, const Value& v) { at(t) = std::get<std::string>(v); },
          [at](const Target& t) { return string_text(at(const_cast<Target&>(t))); }};
}
/// Choices stand in the order of the enumerators.
template <class Target, class At>
Key<Target> choice(const char* name, std::vector<std::string> choices, At at) {
  return {name, ValueType::kChoice, {}, choices, "", false,
          [at, choices](Target& t, const Value& v) {
            using Enum = std::remove_reference_t<decltype(at(t))>;
            for (std::size_t i = 0; i < choices.size(); ++i)
              if (choices[i] == std::get<std::string>(v)) at(t) = static_cast<Enum>(i);
          },
          [at, choices](const Target& t) {
            return string_text(choices[static_cast<std::size_t>(at(const_cast<Target&>(t)))]);
          }};
}

/// focus_distance has a default that depends on the camera.
Key<Scene> focus_distance_key() {
  Key<Scene> key = number<Scene>("focus_distance", {0, kLargestLength, true, false}, "scene units",
                                 [](Scene& s) -> double& { return s.camera.focus_distance.emplace(); });
  key.set = [](Scene& s, const Value& v) { s.camera.focus_distance = std::get<double>(v); };
  key.text = [](const Scene& s) {
    return s.camera.focus_distance ? number_text(*s.camera.focus_distance) : "distance to look_at";
  };
  return key;
}

std::vector<Table> make_tables() {
  using S = Scene;
  const double int_max = std::numeric_limits<std::int32_t>::max();
  return {
      {"image",
       {integer<S>("width", {1, kLargestSide}, "px", [](S& s) -> int& { return s.image.width; }),
        integer<S>("height", {1, kLargestSide}, "px", [](S& s) -> int& { return s.image.height; })}},
      {"camera",
       {vector<S>("look_from", kAnyLength, "scene units", [](S& s) -> Vec3d& { return s.camera.look_from; }),
        vector<S>("look_at", kAnyLength, "scene units", [](S& s) -> Vec3d& { return s.camera.look_at; }),
        vector<S>("up", kAnyLength, "any length", [](S& s) -> Vec3d& { return s.camera.up; }),
        number<S>("vfov", {0, 180, true, true}, "degrees", [](S& s) -> double& { return s.camera.vfov; }),
        number<S>("defocus_angle", {0, 180, false, true}, "degrees",
                  [](S& s) -> double& { return s.camera.defocus_angle; }),
        focus_distance_key()}},
      {"background",
       {choice<S>("type", {"gradient", "constant"}, [](S& s) -> BackgroundType& { return s.background.type; }),
        vector<S>("bottom", kLight, "scene-linear", [](S& s) -> Vec3d& { return s.background.bottom; }),
        vector<S>("top", kLight, "scene-linear", [](S& s) -> Vec3d& { return s.background.top; }),
        vector<S>("color", kLight, "scene-linear", [](S& s) -> Vec3d& { return s.background.color; })}},
      {"render",
       {integer<S>("samples", {1, int_max}, "per pixel", [](S& s) -> int& { return s.render.samples; }),
        integer<S>("max_depth", {0, kDeepestPath}, "scattering events",
                   [](S& s) -> int& { return s.render.max_depth; }),
        integer<S>("seed", {0, std::numeric_limits<std::uint32_t>::max()}, "",
                   [](S& s) -> std::uint32_t& { return s.render.seed; }),
        choice<S>("precision", {"exact", "fast", "book"}, [](S& s) -> Precision& { return s.render.precision; }),
        choice<S>("shading", {"path", "normal", "flat"}, [](S& s) -> Shading& { return s.render.shading; }),
        choice<S>("accelerator", {"embree", "list"}, [](S& s) -> Accelerator& { return s.render.accelerator; })}},
      {"color", {text<S>("space", [](S& s) -> std::string& { return s.color.space; })}},
  };
}

std::vector<MaterialType> make_material_types() {
  using M = MaterialModel;
  return {
      {"lambertian", Lambertian{}, {vector<M>("albedo", kUnit, "scene-linear", [](M& m) -> Vec3d& { return std::get<Lambertian>(m).albedo; }, true)}},
      {"hemisphere", Hemisphere{}, {vector<M>("albedo", kUnit, "scene-linear", [](M& m) -> Vec3d& { return std::get<Hemisphere>(m).albedo; }, true)}},
      {"metal",
       Metal{},
       {vector<M>("albedo", kUnit, "scene-linear", [](M& m) -> Vec3d& { return std::get<Metal>(m).albedo; }, true),
        number<M>("fuzz", kUnit, "", [](M& m) -> double& { return std::get<Metal>(m).fuzz; })}},
      {"dielectric",
       Dielectric{},
       {number<M>("ior", {1e-6, 1e6}, "relative to what is around", [](M& m) -> double& { return std::get<Dielectric>(m).ior; }),
        choice<M>("fresnel", {"schlick", "exact", "none"},
                  [](M& m) -> Fresnel& { return std::get<Dielectric>(m).fresnel; })}},
  };
}

}  // namespace

std::string Range::text() const {
  if (!from_open && !to_open) return number_text(from) + ".." + number_text(to);
  return std::string(from_open ? "above " : "from ") + number_text(from) + (to_open ? ", below " : ", up to ") +
         number_text(to);
}

const std::vector<Table>& tables() {
  static const std::vector<Table> all = make_tables();
  return all;
}

const std::vector<MaterialType>& material_types() {
  static const std::vector<MaterialType> all = make_material_types();
  return all;
}

const std::vector<Key<Sphere>>& sphere_keys() {
  static const std::vector<Key<Sphere>> keys = {
      vector<Sphere>("center", kAnyLength, "scene units", [](Sphere& s) -> Vec3d& { return s.center; }, true),
      number<Sphere>("radius", kAnyLength, "scene units", [](Sphere& s) -> double& { return s.radius; }, true),
      text<Sphere>("name", [](Sphere& s) -> std::string& { return s.name; })};
  return keys;
}

const std::vector<Key<Points>>& points_keys() {
  static const std::vector<Key<Points>> keys = [] {
    Key<Points> file = text<Points>("file", [](Points& p) -> std::filesystem::path& { return p.file; }, true);
    file.text = [](const Points& p) { return string_text(p.file.string()); };
    Key<Points> radius = number<Points>("radius", {kSmallestRadius, kLargestLength}, "scene units",
                                        [](Points& p) -> double& { return p.radius.emplace(); });
    radius.set = [](Points& p, const Value& v) { p.radius = std::get<double>(v); };
    radius.text = [](const Points& p) { return p.radius ? number_text(*p.radius) : "as in the file"; };
    return std::vector<Key<Points>>{file, radius};
  }();
  return keys;
}

std::string number_text(double value) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof(buffer), value).ptr;
  return {buffer, end};
}

std::string vector_text(Vec3d v) {
  std::string out = "[";
  out.append(number_text(v.x)).append(", ").append(number_text(v.y)).append(", ").append(number_text(v.z));
  return out.append("]");
}

std::string string_text(const std::string& value) {
  std::string out = "\"";
  for (const char c : value) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (byte < 0x20 || byte == 0x7f) {
      char escape[8];
      std::snprintf(escape, sizeof(escape), "\\u%04x", byte);
      out += escape;
    } else {
      out += c;
    }
  }
  return out + '"';
}

std::string unquoted(const std::string& text) {
  return text.size() >= 2 && text.front() == '"' ? text.substr(1, text.size() - 2) : text;
}

}  // namespace orrery::scene
