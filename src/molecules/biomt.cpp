// SPDX-License-Identifier: Apache-2.0
#include "molecules/biomt.h"

#include <charconv>
#include <cmath>
#include <string>

#include <fmt/core.h>

#include "data/faults.h"
#include "data/text_cursor.h"

namespace orrery::molecules {

using namespace data;  // NOLINT(google-build-using-namespace)

namespace {

bool is_finite_number(std::string_view word, double& value) {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size() && std::isfinite(value);
}

}  // namespace

/// The part that the next transform belongs to.
AssemblyPart& BiomtReader::part() {
  if (assemblies_.empty()) assemblies_.push_back({"1", {}});
  if (assemblies_.back().parts.empty()) assemblies_.back().parts.emplace_back();
  return assemblies_.back().parts.back();
}

void BiomtReader::take(std::string_view text, std::uint64_t line, Faults& faults) {
  text = trimmed(text);
  constexpr std::string_view kName = "BIOMOLECULE:", kChains = "CHAINS:", kRow = "BIOMT";
  if (text.starts_with(kName)) {
    assemblies_.push_back({std::string(trimmed(text.substr(kName.size()))), {}});
  } else if (const std::size_t at = text.find(kChains); at != std::string_view::npos) {
    if (text.starts_with("APPLY")) {
      part();
      auto& parts = assemblies_.back().parts;
      if (!parts.back().chains.empty() || !parts.back().transforms.empty()) parts.emplace_back();
    }
    for (const std::string_view name : words_of(text.substr(at + kChains.size()), ", \t"))
      part().chains.emplace_back(name);
  } else if (text.starts_with(kRow)) {
    const std::vector<std::string_view> words = words_of(text);
    const std::size_t row = static_cast<std::size_t>(row_);
    double values[4];
    bool is_good = words.size() == 6;
    for (std::size_t i = 0; i < 4 && is_good; ++i) is_good = is_finite_number(words[2 + i], values[i]);
    if (!is_good) faults.fail(line, "malformed BIOMT row: expected a serial number and four numbers");
    if (words[0] != "BIOMT" + std::to_string(row + 1) || (row > 0 && words[1] != serial_))
      faults.fail(line, fmt::format("BIOMT row out of order: expected row {}{}", row + 1,
                                    row > 0 ? " of transform " + serial_ : " of a transform"));
    serial_ = words[1];
    transform_.rows[row] = {values[0], values[1], values[2]};
    (row == 0 ? transform_.translation.x : row == 1 ? transform_.translation.y : transform_.translation.z) = values[3];
    row_ = (row_ + 1) % 3;
    if (row_ == 0) part().transforms.push_back(transform_);
  }
}

std::vector<Assembly> BiomtReader::finish(Faults& faults) {
  if (row_ != 0) faults.fail(0, fmt::format("truncated: transform {} of REMARK 350 is incomplete", serial_));
  return std::move(assemblies_);
}

}  // namespace orrery::molecules
