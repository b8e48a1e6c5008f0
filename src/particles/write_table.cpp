// SPDX-License-Identifier: Apache-2.0
#include "particles/write_table.h"

#include <fmt/core.h>

#include "base/error.h"
#include "base/file_name.h"
#include "particles/table_output.h"

namespace orrery::particles {

using namespace data;  // NOLINT(google-build-using-namespace)

void refuse_to_write(const std::filesystem::path& file, const std::string& text) {
  throw base::Error(base::ErrorKind::kUsage, fmt::format("cannot write {}: {}", file.string(), text));
}

TableFormat table_format(const std::filesystem::path& file) {
  const std::string extension = base::extension(file);
  if (extension == ".ply") return TableFormat::kPly;
  if (extension == ".xyz") return TableFormat::kXyz;
  if (extension == ".npy") return TableFormat::kNpy;
  if (extension == ".csv") return TableFormat::kCsv;
  refuse_to_write(file, fmt::format("unknown extension `{}`; use .ply, .xyz, .npy or .csv", extension));
}

std::vector<std::string> write_table(const std::filesystem::path& file, const Table& table, const std::string& writer) {
  const TableFormat format = table_format(file);
  base::OutputFile out(file);
  std::vector<std::string> left_out;
  switch (format) {
    case TableFormat::kPly: left_out = write_ply_table(out, table, writer); break;
    case TableFormat::kNpy: write_npy_table(out, table); break;
    case TableFormat::kCsv: write_csv_table(out, table); break;
    case TableFormat::kXyz: left_out = write_xyz_table(out, table); break;
  }
  out.finish();
  return left_out;
}

}  // namespace orrery::particles
