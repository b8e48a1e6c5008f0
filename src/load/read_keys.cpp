// SPDX-License-Identifier: Apache-2.0
#include "load/read_keys.h"

#include <algorithm>

#include <fmt/core.h>

namespace orrery::load {
namespace {

using scene::Value;
using scene::ValueType;

std::string type_name(const toml::node& node) {
  // In the order of toml::node_type.
  constexpr const char* kNames[] = {
      "nothing",   "a table", "a list", "a string", "an integer", "a floating-point number",
      "a boolean", "a date",  "a time", "a date"};
  return kNames[static_cast<std::size_t>(node.type())];
}

void wrong_type(ReadState& state, const toml::node& node, const std::string& name, const std::string& wanted) {
  // An override such as 064 is a string, because TOML has no numbers with leading zeros.
  const std::string found = node.is_string() ? scene::string_text(node.as_string()->get()) : type_name(node);
  state.error(place_of(node), fmt::format("{} must be {}, not {}", name, wanted, found));
}

std::optional<double> read_number(ReadState& state, const toml::node& node, const std::string& name,
                                  const scene::Range& range) {
  if (!node.is_number()) {
    wrong_type(state, node, name, "a number");
    return {};
  }
  const double x = node.is_integer() ? static_cast<double>(node.as_integer()->get()) : node.as_floating_point()->get();
  if (!range.contains(x)) {
    state.error(place_of(node), fmt::format("{} is {}; {}", name, scene::number_text(x), range.requirement()),
                x > range.to ? range.remedy : "");
    return {};
  }
  return x;
}

/// Returns a list of a given length; null, and an error is reported, if the node is anything else.
///
/// `wanted`   "three numbers like [0, 1, 0]"
const toml::array* list_of(ReadState& state, const toml::node& node, const std::string& name, std::size_t size,
                           const char* wanted) {
  const toml::array* const array = node.as_array();
  if (array != nullptr && array->size() == size) return array;
  const std::string found = array == nullptr ? type_name(node) : fmt::format("a list of {}", array->size());
  state.error(place_of(node), fmt::format("{} must be {}, not {}", name, wanted, found));
  return nullptr;
}

/// Reads a list of numbers; none, and errors are reported, if it is anything else.
///
/// `wanted`   see list_of()
std::optional<std::vector<double>> read_numbers(ReadState& state, const toml::node& node, const std::string& name,
                                                const scene::Range& range, std::size_t size, const char* wanted) {
  const toml::array* const array = list_of(state, node, name, size, wanted);
  if (array == nullptr) return {};
  std::vector<double> out;
  for (std::size_t i = 0; i < size; ++i)
    if (const auto x = read_number(state, *array->get(i), fmt::format("{}[{}]", name, i), range)) out.push_back(*x);
  return out.size() == size ? std::optional(out) : std::nullopt;
}

std::optional<Value> read_vector(ReadState& state, const toml::node& node, const std::string& name,
                                 const scene::Range& range) {
  const auto v = read_numbers(state, node, name, range, 3, "three numbers like [0, 1, 0]");
  return v ? std::optional<Value>(math::Vec3d{(*v)[0], (*v)[1], (*v)[2]}) : std::nullopt;
}

std::optional<Value> read_integer(ReadState& state, const toml::node& node, const std::string& name,
                                  const scene::Range& range) {
  if (!node.is_integer()) {
    wrong_type(state, node, name, "an integer");
    return {};
  }
  const std::int64_t x = node.as_integer()->get();
  if (!range.contains(static_cast<double>(x))) {
    const auto whole = [](double end) { return std::to_string(static_cast<std::int64_t>(end)); };
    state.error(place_of(node),
                fmt::format("{} is {}; must be in {}..{}", name, x, whole(range.from), whole(range.to)));
    return {};
  }
  return x;
}

/// Words that earlier versions accepted, and what to write instead.
constexpr std::pair<const char*, const char*> kRemoved[] = {
    {"mitchell", "use \"blackman-harris\", or \"gaussian\", with a smaller filter_width for a sharper image"}};

std::optional<Value> read_text(ReadState& state, const toml::node& node, const std::string& name,
                               const std::vector<std::string>& choices) {
  if (!node.is_string()) {
    wrong_type(state, node, name, choices.empty() ? "a string" : "one of " + base::joined(choices));
    return {};
  }
  const std::string& text = node.as_string()->get();
  if (!choices.empty() && !base::contains(choices, text)) {
    for (const auto& [removed, instead] : kRemoved)
      if (text == removed) {
        state.error(place_of(node), fmt::format("{} is \"{}\", which was removed", name, text), instead);
        return {};
      }
    state.error(place_of(node), fmt::format("{} is \"{}\"; must be one of {}", name, text, base::joined(choices)),
                base::did_you_mean(text, choices));
    return {};
  }
  return text;
}

std::optional<Value> read_window(ReadState& state, const toml::node& node, const std::string& name,
                                 const scene::Range& range) {
  const toml::array* const array = list_of(state, node, name, 4, "x, y, width and height like [0, 0, 640, 360]");
  if (array == nullptr) return {};
  std::int64_t v[4];
  for (std::size_t i = 0; i < 4; ++i) {
    const auto x = read_integer(state, *array->get(i), fmt::format("{}[{}]", name, i), range);
    if (!x) return {};
    v[i] = std::get<std::int64_t>(*x);
  }
  return scene::Window{static_cast<int>(v[0]), static_cast<int>(v[1]), static_cast<int>(v[2]), static_cast<int>(v[3])};
}

std::optional<Value> read_interval(ReadState& state, const toml::node& node, const std::string& name,
                                   const scene::Range& range) {
  const auto ends = read_numbers(state, node, name, range, 2, "two numbers like [0, 1]");
  if (!ends) return {};
  const scene::Interval out{ends->front(), ends->back()};
  if (out.low < out.high) return out;
  state.error(place_of(node),
              fmt::format("{} is {}; the first number must be less than the second", name, scene::interval_text(out)));
  return {};
}

std::optional<Value> read_boolean(ReadState& state, const toml::node& node, const std::string& name) {
  if (const toml::value<bool>* value = node.as_boolean()) return value->get();
  wrong_type(state, node, name, "true or false");
  return {};
}

/// Reads a list of strings; with choices, of different ones of them. Reports each invalid element separately.
std::optional<Value> read_texts(ReadState& state, const toml::node& node, const std::string& name,
                                const std::vector<std::string>& choices) {
  const toml::array* const array = node.as_array();
  if (array == nullptr) {
    wrong_type(state, node, name,
               choices.empty() ? "a list of strings" : fmt::format("a list like [\"{}\"]", choices.front()));
    return {};
  }
  std::vector<std::string> texts;
  bool good = true;
  for (std::size_t i = 0; i < array->size(); ++i) {
    const toml::node& element = *array->get(i);
    const std::string element_name = fmt::format("{}[{}]", name, i);
    const auto text = read_text(state, element, element_name, choices);
    good = good && text.has_value();
    if (!text) continue;
    if (!choices.empty() && base::contains(texts, std::get<std::string>(*text))) {
      state.error(place_of(element), element_name + " is a duplicate", "remove it");
      good = false;
    }
    texts.push_back(std::get<std::string>(*text));
  }
  return good ? std::optional<Value>(texts) : std::nullopt;
}

/// Reads a table from particle types to numbers or colours: `type = { 1 = 0.5, 2 = 0.7 }`. Each fault drops a type.
template <class T>
std::optional<Value> read_types(ReadState& state, const toml::node& node, const std::string& name, ValueType type,
                                const scene::Range& range) {
  const toml::table* const entries = node.as_table();
  if (entries == nullptr) {
    state.error(place_of(node), name + " must be a table", "write e.g. type = { 1 = 0.5, 2 = 0.7 }");
    return {};
  }
  std::vector<std::pair<std::string, T>> types;
  for (const auto& [key, value] : *entries)
    if (const auto read = read_value(state, value, fmt::format("{}.{}", name, key.str()), type, range, {}))
      types.emplace_back(std::string(key.str()), std::get<T>(*read));
  return types;
}

}  // namespace

std::optional<Value> read_value(ReadState& state, const toml::node& node, const std::string& name, ValueType type,
                                const scene::Range& range, const std::vector<std::string>& choices) {
  switch (type) {
    case ValueType::kInteger: return read_integer(state, node, name, range);
    case ValueType::kNumber: {
      const auto x = read_number(state, node, name, range);
      return x ? std::optional<Value>(*x) : std::nullopt;
    }
    case ValueType::kVector: return read_vector(state, node, name, range);
    case ValueType::kText: return read_text(state, node, name, {});
    case ValueType::kChoice: return read_text(state, node, name, choices);
    case ValueType::kWindow: return read_window(state, node, name, range);
    case ValueType::kBoolean: return read_boolean(state, node, name);
    case ValueType::kChoices: return read_texts(state, node, name, choices);
    case ValueType::kInterval: return read_interval(state, node, name, range);
    case ValueType::kName:
      if (const toml::value<std::int64_t>* number = node.as_integer()) return std::to_string(number->get());
      return read_text(state, node, name, {});
    case ValueType::kTexts: return read_texts(state, node, name, {});
    case ValueType::kNumbersByType: return read_types<double>(state, node, name, ValueType::kNumber, range);
    case ValueType::kColorsByType: return read_types<math::Vec3d>(state, node, name, ValueType::kVector, range);
  }
  return {};
}

bool has_subkeys(const std::vector<std::string>& known, const std::string& name) {
  return std::any_of(known.begin(), known.end(), [&](const std::string& k) { return k.starts_with(name + "."); });
}

void report_unknown_keys(ReadState& state, const toml::table& table, const std::string& table_name,
                         const std::vector<std::string>& known) {
  for (const auto& [key, node] : table) {
    const std::string name(key.str());
    if (node.is_table() && has_subkeys(known, name)) {
      std::vector<std::string> inner;
      for (const std::string& k : known)
        if (k.starts_with(name + ".")) inner.push_back(k.substr(name.size() + 1));
      report_unknown_keys(state, *node.as_table(), fmt::format("{}.{}", table_name, name), inner);
    } else if (!base::contains(known, name)) {
      std::vector<std::string> direct;
      for (const std::string& k : known)
        if (const std::string first = k.substr(0, k.find('.')); !base::contains(direct, first)) direct.push_back(first);
      report_unknown_key(state, key, table_name, direct);
    }
  }
}

void report_unknown_key(ReadState& state, const toml::key& key, const std::string& table_name,
                        const std::vector<std::string>& known, const std::string& hint) {
  const std::string name(key.str());
  std::string remedy = hint.empty() ? base::did_you_mean(name, known) : hint;
  if (remedy.empty()) remedy = "known keys are " + base::joined(known);
  state.error(place_of(key), fmt::format("unknown key `{}` in {}", name, table_name), remedy);
}

}  // namespace orrery::load
