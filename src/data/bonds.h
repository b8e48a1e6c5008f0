// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "data/faults.h"
#include "data/table.h"

namespace orrery::data {

/// Maximum number of bonds of one particle in a file. Grafted and star polymers have hundreds at one particle.
inline constexpr std::size_t kMaxBondsInFile = 1000;

/// Returns the bond between two rows.
///
/// Domain     a != b, both below 2^32
Bond ordered_bond(std::uint64_t a, std::uint64_t b);

/// Sorts bonds, and keeps one of those that are equal.
///
/// Errors     base::Error(kBadData), thrown through `faults`: those that it has; more than kMaxBondsInFile bonds of one
///            row
void finish_bonds(std::vector<Bond>& bonds, Faults& faults);

/// Turns errors about bonds of atoms that do not exist, or whose name several atoms have, into a warning: programs that
/// remove atoms or renumber them often leave the list of bonds as it was.
void warn_of_missing(Faults& faults, std::vector<std::string>& warnings);

/// Bonds between particles that a file names by id.
class BondsById {
 public:
  /// `ids`      one per row
  BondsById(const std::vector<std::int64_t>& ids, Faults& faults);
  /// `ids`      ids and their rows; several may belong to one row
  BondsById(std::vector<std::pair<std::int64_t, std::uint32_t>> ids, Faults& faults);

  /// Adds a bond. Reports ids that no particle or that several particles have, and a particle that is bonded to itself.
  void add(std::int64_t a, std::int64_t b, std::uint64_t line);

  /// Returns the bonds, see finish_bonds().
  std::vector<Bond> take();

 private:
  const std::pair<std::int64_t, std::uint32_t>* find(std::int64_t id, std::uint64_t line);

  Faults& faults_;
  std::vector<std::pair<std::int64_t, std::uint32_t>> ids_;  ///< ascending
  bool is_dense_ = false;                                    ///< the ids are consecutive
  std::vector<Bond> bonds_;
};

}  // namespace orrery::data
