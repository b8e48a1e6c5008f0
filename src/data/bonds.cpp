// SPDX-License-Identifier: Apache-2.0
#include "data/bonds.h"

#include <tbb/parallel_sort.h>

#include <algorithm>

#include <fmt/core.h>

namespace orrery::data {

namespace {

constexpr const char* kRemedy = "correct the file, or determine the bonds by distance instead";

using IdOfRow = std::pair<std::int64_t, std::uint32_t>;

std::vector<IdOfRow> numbered(const std::vector<std::int64_t>& ids) {
  std::vector<IdOfRow> out;
  out.reserve(ids.size());
  for (std::size_t row = 0; row < ids.size(); ++row) out.emplace_back(ids[row], static_cast<std::uint32_t>(row));
  return out;
}

}  // namespace

Bond ordered_bond(std::uint64_t a, std::uint64_t b) {
  return {static_cast<std::uint32_t>(std::min(a, b)), static_cast<std::uint32_t>(std::max(a, b))};
}

void finish_bonds(std::vector<Bond>& bonds, Faults& faults) {
  if (faults.has_any()) faults.fail(0, "the bonds of this file are damaged", kRemedy);
  tbb::parallel_sort(bonds.begin(), bonds.end());
  bonds.erase(std::unique(bonds.begin(), bonds.end()), bonds.end());
  std::uint32_t largest = 0;
  for (const Bond& bond : bonds) largest = std::max(largest, bond.b);
  std::vector<std::uint32_t> counts(bonds.empty() ? 0 : std::size_t{largest} + 1);
  for (const Bond& bond : bonds)
    for (const std::uint32_t row : {bond.a, bond.b})
      if (++counts[row] > kMaxBondsInFile)
        faults.fail(0, fmt::format("row {} has more than {} bonds", std::size_t{row} + 1, kMaxBondsInFile), kRemedy);
}

void warn_of_missing(Faults& faults, std::vector<std::string>& warnings) {
  if (faults.has_any()) warnings.push_back("bonds of the file were left out: " + faults.take_text());
}

BondsById::BondsById(const std::vector<std::int64_t>& ids, Faults& faults) : BondsById(numbered(ids), faults) {}

BondsById::BondsById(std::vector<IdOfRow> ids, Faults& faults) : faults_(faults), ids_(std::move(ids)) {
  if (!std::is_sorted(ids_.begin(), ids_.end())) tbb::parallel_sort(ids_.begin(), ids_.end());
  const auto is_gap = [](const IdOfRow& a, const IdOfRow& b) { return a.first + 1 != b.first; };
  is_dense_ = std::adjacent_find(ids_.begin(), ids_.end(), is_gap) == ids_.end();
}

/// Returns the id and its row; null, and an error is reported, unless it has exactly one.
const IdOfRow* BondsById::find(std::int64_t id, std::uint64_t line) {
  if (!ids_.empty() && is_dense_ && id >= ids_.front().first && id <= ids_.back().first)
    return &ids_[static_cast<std::size_t>(id - ids_.front().first)];
  const auto at = std::lower_bound(ids_.begin(), ids_.end(), IdOfRow{id, 0});
  if (at == ids_.end() || at->first != id) {
    faults_.add_of_many(line, fmt::format("a bond of atom {}, which does not exist", id));
    return nullptr;
  }
  if (const auto next = at + 1; next != ids_.end() && next->first == id) {
    faults_.add_of_many(line, fmt::format("a bond of atom {}, but several atoms have this number", id));
    return nullptr;
  }
  return &*at;
}

void BondsById::add(std::int64_t a, std::int64_t b, std::uint64_t line) {
  if (a == b) return faults_.add_of_many(line, fmt::format("a bond of atom {} with itself", a));
  const IdOfRow* const first = find(a, line);
  const IdOfRow* const second = find(b, line);
  // Alternate locations of an atom have several ids.
  if (first != nullptr && second != nullptr && first->second != second->second)
    bonds_.push_back(ordered_bond(first->second, second->second));
}

std::vector<Bond> BondsById::take() {
  finish_bonds(bonds_, faults_);
  return std::move(bonds_);
}

}  // namespace orrery::data
