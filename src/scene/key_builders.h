// SPDX-License-Identifier: Apache-2.0
// Helpers for the definition of keys; used only by the files that define them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "scene/limits.h"
#include "scene/schema.h"

namespace orrery::scene {

/// Range of a reflectance, probability or fuzz; range of a radiance without exposure.
inline constexpr Range kUnit{0, 1};
inline constexpr Range kLight{0, kBrightestLight, false, false, kBrighterLightRemedy};
/// Range of a coordinate, and of a length, scene units.
inline constexpr Range kAnyLength{-kLargestLength, kLargestLength};
inline constexpr Range kLength{kSmallestRadius, kLargestLength};

/// The value of a member, and the member set to a value. An optional member may have none.
///
/// `choices`  names of the enumerators of an enumeration, in their order
template <class T>
std::optional<Value> value_of(const T& member, const std::vector<std::string>& choices) {
  if constexpr (std::is_same_v<T, bool>)
    return member;
  else if constexpr (std::is_enum_v<T>)
    return choices[static_cast<std::size_t>(member)];
  else if constexpr (std::is_integral_v<T>)
    return std::int64_t{member};
  else if constexpr (std::is_same_v<T, std::filesystem::path>)
    return member.string();
  else
    return member;
}
template <class T>
std::optional<Value> value_of(const std::optional<T>& member, const std::vector<std::string>& choices) {
  return member ? value_of(*member, choices) : std::nullopt;
}
template <class T>
void assign(T& member, const Value& value, const std::vector<std::string>& choices) {
  if constexpr (std::is_same_v<T, bool>)
    member = std::get<bool>(value);
  else if constexpr (std::is_enum_v<T>)
    member = static_cast<T>(std::find(choices.begin(), choices.end(), std::get<std::string>(value)) - choices.begin());
  else if constexpr (std::is_integral_v<T>)
    member = static_cast<T>(std::get<std::int64_t>(value));
  else if constexpr (std::is_same_v<T, std::filesystem::path>)
    member = std::get<std::string>(value);
  else
    member = std::get<T>(value);
}
template <class T>
void assign(std::optional<T>& member, const Value& value, const std::vector<std::string>& choices) {
  assign(member.emplace(), value, choices);
}

/// Builds a key for the member that `at` returns a reference to, a function that does not modify its target.
template <class Target, class At>
Key<Target> key_at(const char* name, ValueType type, Range range, const KeyDoc& about, At at,
                   const std::vector<std::string>& choices = {}) {
  return {{about, name, type, range, choices},
          [at, choices](Target& t, const Value& v) { assign(std::invoke(at, t), v, choices); },
          [at, choices](const Target& t) { return value_of(std::invoke(at, const_cast<Target&>(t)), choices); }};
}

template <class Target, class Member>
Key<Target> key_of(const char* name, ValueType type, Range range, const KeyDoc& about, Member Target::*at,
                   const std::vector<std::string>& choices = {}) {
  return key_at<Target>(name, type, range, about, at, choices);
}

template <class Target, class Member>
Key<Target> integer(const char* name, Range range, const KeyDoc& about, Member Target::*at) {
  return key_of(name, ValueType::kInteger, range, about, at);
}

template <class Target, class Member>
Key<Target> number(const char* name, Range range, const KeyDoc& about, Member Target::*at) {
  return key_of(name, ValueType::kNumber, range, about, at);
}

template <class Target, class Member>
Key<Target> vector(const char* name, Range range, const KeyDoc& about, Member Target::*at) {
  return key_of(name, ValueType::kVector, range, about, at);
}

template <class Target, class Member>
Key<Target> text(const char* name, const KeyDoc& about, Member Target::*at) {
  return key_of(name, ValueType::kText, {}, about, at);
}

template <class Target, class Member>
Key<Target> boolean(const char* name, const KeyDoc& about, Member Target::*at) {
  return key_of(name, ValueType::kBoolean, {}, about, at);
}

/// Builds a key for the name of a file.
template <class Target, class Member>
Key<Target> file(const char* name, const FileRole& role, const KeyDoc& about, Member Target::*at) {
  Key<Target> key = text(name, about, at);
  key.file = &role;
  return key;
}
/// Builds a key for one of several words: an enumeration, with choices in enumerator order, or a string, which is empty
/// if there is none.
template <class Target, class Member>
Key<Target> choice(const char* name, const std::vector<std::string>& choices, const KeyDoc& about, Member Target::*at) {
  return key_of(name, ValueType::kChoice, {}, about, at, choices);
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

/// The keys of a part of a target, which `at` returns, as keys of the target; see key_at().
template <class Target, class Inner, class At>
std::vector<Key<Target>> keys_at(At at, std::vector<Key<Inner>> keys) {
  std::vector<Key<Target>> out;
  for (Key<Inner>& key : keys)
    out.push_back({static_cast<KeyFacts&&>(key),
                   [at, set = key.set](Target& t, const Value& v) { set(std::invoke(at, t), v); },
                   [at, get = key.get](const Target& t) { return get(std::invoke(at, const_cast<Target&>(t))); }});
  return out;
}

/// The keys of a member as keys in a subtable: `column` as `radius.column`. A key without a name has that of the
/// subtable.
///
/// `part`     what they change; empty: as the other keys of the table
template <class Target, class Inner>
std::vector<Key<Target>> subtable(const char* name, std::optional<Part> part, Inner Target::*member,
                                  std::vector<Key<Inner>> keys) {
  for (Key<Inner>& key : keys) {
    key.name = key.name.empty() ? name : fmt::format("{}.{}", name, key.name);
    if (part) key.part = part;
  }
  return keys_at<Target>(member, std::move(keys));
}

}  // namespace orrery::scene
