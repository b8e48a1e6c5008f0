// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "data/data_file.h"
#include "support/data_tables.h"

namespace orrery::data {
namespace {

using Strings = std::vector<std::string>;

/// Frames of two particles with names. Notes what is read.
class NamedFrames : public DataFile {
 public:
  NamedFrames(std::vector<Strings> names, Strings& reads) : names_(std::move(names)), reads_(reads) {}

  int frame_count() override {
    reads_.push_back("count");
    return static_cast<int>(names_.size());
  }
  bool has_frame(int frame) override { return frame < static_cast<int>(names_.size()); }
  FrameInfo describe(int frame) override {
    FrameInfo info;
    info.rows = names_.at(static_cast<std::size_t>(frame)).size();
    info.columns = {{"x", ColumnType::kFloat64}, {"q", ColumnType::kInt32}, {"name", ColumnType::kText}};
    info.roles.element = "name";
    info.names_as_types = "kind";
    return info;
  }
  Table read(int frame, const Strings& columns) override {
    std::string text = std::to_string(frame);
    const Strings& names = names_.at(static_cast<std::size_t>(frame));
    Table out{names.size(), {}};
    for (const std::string& column : columns) {
      text += " " + column;
      if (column == "x")
        out.columns.push_back({column, std::vector<double>(names.size(), 0.5)});
      else if (column == "q")
        out.columns.push_back({column, std::vector<std::int32_t>(names.size(), 7)});
      else
        out.columns.push_back(
            {column, Words{names, names.empty() ? std::vector<std::uint32_t>() : std::vector<std::uint32_t>{0, 1}}});
    }
    reads_.push_back(text);
    return out;
  }

 private:
  std::vector<Strings> names_;
  Strings& reads_;
};

class DataSettledFile : public testing::Test {
 protected:
  std::unique_ptr<DataFile> of(std::vector<Strings> names) {
    return settled(std::make_unique<NamedFrames>(std::move(names), reads_));
  }
  Strings reads_;
};

TEST_F(DataSettledFile, NamesAreTypesInAllFramesUnlessAllOfTheFirstAreElements) {
  const auto elements = of({{"Fe", "O"}, {"A", "B"}});
  EXPECT_EQ(elements->describe(1).roles.element, "name");
  EXPECT_EQ(elements->describe(0).roles.element, "name");
  EXPECT_EQ(reads_, Strings{"0 name"}) << "once";
  const auto types = of({{}, {"Fe", "A"}, {"Fe", "O"}});
  for (const int frame : {2, 0}) {
    const FrameInfo info = types->describe(frame);
    EXPECT_EQ(info.roles.element, "");
    EXPECT_EQ(info.roles.type, "kind");
    EXPECT_EQ(support::columns_text(info), "x:float64 q:int32 kind:text");
  }
}

TEST_F(DataSettledFile, FramesAreNotCounted) {
  of({{}, {"A", "B"}, {"A", "B"}})->describe(0);
  EXPECT_EQ(reads_, Strings{"1 name"});
}

TEST_F(DataSettledFile, AKeptFrameIsReadOnceWithWhatIsExpected) {
  const auto file = of({{"Fe", "O"}, {"A", "B"}});
  file->keep(0, [](const FrameInfo& info) { return Strings{"x", info.roles.element}; });
  file->describe(0);
  EXPECT_EQ(reads_, Strings{"0 name x"});
  const std::uint64_t before = file->memory();
  const Table table = file->read(0, {"x", "name"});
  EXPECT_TRUE(std::holds_alternative<ArrayView<double>>(table.columns[0].values)) << "not copied";
  EXPECT_EQ(support::texts(table, "name"), (Strings{"Fe", "O"}));
  file->read(0, {"q", "x"});
  file->read(0, {"q"});
  file->read(1, {"x"});
  EXPECT_EQ(reads_, (Strings{"0 name x", "0 q", "1 x"})) << "what was not expected is read and kept; others are not";
  EXPECT_EQ(before, 2 * (8 + 4));
}

TEST_F(DataSettledFile, AnotherFrameReplacesTheKeptOne) {
  const auto file = of({{"Fe", "O"}, {"C", "H"}});
  const auto keep = [&](int frame) { file->keep(frame, [](const FrameInfo&) { return Strings{"name"}; }); };
  keep(0);
  EXPECT_EQ(support::texts(file->read(0, {"name"}), "name"), (Strings{"Fe", "O"}));
  keep(1);
  EXPECT_EQ(support::texts(file->read(1, {"name"}), "name"), (Strings{"C", "H"}));
  keep(1);
  file->read(1, {"name"});
  EXPECT_EQ(reads_, (Strings{"0 name", "1 name"})) << "a second plot of a frame reads nothing";
}

TEST_F(DataSettledFile, AKeptColumnOfNamesMayBecomeOneOfTypes) {
  const auto file = of({{"A", "B"}});
  file->keep(0, [](const FrameInfo&) { return Strings{"x"}; });
  EXPECT_EQ(file->describe(0).roles.type, "kind");
  EXPECT_EQ(support::texts(file->read(0, {"kind"}), "kind"), (Strings{"A", "B"}));
  EXPECT_EQ(reads_, Strings{"0 name x"});
}

}  // namespace
}  // namespace orrery::data
