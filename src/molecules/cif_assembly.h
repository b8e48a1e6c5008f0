// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "data/faults.h"
#include "data/table.h"

namespace orrery::molecules {

/// Builds the biological assemblies of an mmCIF file from the tables _pdbx_struct_oper_list and
/// _pdbx_struct_assembly_gen, which may come in any order.
///
/// Reference  mmcif
class CifAssemblies {
 public:
  void add_operator(const std::string& id, const data::Transform& transform) { operators_[id] = transform; }
  /// Adds a part of an assembly: chains, and the expression of their transforms.
  ///
  /// `expression`   "1", "1,3", "(1-60)", "(1-5)(X0)"
  /// `chains`       "A,B,C"
  void add_part(const std::string& assembly, const std::string& expression, const std::string& chains,
                std::uint64_t line);

  /// Returns the assemblies in the order of the file; none if the file defines no operators.
  ///
  /// Errors     base::Error(kBadData): undefined operators, malformed expressions, too many transforms
  std::vector<data::Assembly> finish(data::Faults& faults) const;

 private:
  struct Part {
    std::string assembly, expression, chains;
    std::uint64_t line = 0;
  };

  std::vector<data::Transform> transforms_of(const Part& part, data::Faults& faults) const;

  std::map<std::string, data::Transform> operators_;
  std::vector<Part> parts_;
};

}  // namespace orrery::molecules
