// SPDX-License-Identifier: Apache-2.0
// The program's side of the module: forwards the room's functions to the module and loads it on the first call, so that
// only commands that use data files load libarchive, HDF5, gemmi and pugixml.
#include "base/module.h"
#include "data/module/functions.h"

namespace orrery::data {

namespace {

const Functions& module() {
  static const Functions& functions = *static_cast<const Functions*>(base::load_module("data"));
  return functions;
}

}  // namespace

std::unique_ptr<DataFile> open(const std::filesystem::path& file, const OpenOptions& options) {
  return module().open(file, options);
}

bool is_data_file(const std::filesystem::path& file, std::string_view head) {
  return module().is_data_file(file, head);
}

void require_table_format(const std::filesystem::path& file) { module().require_table_format(file); }

bool is_storable_in_ply(const Column& column) { return module().is_storable_in_ply(column); }

std::vector<std::string> write_table(const std::filesystem::path& file, const Table& table, const FrameHeader& header,
                                     const std::string& writer) {
  return module().write_table(file, table, header, writer);
}

}  // namespace orrery::data
