// SPDX-License-Identifier: Apache-2.0
// Helpers for the definition of keys; used only by the files that define them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "scene/limits.h"
#include "scene/schema.h"

namespace orrery::scene {

/// Range of a reflectance, probability or fuzz; range of a radiance without exposure.
inline constexpr Range kUnit{0, 1};
inline constexpr Range kLight{0, kBrightestLight, false, false, kBrighterLightRemedy};
/// Range of a coordinate, and of a length, scene units.
inline constexpr Range kAnyLength{-kLargestLength, kLargestLength};
inline constexpr Range kLength{kSmallestRadius, kLargestLength};

/// Documentation of a key.
struct KeyDoc {
  const char* unit;
  const char* doc;
  const char* cost = "";
};

/// A member of a member of a target: in(&Scene::camera, &Camera::vfov).
template <class Target, class Table, class Member>
auto in(Table Target::*table, Member Table::*member) {
  return [table, member](Target& target) -> Member& { return target.*table.*member; };
}

/// The value of a member, and the member set to a value. An optional member may have none.
template <class T>
std::optional<Value> value_of(const T& member) {
  if constexpr (std::is_same_v<T, bool>)
    return member;
  else if constexpr (std::is_integral_v<T>)
    return std::int64_t{member};
  else if constexpr (std::is_same_v<T, std::filesystem::path>)
    return member.string();
  else
    return member;
}
template <class T>
std::optional<Value> value_of(const std::optional<T>& member) {
  return member ? value_of(*member) : std::nullopt;
}
template <class T>
void assign(T& member, const Value& value) {
  if constexpr (std::is_same_v<T, bool>)
    member = std::get<bool>(value);
  else if constexpr (std::is_integral_v<T>)
    member = static_cast<T>(std::get<std::int64_t>(value));
  else if constexpr (std::is_same_v<T, std::filesystem::path>)
    member = std::get<std::string>(value);
  else
    member = std::get<T>(value);
}
template <class T>
void assign(std::optional<T>& member, const Value& value) {
  assign(member.emplace(), value);
}

/// Builds a key for the member that `at` returns a reference to; `at` is a function that does not modify its target, or
/// a pointer to a member.
template <class Target, class At>
Key<Target> key_of(const char* name, ValueType type, Range range, const KeyDoc& about, At at,
                   std::vector<std::string> choices = {}) {
  return {name,
          type,
          range,
          std::move(choices),
          about.unit,
          about.doc,
          about.cost,
          [at](Target& t, const Value& v) { assign(std::invoke(at, t), v); },
          [at](const Target& t) { return value_of(std::invoke(at, const_cast<Target&>(t))); }};
}
template <class Target, class At>
Key<Target> integer(const char* name, Range range, const KeyDoc& about, At at) {
  return key_of<Target>(name, ValueType::kInteger, range, about, at);
}
template <class Target, class At>
Key<Target> number(const char* name, Range range, const KeyDoc& about, At at) {
  return key_of<Target>(name, ValueType::kNumber, range, about, at);
}
template <class Target, class At>
Key<Target> vector(const char* name, Range range, const KeyDoc& about, At at) {
  return key_of<Target>(name, ValueType::kVector, range, about, at);
}
template <class Target, class At>
Key<Target> interval(const char* name, Range range, const KeyDoc& about, At at) {
  return key_of<Target>(name, ValueType::kInterval, range, about, at);
}
template <class Target, class At>
Key<Target> text(const char* name, const KeyDoc& about, At at) {
  return key_of<Target>(name, ValueType::kText, {}, about, at);
}
template <class Target, class At>
Key<Target> boolean(const char* name, const KeyDoc& about, At at) {
  return key_of<Target>(name, ValueType::kBoolean, {}, about, at);
}
/// Builds a key for the name of a file.
template <class Target, class At>
Key<Target> file(const char* name, const FileRole& role, const KeyDoc& about, At at) {
  Key<Target> key = text<Target>(name, about, at);
  key.file = &role;
  return key;
}
/// Builds a key for an enumeration; `choices` are in enumerator order.
template <class Target, class At>
Key<Target> choice(const char* name, const std::vector<std::string>& choices, const KeyDoc& about, At at) {
  return {name,
          ValueType::kChoice,
          {},
          choices,
          about.unit,
          about.doc,
          about.cost,
          [at, choices](Target& t, const Value& v) {
            auto& member = std::invoke(at, t);
            for (std::size_t i = 0; i < choices.size(); ++i)
              if (choices[i] == std::get<std::string>(v)) member = static_cast<std::decay_t<decltype(member)>>(i);
          },
          [at, choices](const Target& t) -> std::optional<Value> {
            return choices[static_cast<std::size_t>(std::invoke(at, const_cast<Target&>(t)))];
          }};
}
/// Builds a key for one of several words, stored as a string; empty: none.
template <class Target, class At>
Key<Target> choice_of_text(const char* name, std::vector<std::string> choices, const KeyDoc& about, At at) {
  return key_of<Target>(name, ValueType::kChoice, {}, about, at, std::move(choices));
}

/// States the default of a key that may have no value.
template <class Target>
Key<Target> otherwise(const char* text, Key<Target> key) {
  key.otherwise = text;
  return key;
}
/// Sets what a key changes, if that differs from its table.
template <class Target>
Key<Target> changes(Part part, Key<Target> key) {
  key.part = part;
  return key;
}
template <class Target>
Key<Target> required(Key<Target> key) {
  key.required = true;
  return key;
}

}  // namespace orrery::scene
