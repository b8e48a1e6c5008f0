// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "compile/compiled_scene.h"

namespace orrery::measure {

/// The spheres of a scene, lent to one world at a time: there may be ten million.
class Spheres {
 public:
  /// Takes a world's.
  void take_from(compile::CompiledScene& compiled) {
    spheres_.swap(compiled.spheres);
    materials_.swap(compiled.sphere_materials);
  }

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
