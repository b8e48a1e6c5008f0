// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"
#include "data/data_file.h"
#include "particles/open.h"

namespace orrery::support {

/// Names of the columns of a frame.
inline std::vector<std::string> column_names(const data::FrameInfo& info) {
  std::vector<std::string> names;
  for (const data::ColumnInfo& column : info.columns) names.push_back(column.name);
  return names;
}

/// Reads all columns of all frames of a data file.
///
/// Result     the diagnostics, "line: text", one per line; empty if the file is valid
inline std::string data_errors(const std::filesystem::path& file) {
  std::string all;
  try {
    const auto opened = particles::open(file);
    for (int frame = 0; frame < opened->frame_count(); ++frame)
      opened->read(frame, column_names(opened->describe(frame)));
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kBadData) << error.what();
    for (const base::Diagnostic& d : error.diagnostics()) {
      EXPECT_EQ(d.file, file.string());
      all += std::to_string(d.line) + ": " + d.text + "\n";
    }
    EXPECT_NE(all, "");
  }
  return all;
}

/// The numbers of a column.
inline std::vector<double> column_numbers(const data::Table& table, const std::string& name) {
  std::vector<double> out;
  const data::Column* const column = table.find(name);
  if (column == nullptr) return out;
  for (std::size_t row = 0; row < column->size(); ++row) out.push_back(column->number(row));
  return out;
}

/// The strings of a column.
inline std::vector<std::string> column_texts(const data::Table& table, const std::string& name) {
  const data::Column* const column = table.find(name);
  std::vector<std::string> out;
  if (column == nullptr || column->type() != data::ColumnType::kText) return out;
  const auto& words = std::get<data::Words>(column->values);
  for (const std::uint32_t index : words.index) out.push_back(words.words[index]);
  return out;
}

}  // namespace orrery::support
