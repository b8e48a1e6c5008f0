// SPDX-License-Identifier: Apache-2.0
#include "molecules/cif_assembly.h"

#include <charconv>
#include <unordered_map>

#include <fmt/core.h>

#include "data/faults.h"
#include "data/text_cursor.h"

namespace orrery::molecules {

using namespace data;  // NOLINT(google-build-using-namespace)

namespace {

/// Maximum number of transforms in a file. The largest viruses need a few thousand.
constexpr std::size_t kMaxTransforms = 1'000'000;

/// The words of a list, whose separators may be commas or white space.
std::vector<std::string> split(const std::string& list) {
  const std::vector<std::string_view> words = words_of(list, ", \t\r\n");
  return {words.begin(), words.end()};
}

/// Splits "(1-60)(P)" into "1-60" and "P"; an expression without parentheses is a single group.
std::vector<std::string> groups_of(const std::string& expression) {
  std::vector<std::string> groups;
  std::size_t at = 0;
  for (std::size_t open; (open = expression.find('(', at)) != std::string::npos;) {
    const std::size_t close = expression.find(')', open);
    if (close == std::string::npos) return {};
    groups.push_back(expression.substr(open + 1, close - open - 1));
    at = close + 1;
  }
  if (groups.empty()) groups.push_back(expression);
  return groups;
}

bool is_integer(const std::string& text, int& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

Vec3d product(const Transform& t, Vec3d p) { return {dot(t.rows[0], p), dot(t.rows[1], p), dot(t.rows[2], p)}; }

/// `second` after `first`.
Transform composed(const Transform& second, const Transform& first) {
  const Vec3d x = product(second, {first.rows[0].x, first.rows[1].x, first.rows[2].x});
  const Vec3d y = product(second, {first.rows[0].y, first.rows[1].y, first.rows[2].y});
  const Vec3d z = product(second, {first.rows[0].z, first.rows[1].z, first.rows[2].z});
  return {{Vec3d{x.x, y.x, z.x}, Vec3d{x.y, y.y, z.y}, Vec3d{x.z, y.z, z.z}},
          product(second, first.translation) + second.translation};
}

}  // namespace

void CifAssemblies::add_part(const std::string& assembly, const std::string& expression, const std::string& chains,
                             std::uint64_t line) {
  parts_.push_back({assembly, expression, chains, line});
}

std::vector<Transform> CifAssemblies::transforms_of(const Part& part, Faults& faults) const {
  const auto add = [&](const std::string& id, std::vector<Transform>& out) {
    const auto it = operators_.find(id);
    if (it == operators_.end())
      faults.fail(part.line, fmt::format("assembly {}: the operator `{}` is not defined", part.assembly, id));
    if (out.size() == kMaxTransforms)
      faults.fail(part.line, fmt::format("assembly {}: more than {} operators", part.assembly, kMaxTransforms));
    out.push_back(it->second);
  };
  const std::vector<std::string> groups = groups_of(part.expression);
  if (groups.empty()) faults.fail(part.line, fmt::format("assembly {}: unbalanced parentheses", part.assembly));
  std::vector<Transform> result = {Transform{}};
  for (const std::string& group : groups) {
    std::vector<Transform> factors;
    for (const std::string& word : split(group)) {
      const std::size_t dash = word.find('-');
      int first = 0, last = 0;
      if (dash != std::string::npos && is_integer(word.substr(0, dash), first) &&
          is_integer(word.substr(dash + 1), last)) {
        // Stops at the first undefined number, however large the range.
        for (std::int64_t id = first; id <= last; ++id) add(std::to_string(id), factors);
      } else {
        add(word, factors);
      }
    }
    if (factors.size() * result.size() > kMaxTransforms)
      faults.fail(part.line, fmt::format("assembly {}: more than {} transforms", part.assembly, kMaxTransforms));
    // The rightmost group is applied first.
    std::vector<Transform> products;
    for (const Transform& second : result)
      for (const Transform& first : factors) products.push_back(composed(second, first));
    result = std::move(products);
  }
  if (result.empty()) faults.fail(part.line, fmt::format("assembly {} has no operators", part.assembly));
  return result;
}

std::vector<Assembly> CifAssemblies::finish(Faults& faults) const {
  std::vector<Assembly> assemblies;
  if (operators_.empty()) return assemblies;
  std::unordered_map<std::string, std::size_t> index_of;
  std::size_t total = 0;
  for (const Part& part : parts_) {
    AssemblyPart out{split(part.chains), transforms_of(part, faults)};
    if ((total += out.transforms.size()) > kMaxTransforms)
      faults.fail(part.line, fmt::format("the assemblies have more than {} transforms", kMaxTransforms));
    const auto [same, is_new] = index_of.try_emplace(part.assembly, assemblies.size());
    if (is_new) assemblies.push_back({part.assembly, {}});
    assemblies[same->second].parts.push_back(std::move(out));
  }
  return assemblies;
}

}  // namespace orrery::molecules
