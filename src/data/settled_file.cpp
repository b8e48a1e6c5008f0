// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/text.h"
#include "data/data_file.h"
#include "data/elements.h"

namespace orrery::data {
namespace {

/// Returns a column with the values of another one, which must outlive it: numbers that have views are not copied.
Column view_of(const Column& column) {
  Column out{column.name, {}};
  std::visit(
      [&](const auto& values) {
        if constexpr (requires { values.data(), Values(ArrayView<std::decay_t<decltype(values[0])>>(nullptr, 0, 0)); })
          out.values = ArrayView<std::decay_t<decltype(values[0])>>(values.data(), sizeof(values[0]), values.size());
        else
          out.values = values;
      },
      column.values);
  return out;
}

/// A file whose columns of names are elements or types, and which may keep the table of a frame.
class SettledFile final : public DataFile {
 public:
  explicit SettledFile(std::unique_ptr<DataFile> file) : file_(std::move(file)) { format = file_->format; }

  int frame_count() override { return file_->frame_count(); }
  bool has_frame(int frame) override { return file_->has_frame(frame); }

  FrameInfo describe(int frame) override {
    FrameInfo info = file_->describe(frame);
    if (info.names_as_types.empty() || info.roles.element.empty() || are_elements(frame)) return info;
    Roles& roles = info.roles;
    const auto column = std::find_if(info.columns.begin(), info.columns.end(),
                                     [&](const ColumnInfo& c) { return c.name == roles.element; });
    column->name = info.names_as_types;
    if (Column* const kept = kept_.find(roles.element)) kept->name = info.names_as_types;
    if (roles.type.empty()) roles.type = info.names_as_types;
    roles.element.clear();
    return info;
  }

  Table read(int frame, const std::vector<std::string>& columns) override {
    if (frame != kept_frame_) return file_->read(frame, columns);
    keep_columns(columns);
    Table out{kept_.rows, {}};
    for (const std::string& name : columns) out.columns.push_back(view_of(*kept_.find(name)));
    return out;
  }

  std::vector<Bond> bonds(int frame, std::vector<std::string>& warnings) override {
    return file_->bonds(frame, warnings);
  }

  std::uint64_t memory() const override {
    std::uint64_t bytes = file_->memory();
    for (const Column& column : kept_.columns) bytes += kept_.rows * bytes_per_value(column.type());
    return bytes;
  }

  void keep(int frame, Expected expected) override {
    if (file_->has_views) return;
    if (frame != kept_frame_) kept_ = {};
    kept_frame_ = frame;
    expected_ = std::move(expected);
  }

 private:
  /// Coarse-grained models and mixtures have particles named A, B or C1: names are elements only if all of them are in
  /// the first frame that has rows, since what they mean must not change from frame to frame.
  ///
  /// `frame`    has names
  bool are_elements(int frame) {
    if (are_elements_) return *are_elements_;
    for (int i = 0; i <= frame || file_->has_frame(i); ++i) {
      const FrameInfo info = file_->describe(i);
      if (info.rows == 0) continue;
      are_elements_ = info.names_as_types.empty() || info.roles.element.empty() || has_elements(i, info);
      return *are_elements_;
    }
    return true;  // there are no particles
  }

  bool has_elements(int frame, const FrameInfo& info) {
    try {
      const Table table = read(frame, {info.roles.element});
      const std::vector<std::string>& words = std::get<Words>(table.columns.front().values).words;
      return std::all_of(words.begin(), words.end(),
                         [](const std::string& word) { return find_element(word) != nullptr; });
    } catch (const base::Error& error) {
      if (error.kind() != base::ErrorKind::kBadData) throw;
      return true;  // reported when the frame is read for its particles
    }
  }

  /// Reads columns of the kept frame that have not been read, together with all that are expected.
  void keep_columns(const std::vector<std::string>& columns) {
    std::vector<std::string> missing;
    const auto add = [&](const std::string& name) {
      if (kept_.find(name) == nullptr && !base::contains(missing, name)) missing.push_back(name);
    };
    for (const std::string& name : columns) add(name);
    if (missing.empty()) return;
    if (const Expected expected = std::exchange(expected_, {}))
      for (const std::string& name : expected(are_elements_ ? describe(kept_frame_) : file_->describe(kept_frame_)))
        add(name);
    Table more = file_->read(kept_frame_, missing);
    kept_.rows = more.rows;
    std::move(more.columns.begin(), more.columns.end(), std::back_inserter(kept_.columns));
  }

  std::unique_ptr<DataFile> file_;
  std::optional<bool> are_elements_;
  int kept_frame_ = -1;
  Expected expected_;
  Table kept_;
};

}  // namespace

std::unique_ptr<DataFile> settled(std::unique_ptr<DataFile> file) {
  return std::make_unique<SettledFile>(std::move(file));
}

}  // namespace orrery::data
