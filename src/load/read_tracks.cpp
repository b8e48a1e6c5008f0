// SPDX-License-Identifier: Apache-2.0
#include "load/read_keys.h"

#include <algorithm>
#include <utility>

#include <fmt/core.h>

#include "base/text.h"
#include "scene/animation.h"
#include "scene/limits.h"

namespace orrery::load {
namespace {

using scene::Track;
using scene::ValueType;

/// Returns the list of a key; null, and an error is reported, if it is missing, empty or not a list.
const toml::array* list_at(ReadState& state, const toml::table& table, const std::string& full_name, const char* key) {
  const toml::node* node = table.get(key);
  const toml::array* list = node == nullptr ? nullptr : node->as_array();
  if (list != nullptr && !list->empty()) return list;
  const std::string what = full_name + (node == nullptr ? fmt::format(" needs `{}`", key)
                                                        : fmt::format(".{} must be a non-empty list", key));
  state.error(node == nullptr ? place_of(table) : place_of(*node), what);
  return nullptr;
}

bool read_frames(ReadState& state, const toml::array& list, const std::string& name, std::vector<double>& frames) {
  bool good = true;
  for (const toml::node& node : list) {
    const auto value = read_value(state, node, name, ValueType::kNumber, {-scene::kMaxFrame, scene::kMaxFrame}, {});
    const double frame = value ? std::get<double>(*value) : 0;
    if (value && !frames.empty() && good && frame <= frames.back()) {
      state.error(place_of(node), fmt::format("{} must ascend: {} follows {}", name, scene::number_text(frame),
                                              scene::number_text(frames.back())));
      good = false;
    }
    good = good && value.has_value();
    frames.push_back(frame);
  }
  return good;
}

bool read_values(ReadState& state, const toml::array& list, const std::string& name, const scene::Animated& target,
                 std::vector<math::Vec3d>& values) {
  bool good = true;
  for (const toml::node& node : list) {
    const auto value = read_value(state, node, name, target.type, target.range, {});
    good = good && value.has_value();
    if (!value) continue;
    values.push_back(target.type == ValueType::kVector ? std::get<math::Vec3d>(*value)
                                                       : math::Vec3d{std::get<double>(*value), 0, 0});
  }
  return good;
}

/// Reads the target of a track and its name; nullopt, and an error is reported, if it is invalid.
std::optional<scene::Animated> read_target(ReadState& state, const toml::table& table, const std::string& full_name,
                                           const scene::Scene& scene, std::string& name) {
  const toml::node* node = table.get("target");
  if (node == nullptr) {
    state.error(place_of(table), full_name + " needs `target`", "as in target = \"camera.look_from\"");
    return {};
  }
  const auto value = read_value(state, *node, full_name + ".target", ValueType::kText, {}, {});
  if (!value) return {};
  name = std::get<std::string>(*value);
  auto target = scene::find_animated(scene, name);
  if (const auto all = scene::indexed_targets(scene, name); all.size() > 1) {
    state.error(
        place_of(*node),
        fmt::format("{}.target: \"{}\" matches {} {}s", full_name, name, all.size(), name.substr(0, name.find('.'))),
        fmt::format("use an index, such as {} or {}", all[0], all[1]));
    return {};
  }
  if (target) return target;
  const std::vector<std::string> names = scene::animated_names(scene);
  if (base::contains(names, name)) {
    state.error(place_of(*node), fmt::format("{}.target: \"{}\" has a texture and cannot be animated", full_name, name),
                "animate a number of the material that has no texture");
    return {};
  }
  std::string remedy = base::did_you_mean(name, names);
  if (remedy.empty())
    remedy =
        "targets are numbers of camera, background, material.NAME, sphere.NAME, sphere[INDEX], rod.NAME and rod[INDEX]";
  state.error(place_of(*node), fmt::format("{}.target: \"{}\" is not a number that can be animated", full_name, name),
              remedy);
  return {};
}

}  // namespace

void read_tracks(ReadState& state, const toml::array& list, scene::Scene& scene) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    const toml::table& table = *list.get(i)->as_table();
    const std::string full_name = fmt::format("key[{}]", i);
    Track track;
    read_keys(state, table, full_name, scene::track_keys(), {"target", "frames", "values"}, track);
    const auto target = read_target(state, table, full_name, scene, track.target);
    const toml::array* const frames = list_at(state, table, full_name, "frames");
    const toml::array* const values = list_at(state, table, full_name, "values");
    if (!target || frames == nullptr || values == nullptr) continue;
    if (frames->size() != values->size())
      state.error(place_of(*table.get("values")),
                  fmt::format("{} has {} frames but {} values", full_name, frames->size(), values->size()));
    const auto is_same = [&](const Track& other) { return other.target == track.target; };
    if (std::any_of(scene.tracks.begin(), scene.tracks.end(), is_same))
      state.error(place_of(*table.get("target")),
                  fmt::format("{}: {} already has an animation track", full_name, track.target),
                  "put all its keyframes into one [[key]]");
    const bool frames_are_good = read_frames(state, *frames, full_name + ".frames", track.frames);
    const bool values_are_good = read_values(state, *values, full_name + ".values", *target, track.values);
    if (frames_are_good && values_are_good && track.frames.size() == track.values.size())
      scene.tracks.push_back(std::move(track));
  }
}

void check_tracks(ReadState& state, const toml::array& list, const scene::Scene& scene, double frame) {
  for (std::size_t i = 0; i < scene.tracks.size() && i < list.size(); ++i) {
    const Track& track = scene.tracks[i];
    const auto target = scene::find_animated(scene, track.target);
    const math::Vec3d v = scene::value_at(track, frame);
    const bool is_vector = target->type == ValueType::kVector;
    if (target->range.contains(v.x) && (!is_vector || (target->range.contains(v.y) && target->range.contains(v.z))))
      continue;
    state.error(place_of(*list.get(i)),
                fmt::format("{} is {} at frame {}; {}", track.target,
                            is_vector ? scene::vector_text(v) : scene::number_text(v.x), scene::number_text(frame),
                            target->range.requirement()),
                "cubic interpolation may overshoot; add keyframes, or make it linear");
  }
}

}  // namespace orrery::load
