// SPDX-License-Identifier: Apache-2.0
// Helpers for the definition of keys; used only by the files that define them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "scene/limits.h"
#include "scene/schema.h"
#include "scene/value_text.h"

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

template <class T>
struct WithoutOptional {
  using Type = T;
};
template <class T>
struct WithoutOptional<std::optional<T>> {
  using Type = T;
};

/// Builds a key for the member that `at` returns a reference to; `at` does not modify its target.
template <class Target, class At, class Text>
Key<Target> key_of(const char* name, ValueType type, Range range, const KeyDoc& about, At at, Text text) {
  return {name,
          type,
          range,
          {},
          about.unit,
          about.doc,
          about.cost,
          false,
          [at](Target& t, const Value& v) {
            using Member = typename WithoutOptional<std::remove_reference_t<decltype(at(t))>>::Type;
            if constexpr (std::is_integral_v<Member>) {
              at(t) = static_cast<Member>(std::get<std::int64_t>(v));
            } else if constexpr (std::is_constructible_v<Member, std::string>) {
              at(t) = std::get<std::string>(v);
            } else {
              at(t) = std::get<Member>(v);
            }
          },
          [at, text](const Target& t) { return text(at(const_cast<Target&>(t))); }};
}
template <class Target, class At>
Key<Target> integer(const char* name, Range range, const KeyDoc& about, At at) {
  return key_of<Target>(name, ValueType::kInteger, range, about, at, [](auto x) { return std::to_string(x); });
}
template <class Target, class At>
Key<Target> number(const char* name, Range range, const KeyDoc& about, At at) {
  return key_of<Target>(name, ValueType::kNumber, range, about, at, number_text);
}
template <class Target, class At>
Key<Target> vector(const char* name, Range range, const KeyDoc& about, At at) {
  return key_of<Target>(name, ValueType::kVector, range, about, at, vector_text);
}
template <class Target, class At>
Key<Target> text(const char* name, const KeyDoc& about, At at) {
  return key_of<Target>(name, ValueType::kText, {}, about, at, string_text);
}
template <class Target, class At>
Key<Target> boolean(const char* name, const KeyDoc& about, At at) {
  return {name,
          ValueType::kBoolean,
          {},
          {},
          about.unit,
          about.doc,
          about.cost,
          false,
          [at](Target& t, const Value& v) { at(t) = std::get<bool>(v); },
          [at](const Target& t) -> std::string { return at(const_cast<Target&>(t)) ? "true" : "false"; }};
}
/// Builds a key for an optional number; `otherwise` describes its default.
template <class Target, class At>
Key<Target> optional_number(const char* name, Range range, const KeyDoc& about, const char* otherwise, At at) {
  return key_of<Target>(name, ValueType::kNumber, range, about, at,
                        [otherwise](const auto& x) { return x ? number_text(*x) : std::string(otherwise); });
}
/// Builds a key for an enumeration; `choices` are in enumerator order.
template <class Target, class At>
Key<Target> choice(const char* name, std::vector<std::string> choices, const KeyDoc& about, At at) {
  return {name,
          ValueType::kChoice,
          {},
          choices,
          about.unit,
          about.doc,
          about.cost,
          false,
          [at, choices](Target& t, const Value& v) {
            using Enum = std::remove_reference_t<decltype(at(t))>;
            for (std::size_t i = 0; i < choices.size(); ++i)
              if (choices[i] == std::get<std::string>(v)) at(t) = static_cast<Enum>(i);
          },
          [at, choices](const Target& t) {
            return string_text(choices[static_cast<std::size_t>(at(const_cast<Target&>(t)))]);
          }};
}
/// Builds a key for one of several words, stored as a string; empty: none.
template <class Target, class At>
Key<Target> choice_of_text(const char* name, std::vector<std::string> choices, const KeyDoc& about, At at) {
  Key<Target> key = key_of<Target>(name, ValueType::kChoice, {}, about, at, string_text);
  key.choices = std::move(choices);
  return key;
}
/// Builds a key for an optional window; `otherwise` describes its default.
template <class Target, class At>
Key<Target> optional_window(const char* name, const KeyDoc& about, const char* otherwise, At at) {
  Key<Target> key;
  key.name = name;
  key.type = ValueType::kWindow;
  key.required = false;
  key.range = {0, kLargestSide};
  key.unit = about.unit;
  key.doc = about.doc;
  key.cost = about.cost;
  key.set = [at](Target& t, const Value& v) { at(t) = std::get<Window>(v); };
  key.text = [at, otherwise](const Target& t) -> std::string {
    const std::optional<Window>& w = at(const_cast<Target&>(t));
    return w ? window_text(*w) : otherwise;
  };
  return key;
}
/// Builds a key for an optional integer; `otherwise` describes its default.
template <class Target, class At>
Key<Target> optional_integer(const char* name, Range range, const KeyDoc& about, const char* otherwise, At at) {
  return key_of<Target>(name, ValueType::kInteger, range, about, at,
                        [otherwise](const auto& x) { return x ? std::to_string(*x) : std::string(otherwise); });
}
/// Builds a key for an optional vector; `otherwise` describes its default.
template <class Target, class At>
Key<Target> optional_vector(const char* name, Range range, const KeyDoc& about, const char* otherwise, At at) {
  return key_of<Target>(name, ValueType::kVector, range, about, at,
                        [otherwise](const auto& x) { return x ? vector_text(*x) : std::string(otherwise); });
}
/// Builds a key for an optional interval; `otherwise` describes its default.
template <class Target, class At>
Key<Target> optional_interval(const char* name, Range range, const KeyDoc& about, const char* otherwise, At at) {
  return key_of<Target>(name, ValueType::kInterval, range, about, at,
                        [otherwise](const auto& x) { return x ? interval_text(*x) : std::string(otherwise); });
}
/// Builds a key for a string or an integer.
template <class Target, class At>
Key<Target> name_or_number(const char* name, const KeyDoc& about, At at) {
  return key_of<Target>(name, ValueType::kName, {}, about, at, string_text);
}
/// Builds a key for a list of choices in any order.
template <class Target, class At>
Key<Target> choices(const char* name, std::vector<std::string> choices, const KeyDoc& about, At at) {
  Key<Target> key = key_of<Target>(name, ValueType::kChoices, {}, about, at, list_text);
  key.choices = std::move(choices);
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
