// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "data/columns.h"
#include "data/data_file.h"

namespace orrery::data {
namespace {

class TableFile : public DataFile {
 public:
  TableFile(const std::filesystem::path& name, std::shared_ptr<const Table> table, const std::optional<Box>& box)
      : table_(std::move(table)) {
    info_.box = box;
    info_.rows = table_->rows;
    for (const Column& column : table_->columns) info_.columns.push_back({column.name, column.type()});
    Faults faults(name);
    info_.roles = required_roles(info_.columns, faults);
    info_.names_as_types = info_.roles.element;
    const bool has_strings = std::any_of(info_.columns.begin(), info_.columns.end(),
                                         [](const ColumnInfo& c) { return c.type == ColumnType::kText; });
    format = "arrays";
    has_views = true;
    info_.may_be_of_scene = !has_strings;
  }

  int frame_count() override { return 1; }
  FrameInfo describe(int) override { return info_; }
  Table read(int, const std::vector<std::string>& columns) override { return copied_columns(*table_, columns); }

 private:
  std::shared_ptr<const Table> table_;
  FrameInfo info_;
};

}  // namespace

std::unique_ptr<DataFile> open_table(const std::filesystem::path& name, std::shared_ptr<const Table> table,
                                     const std::optional<Box>& box) {
  return std::make_unique<TableFile>(name, std::move(table), box);
}

}  // namespace orrery::data
