// SPDX-License-Identifier: Apache-2.0
#include "points/rules.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/text.h"
#include "data/text_lines.h"
#include "scene/limits.h"

namespace orrery::points {

std::size_t end_of_expression(std::string_view text, Colon which) {
  constexpr std::string_view kQuotes = "\"'`", kOpening = "[{(", kClosing = "]})";
  int depth = 0;
  std::size_t last = std::string_view::npos;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text[at] == ':' && depth <= 0) last = at;
    if (last != std::string_view::npos && which == Colon::kFirst) return last;
    if (kOpening.find(text[at]) != std::string_view::npos) ++depth;
    if (kClosing.find(text[at]) != std::string_view::npos) --depth;
    if (kQuotes.find(text[at]) != std::string_view::npos) at = std::min(text.find(text[at], at + 1), text.size());
  }
  return last;
}

std::pair<std::string, std::string> split_rule(const std::string& text, Colon which) {
  const std::size_t colon = end_of_expression(text, which);
  if (colon == std::string::npos) return {"", std::string(data::trimmed(text))};
  const std::string_view all = text;
  std::pair<std::string, std::string> out(data::trimmed(all.substr(0, colon)), data::trimmed(all.substr(colon + 1)));
  if (out.first.empty()) base::refuse(fmt::format("`{}` has no condition before its colon", text));
  return out;
}

float parse_opacity(const std::string& text) {
  double out = 0;
  if (!base::from_text(text, out) || !(out >= 0 && out <= 1))
    base::refuse(fmt::format("`{}` is not an opacity; write a number in 0..1, e.g. 'type == 2: 0.2'", text));
  return static_cast<float>(out);
}

double parse_radius(const std::string& text) {
  double out = 0;
  if (!base::from_text(text, out) || !(out >= scene::kSmallestRadius && out <= scene::kLargestLength))
    base::refuse(fmt::format("`{}` is not a radius; write a number above 0, e.g. 'type == 2: 0.5'", text));
  return out;
}

std::uint32_t index_of_name(const std::string& name, const std::vector<std::string>& names, const char* kind) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<std::uint32_t>(found - names.begin());
  constexpr std::size_t kMaxNamed = 12;
  std::string remedy = base::did_you_mean(name, names);
  if (remedy.empty() && !names.empty() && names.size() <= kMaxNamed) remedy = "write one of " + base::joined(names);
  base::refuse(fmt::format("`{}` is not {}{}{}", name, kind, remedy.empty() ? "" : "; ", remedy));
}

const std::vector<std::string>& representation_names() {
  static const std::vector<std::string> names = {"spheres", "ball-and-stick", "sticks", "trace", "points"};
  return names;
}

Representation parse_representation(const std::string& name) {
  return static_cast<Representation>(index_of_name(name, representation_names(), "a representation"));
}

}  // namespace orrery::points
