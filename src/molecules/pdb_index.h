// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "data/byte_source.h"
#include "data/table.h"

namespace orrery::molecules {

/// Location of a model in a PDB file.
struct PdbModel {
  std::uint64_t begin = 0, end = 0;  ///< offsets
  std::uint64_t first_line = 1;
  std::optional<double> number;  ///< from its MODEL record
  std::string cell;              ///< the CRYST1 record that applies to it; may be empty
};

/// The models and assemblies of a PDB file.
struct PdbIndex {
  std::vector<PdbModel> models;  ///< at least one
  std::vector<data::Assembly> assemblies;
  std::string title;
};

/// Finds the models of a PDB file, which end at ENDMDL or END, and its assemblies.
///
/// Errors     base::Error(kBadData): malformed REMARK 350; a file that begins with HEADER, as those of the Protein Data
///            Bank do, but has neither END nor as many atoms as MASTER declares, so it is truncated. Simulation
///            programs write neither record
/// Cost       one pass over the file
PdbIndex index_pdb(const data::ByteSource& bytes);

/// Calls `take` with each line in a range of the file, without line ending, and the line's offset. Lines are truncated
/// to 120 bytes, more than a PDB record can have.
void for_each_pdb_line(const data::ByteSource& bytes, std::uint64_t begin, std::uint64_t end,
                       const std::function<void(std::string_view line, std::uint64_t offset)>& take);

inline bool is_pdb_atom(std::string_view line) { return line.starts_with("ATOM  ") || line.starts_with("HETATM"); }

}  // namespace orrery::molecules
