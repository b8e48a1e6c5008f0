// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "compile/compiled_scene.h"

namespace orrery::measure {

/// The spheres of a scene, lent to one CompiledScene at a time instead of copied, since there may be ten million.
class Spheres {
 public:
  /// Exchanges the spheres with those of a compiled scene.
  void take_from(compile::CompiledScene& compiled) {
    spheres_.swap(compiled.spheres);
    materials_.swap(compiled.sphere_materials);
  }

  /// Lends the spheres to a compiled scene during its lifetime.
  class Loan {
   public:
    Loan(Spheres& from, compile::CompiledScene& to) : from_(from), to_(to) { from_.take_from(to_); }
    ~Loan() { from_.take_from(to_); }
    Loan(const Loan&) = delete;
    Loan& operator=(const Loan&) = delete;

   private:
    Spheres& from_;
    compile::CompiledScene& to_;
  };

 private:
  std::vector<kernel::Sphere> spheres_;
  std::vector<std::uint32_t> materials_;
};

}  // namespace orrery::measure
