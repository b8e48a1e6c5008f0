// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "base/error.h"
#include "points/selection.h"

namespace orrery::points {

using data::Column;
using data::Table;
using data::Words;

inline constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

/// Six six_atoms with all types of columns.
inline Table six_atoms() {
  Table table;
  table.rows = 6;
  table.columns = {
      Column{"x", std::vector<double>{0, 1, 2, 3, kMissing, -5}},
      Column{"z", std::vector<float>{1, -1, 0.5f, 2, 7, 8}},
      Column{"type", std::vector<std::int32_t>{1, 2, 2, 1, 2, 3}},
      Column{"id", std::vector<std::int64_t>{10, 20, 30, 40, 50, 60}},
      Column{"class", std::vector<std::uint8_t>{2, 2, 255, 2, 2, 0}},
      Column{"intensity", std::vector<std::uint16_t>{0, 65535, 3, 4, 5, 6}},
      Column{"element", Words{{"C", "N", "CA"}, {0, 1, 0, 2, 1, 0}}},
      Column{"label", Words{{"N", "C", "O"}, {1, 0, 2, 2, 2, 1}}},
      Column{"c_stress[1]", std::vector<double>{1, 2, 3, 4, 5, 6}},
      Column{"v.x", std::vector<double>{6, 5, 4, 3, 2, 1}},
      Column{"Potential Energy", std::vector<double>{-1, -2, -3, -4, -5, -6}},
  };
  return table;
}

inline std::vector<data::ColumnInfo> columns_of(const Table& table) {
  std::vector<data::ColumnInfo> out;
  for (const Column& column : table.columns) out.push_back({column.name, column.type()});
  return out;
}

inline std::vector<std::uint8_t> mask_of(const std::string& text, const Table& table) {
  return parse_selection(text, columns_of(table)).evaluate(table);
}

/// The selected rows as digits: "024".
inline std::string selected_rows(const std::string& text, const Table& table = six_atoms()) {
  const auto mask = mask_of(text, table);
  EXPECT_EQ(mask.size(), table.rows) << text;
  std::string out;
  for (std::size_t i = 0; i < mask.size(); ++i) {
    EXPECT_LE(mask[i], 1) << text;
    if (mask[i] != 0) out += std::to_string(i);
  }
  return out;
}

/// The diagnostic of a selection that is invalid.
inline base::Diagnostic selection_fault(const std::string& text) {
  try {
    parse_selection(text, columns_of(six_atoms()));
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kBadData) << text;
    EXPECT_EQ(error.diagnostics().size(), 1u) << text;
    if (!error.diagnostics().empty()) return error.diagnostics()[0];
  }
  ADD_FAILURE() << "no error in: " << text;
  return {};
}

inline std::string message(const std::string& text) {
  const base::Diagnostic d = selection_fault(text);
  return std::to_string(d.column) + "+" + std::to_string(d.width) + " " + d.text + "; " + d.remedy;
}

}  // namespace orrery::points
