// SPDX-License-Identifier: Apache-2.0
#include "kernel/isa.h"

#include <hwy/highway.h>

namespace orrery::kernel {
namespace {

struct Isa {
  const char* name;
  std::int64_t target;
};
/// Best first; the same that the build leaves enabled.
constexpr Isa kIsas[] = {{"avx512", HWY_AVX3}, {"avx2", HWY_AVX2}, {"sse4", HWY_SSE4}};

std::int64_t supported() { return static_cast<std::int64_t>(hwy::SupportedTargets()); }

}  // namespace

std::vector<std::string> available_isas() {
  std::vector<std::string> names;
  for (const Isa& isa : kIsas)
    if ((supported() & isa.target) != 0) names.emplace_back(isa.name);
  return names;
}

std::string isa_name() {
  const auto names = available_isas();
  return names.empty() ? "baseline" : names.front();
}

bool limit_isa(std::string_view name) {
  for (const Isa& isa : kIsas) {
    if (isa.name != name) continue;
    if ((supported() & isa.target) == 0) return false;
    hwy::DisableTargets(isa.target - 1);  // Highway gives better targets lower bits
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    return true;
  }
  return false;
}

}  // namespace orrery::kernel
