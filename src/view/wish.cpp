// SPDX-License-Identifier: Apache-2.0
#include "view/wish.h"

#include <cstddef>

#include <nlohmann/json.hpp>

#include "base/error.h"

namespace orrery::view {
namespace {

constexpr std::size_t kLongestValue = 10000;  // of a control
constexpr std::size_t kLongestClient = 64;

/// Adds the values of an option.
void read_option(const nlohmann::json& value, std::vector<std::string>& out) {
  for (const nlohmann::json& one : value) {
    if (!one.is_string() || one.get_ref<const std::string&>().size() > kLongestValue)
      base::refuse("values of `options` must be short strings, lists of them, or true");
    out.push_back(one.get<std::string>());
  }
}

}  // namespace

Wish read_wish(const std::string& json, const std::function<bool(const std::string& option)>& is_control) {
  const nlohmann::json value = nlohmann::json::parse(json, nullptr, false);
  if (!value.is_object()) base::refuse("the body must be a JSON object");
  Wish out;
  for (const auto& [key, member] : value.items()) {
    if (key == "moves" && member.is_boolean()) {
      out.moves = member.get<bool>();
    } else if (key == "camera" && member.is_array()) {
      read_option(member, out.camera);
      for (const std::string& setting : out.camera)
        if (!setting.starts_with("camera.")) base::refuse("`camera` must be settings of the camera");
    } else if (key == "options" && member.is_object()) {
      for (const auto& [option, setting] : member.items()) {
        if (!is_control(option)) base::refuse("`options` must be those of the page");
        if (setting == "" || setting == nlohmann::json::array()) continue;
        std::vector<std::string>& values = out.options[option];
        if (setting != true) read_option(setting.is_array() ? setting : nlohmann::json{setting}, values);
      }
    } else if (key == "client" && member.is_string() && member.get_ref<const std::string&>().size() <= kLongestClient) {
      out.client = member.get<std::string>();
    } else {
      base::refuse("the body has an unknown member");
    }
  }
  return out;
}

std::vector<std::string> words_of(const std::vector<std::string>& fixed, const Wish& wish) {
  std::vector<std::string> out = fixed;
  for (const auto& [option, values] : wish.options) {
    if (values.empty()) out.push_back(option);
    for (const std::string& value : values) out.insert(out.end(), {option, value});
  }
  for (const std::string& setting : wish.camera) out.insert(out.end(), {"--set", setting});
  return out;
}

}  // namespace orrery::view
