// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/error.h"
#include "data/data_file.h"
#include "support/temp_dir.h"

namespace orrery::support {

/// Bytes of a number in a file.
template <class T>
std::string number_bytes(T value, bool is_big_endian = false) {
  std::string out(sizeof(T), '\0');
  std::memcpy(out.data(), &value, sizeof(T));
  if (is_big_endian) std::reverse(out.begin(), out.end());  // tests run on little-endian machines
  return out;
}

/// Names of the columns of a frame.
inline std::vector<std::string> column_names(const data::FrameInfo& info) {
  std::vector<std::string> names;
  for (const data::ColumnInfo& column : info.columns) names.push_back(column.name);
  return names;
}

/// All columns of a frame.
inline data::Table read_table(data::DataFile& file, int frame = 0) {
  return file.read(frame, column_names(file.describe(frame)));
}
inline data::Table read_table(const std::filesystem::path& file) { return read_table(*data::open(file)); }

/// The numbers of a column; fails if there is none.
inline std::vector<double> numbers(const data::Table& table, std::string_view name) {
  const data::Column* const column = table.find(name);
  EXPECT_NE(column, nullptr) << "no column " << name;
  std::vector<double> out;
  for (std::size_t row = 0; column != nullptr && row < column->size(); ++row) out.push_back(column->number(row));
  return out;
}

/// The numbers of a column in its own type, which must be T.
template <class T>
const std::vector<T>& values(const data::Table& table, std::string_view name) {
  return std::get<std::vector<T>>(table.find(name)->values);
}

/// The strings of a column; fails if there are none.
inline std::vector<std::string> texts(const data::Table& table, std::string_view name) {
  const data::Column* const column = table.find(name);
  if (column == nullptr || column->type() != data::ColumnType::kText) {
    ADD_FAILURE() << "no text column " << name;
    return {};
  }
  const auto& words = std::get<data::Words>(column->values);
  std::vector<std::string> out;
  for (const std::uint32_t index : words.index) out.push_back(words.words.at(index));
  return out;
}

/// The bonds of a frame: "0-1 1-2".
inline std::string bonds_text(data::DataFile& file, int frame = 0) {
  std::string out;
  std::vector<std::string> warnings;
  for (const data::Bond& bond : file.bonds(frame, warnings))
    out += (out.empty() ? "" : " ") + std::to_string(bond.a) + "-" + std::to_string(bond.b);
  return out;
}

/// Diagnostics of reading the bonds of the first frame, "line: text\n"; empty if there is no error.
inline std::string bond_faults(data::DataFile& file) {
  std::string out;
  try {
    std::vector<std::string> warnings;
    file.bonds(0, warnings);
    for (const std::string& warning : warnings) out += "warning: " + warning + "\n";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kBadData) << error.what();
    EXPECT_NE(error.diagnostics().back().remedy, "");
    for (const base::Diagnostic& d : error.diagnostics()) out += std::to_string(d.line) + ": " + d.text + "\n";
  }
  return out;
}

/// "x:float64 id:int32"
inline std::string columns_text(const data::FrameInfo& info) {
  std::string out;
  for (const data::ColumnInfo& column : info.columns)
    out += (out.empty() ? "" : " ") + column.name + ":" + data::type_name(column.type);
  return out;
}

/// Reads all columns of all frames of a data file.
///
/// Result     the diagnostics, "line: text", one per line; empty if the file is valid
inline std::string data_errors(const std::filesystem::path& file) {
  std::string all;
  try {
    const auto opened = data::open(file);
    for (int frame = 0; frame < opened->frame_count(); ++frame) read_table(*opened, frame);
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

/// Diagnostics of reading all columns of the first frame, "line: text; remedy\n"; empty if there is no error.
inline std::string read_faults(const std::filesystem::path& file, const data::OpenOptions& options = {}) {
  std::string out;
  try {
    read_table(*data::open(file, options));
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kBadData) << error.what();
    for (const base::Diagnostic& d : error.diagnostics())
      out +=
          (d.line > 0 ? std::to_string(d.line) + ": " : "") + d.text + (d.remedy.empty() ? "" : "; " + d.remedy) + "\n";
  }
  return out;
}

}  // namespace orrery::support
