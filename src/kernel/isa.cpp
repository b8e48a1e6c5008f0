// SPDX-License-Identifier: Apache-2.0
#include "kernel/isa.h"

#include <hwy/highway.h>

#include "math/dispatch.h"

namespace orrery::kernel {
namespace {

struct Isa {
  const char* name;
  std::int64_t target;
};
/// Best first; those that the build enables.
constexpr Isa kIsas[] = {{"avx512", HWY_AVX3}, {"avx2", HWY_AVX2}, {"sse4", HWY_SSE4}};

}  // namespace

std::string isa_name(std::int64_t target) {
  for (const Isa& isa : kIsas)
    if (isa.target == target) return isa.name;
  return hwy::TargetName(target);
}

std::string isa_name() {
  const std::int64_t enabled = math::target_choice().enabled();
  return isa_name(enabled & -enabled);  // Highway gives better targets lower bits
}

std::vector<std::string> available_isas() {
  std::vector<std::string> names;
  for (const Isa& isa : kIsas)
    if ((math::target_choice().available() & isa.target) != 0) names.emplace_back(isa.name);
  return names;
}

bool limit_isa(std::string_view name) {
  math::TargetChoice& choice = math::target_choice();
  if (name.empty()) {
    choice.limit(choice.available());
    return true;
  }
  for (const Isa& isa : kIsas) {
    if (isa.name != name) continue;
    if ((choice.available() & isa.target) == 0) return false;
    choice.limit(~(isa.target - 1));
    return true;
  }
  return false;
}

std::string highway_version() {
  return std::to_string(HWY_MAJOR) + "." + std::to_string(HWY_MINOR) + "." + std::to_string(HWY_PATCH);
}

}  // namespace orrery::kernel
