// SPDX-License-Identifier: Apache-2.0
#include "points/selection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "six_atoms.h"
#include "support/mentions.h"

namespace orrery::points {
namespace {

TEST(PointsSelection, ComparesNumbersOfAllTypes) {
  EXPECT_EQ(selected_rows("type == 2"), "124");
  EXPECT_EQ(selected_rows("type != 2"), "035");
  EXPECT_EQ(selected_rows("z < 1"), "12");
  EXPECT_EQ(selected_rows("z <= 1"), "012");
  EXPECT_EQ(selected_rows("z > 2"), "45");
  EXPECT_EQ(selected_rows("z >= 2"), "345");
  EXPECT_EQ(selected_rows("id == 30 || class == 255 || intensity == 65535"), "12");
  EXPECT_EQ(selected_rows("2 == type"), "124");
}

TEST(PointsSelection, ComparesStrings) {
  EXPECT_EQ(selected_rows("element == \"C\""), "025");
  EXPECT_EQ(selected_rows("element != 'C'"), "134");
  EXPECT_EQ(selected_rows("'CA' == element"), "3");
  EXPECT_EQ(selected_rows("element == \"Zr\""), "");
  EXPECT_EQ(selected_rows("element == label"), "015") << "indices of different dictionaries";
  EXPECT_EQ(selected_rows("element != label"), "234");
}

TEST(PointsSelection, FindsInLists) {
  EXPECT_EQ(selected_rows("type in [3, 1]"), "035");
  EXPECT_EQ(selected_rows("x in [-5, 2]"), "25");
  EXPECT_EQ(selected_rows("element in [\"N\", 'CA']"), "134");
  EXPECT_EQ(selected_rows("!(element in[\"N\"])"), "0235");
  EXPECT_EQ(selected_rows("id / 10 in [2]"), "1");
  EXPECT_EQ(selected_rows("type in {3, 1}"), "035");
}

TEST(PointsSelection, FindsInClosedRanges) {
  EXPECT_EQ(selected_rows("id in [20:40]"), "123");
  EXPECT_EQ(selected_rows("id in [20.5:39.5]"), "2");
  EXPECT_EQ(selected_rows("x in [-5:0]"), "05");
  EXPECT_EQ(selected_rows("x in [-5:-1]"), "5");
  EXPECT_EQ(selected_rows("id in [50:]"), "45");
  EXPECT_EQ(selected_rows("id in [:20]"), "01");
  EXPECT_EQ(selected_rows("id in [ 20 : 20 ]"), "1");
  EXPECT_EQ(selected_rows("id in [10, 55:, 30:40, 35:45]"), "0235") << "lists may have ranges that overlap";
  EXPECT_EQ(selected_rows("id in {10, 55:}"), "05");
  EXPECT_EQ(selected_rows("x in [:]", six_atoms()), "01235") << "every number, but not NaN";
  EXPECT_EQ(selected_rows("x in [:100]"), "01235");
}

TEST(PointsSelection, StringsInBracesNeedNoQuotes) {
  EXPECT_EQ(selected_rows("element in {N, CA}"), "134");
  EXPECT_EQ(selected_rows("element in{C}&&label in {'N', C}"), "05");
  Table table;
  table.rows = 4;
  table.columns = {Column{"chain", Words{{"A", "1", "2MG", "O5*"}, {0, 1, 2, 3}}}};
  EXPECT_EQ(selected_rows("chain in {1, 2MG}", table), "12") << "digits are strings in a column of strings";
  EXPECT_EQ(selected_rows("chain in {'O5*', A}", table), "03");
}

TEST(PointsSelection, Functions) {
  EXPECT_EQ(selected_rows("abs(x) == 5"), "5");
  EXPECT_EQ(selected_rows("sqrt(id * 10) == 10"), "0");
  EXPECT_EQ(selected_rows("min(z, 1, v.x) == 1"), "0345");
  EXPECT_EQ(selected_rows("max(x, z) == 1"), "01");
  EXPECT_EQ(selected_rows("sqrt(x * x + z * z) < 2"), "01");
}

std::vector<double> values_of(const std::string& text) {
  const Table table = six_atoms();
  return parse_expression(text, columns_of(table)).evaluate(table);
}

std::string error_of_expression(const std::string& text) {
  try {
    values_of(text);
  } catch (const base::Error& error) {
    return error.diagnostics().at(0).text;
  }
  return "no error";
}

TEST(PointsSelection, ExpressionsAreNumbersOfRows) {
  EXPECT_EQ(values_of("sqrt(v.x^2 + 0 * id)"), (std::vector<double>{6, 5, 4, 3, 2, 1}));
  EXPECT_EQ(values_of("-type^2")[1], -4) << "the power first";
  EXPECT_EQ(values_of("2^type^2")[1], 16) << "from the right";
  EXPECT_EQ(values_of("2^-type")[1], 0.25);
  EXPECT_EQ(values_of("3 * type^2")[2], 12);
  EXPECT_EQ(values_of("log10(id / 10)")[0], 0);
  EXPECT_EQ(values_of("floor(exp(log(z) / 2) * 100)")[3], 141);
  EXPECT_TRUE(std::isinf(values_of("1 / x")[0]));
  EXPECT_EQ(selected_rows("type^2 == 4"), "124") << "in conditions, too";
  EXPECT_EQ(error_of_expression("x > 1"), "expected an arithmetic operator");
  EXPECT_EQ(error_of_expression("element"), "expected a number, not a string");
  EXPECT_EQ(error_of_expression("sqrt(y)"), "unknown column y");
  EXPECT_TRUE(test::mentions(error_of_expression("x ^"), {"condition", "early"}));
}

TEST(PointsSelection, ComparisonsWithNanAreFalse) {
  for (const char* op : {"==", "!=", "<", "<=", ">", ">="}) {
    EXPECT_EQ(selected_rows(std::string("x ") + op + " 0").find('4'), std::string::npos) << op;
    EXPECT_EQ(selected_rows(std::string("0 ") + op + " x").find('4'), std::string::npos) << op;
  }
  EXPECT_EQ(selected_rows("x in [0, 1, 2]"), "012");
  EXPECT_EQ(selected_rows("min(x, 0) <= 0 || min(0, x) <= 0 || max(x, 0) >= 0 || max(0, x) >= 0"), "01235");
  EXPECT_EQ(selected_rows("sqrt(x) >= 0"), "0123") << "the root of a negative number is NaN";
}

TEST(PointsSelection, EmptySelectsAll) {
  EXPECT_EQ(selected_rows(""), "012345");
  EXPECT_EQ(selected_rows(" \t\n"), "012345");
  EXPECT_TRUE(parse_selection("", columns_of(six_atoms())).columns.empty());
  EXPECT_EQ(Selection().evaluate(six_atoms()).size(), 6u);
}

TEST(PointsSelection, EvaluatesEveryBlock) {
  // More than two blocks, the last of them incomplete.
  constexpr std::size_t kRows = 2500;
  Table table;
  table.rows = kRows;
  std::vector<double> x(kRows);
  Words word{{"even", "odd"}, std::vector<std::uint32_t>(kRows)};
  for (std::size_t i = 0; i < kRows; ++i) {
    x[i] = static_cast<double>(i);
    word.index[i] = i % 2;
  }
  table.columns = {Column{"x", x}, Column{"word", word}};
  const auto mask = mask_of("word == 'odd' && (x < 3 || x * 2 - 1 >= 4995)", table);
  for (std::size_t i = 0; i < kRows; ++i) EXPECT_EQ(mask[i], i % 2 == 1 && (i < 3 || i >= 2498) ? 1 : 0) << i;
  EXPECT_TRUE(mask_of("x > 0", Table{0, {Column{"x", std::vector<double>{}}}}).empty());
}

TEST(PointsSelection, ResiduesAndAtomsAreNamedAsInOtherPrograms) {
  Table table;
  table.rows = 4;
  table.columns = {Column{"chain", Words{{"A", "B", "2"}, {0, 0, 1, 2}}},
                   Column{"name", Words{{"CA", "CB"}, {0, 1, 0, 0}}},
                   Column{"residue", Words{{"ALA", "1PE"}, {0, 0, 1, 1}}},
                   Column{"residue_number", std::vector<std::int32_t>{7, 7, 8, 9}}};
  const auto mask = [&](const char* text) { return mask_of(text, table); };
  using Mask = std::vector<std::uint8_t>;
  EXPECT_EQ(mask("chain A and name CA"), (Mask{1, 0, 0, 0}));
  EXPECT_EQ(mask("chain 2"), (Mask{0, 0, 0, 1})) << "a name of digits";
  EXPECT_EQ(mask("resname 1PE"), (Mask{0, 0, 1, 1}));
  EXPECT_EQ(mask("resn ALA+1PE and not resi 8-9"), (Mask{1, 1, 0, 0}));
  EXPECT_EQ(mask("resid == 8"), (Mask{0, 0, 1, 0}));
  EXPECT_EQ(mask("resnum in [9]"), (Mask{0, 0, 0, 1}));
  EXPECT_EQ(parse_selection("resid 8", columns_of(table)).columns, std::vector<std::string>{"residue_number"});
  const auto remedy = [&](const char* text) {
    try {
      mask(text);
    } catch (const base::Error& error) {
      return error.diagnostics().at(0).remedy;
    }
    return std::string("none");
  };
  EXPECT_EQ(remedy("water"), "e.g. residue in {HOH, WAT}");
  EXPECT_EQ(remedy("not protein and chain A"), "e.g. record == \"ATOM\"");
  EXPECT_EQ(remedy("/A"), "e.g. chain A");
  EXPECT_EQ(remedy("@CA"), "e.g. name CA");
  table.columns.push_back({"resid", std::vector<std::int32_t>{1, 2, 3, 4}});
  EXPECT_EQ(mask("resid 1"), (Mask{1, 0, 0, 0})) << "a column of the file precedes another program's name";
}

/// Two chains of three residues with two atoms each, one unit apart along x.
Table residues() {
  Table table;
  table.rows = 12;
  std::vector<double> x, zero(12);
  std::vector<std::int64_t> number;
  std::vector<std::uint32_t> chain, residue;
  for (std::uint32_t i = 0; i < 12; ++i) {
    x.push_back(i);
    number.push_back(i % 6 / 2 + 1);
    chain.push_back(i / 6);
    residue.push_back(i / 2 % 2);
  }
  table.columns = {Column{"x", x},
                   Column{"y", zero},
                   Column{"z", zero},
                   Column{"residue_number", number},
                   Column{"chain", Words{{"A", "B"}, chain}},
                   Column{"residue", Words{{"ALA", "GLY"}, residue}}};
  return table;
}

std::vector<std::size_t> selected(const std::string& text, const Table& table) {
  std::vector<data::ColumnInfo> columns;
  for (const Column& column : table.columns) columns.push_back({column.name, column.type()});
  std::vector<std::size_t> out;
  const std::vector<std::uint8_t> mask = parse_selection(text, columns).evaluate(table);
  for (std::size_t row = 0; row < mask.size(); ++row)
    if (mask[row] != 0) out.push_back(row);
  return out;
}

using Places = std::vector<std::size_t>;

TEST(PointsSelection, RowsNearOthers) {
  const Table table = residues();
  EXPECT_EQ(selected("within 1 of (x == 5)", table), (Places{4, 5, 6}))
      << "the distance is included, and the row itself";
  EXPECT_EQ(selected("within 0.5 of x == 5", table), (Places{5}));
  EXPECT_EQ(selected("within 1 of (x in [0, 11]) && chain A", table), (Places{0, 1}));
  EXPECT_EQ(selected("!(within 1e9 of (x == 5))", table), (Places{}));
  EXPECT_EQ(selected("within 5 of (x > 99)", table), (Places{})) << "none is near nothing";
  EXPECT_EQ(selected("within 1 of (within 1 of (x == 5)) && !(within 1 of (x == 5))", table), (Places{3, 7}));
  Table far = residues();
  std::get<std::vector<double>>(far.columns[0].values) = {0, 1, kMissing, 1e300, -1e300, 3, 4, 5, 6, 7, 8, 9};
  EXPECT_EQ(selected("within 1 of (chain A)", far), (Places{0, 1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(selected("within 1 of (x == 0)", far), (Places{0, 1})) << "a missing coordinate is near nothing";
}

TEST(PointsSelection, NearRowsAreThoseOfAllPairs) {
  Table table;
  std::vector<double> coordinates[3];
  std::uint64_t state = 1;
  for (int i = 0; i < 900; ++i) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    coordinates[i % 3].push_back(static_cast<double>(state >> 40) / (1 << 24) * 10 - 5);
  }
  table.rows = 300;
  table.columns = {Column{"x", coordinates[0]}, Column{"y", coordinates[1]}, Column{"z", coordinates[2]}};
  const Places others = selected("x * y > 5", table);
  ASSERT_GT(others.size(), 10u);
  for (const double distance : {0.3, 1.0, 2.7}) {
    Places expected;
    for (std::size_t row = 0; row < table.rows; ++row)
      if (std::any_of(others.begin(), others.end(), [&](std::size_t other) {
            double square = 0;
            for (const auto& axis : coordinates) square += (axis[row] - axis[other]) * (axis[row] - axis[other]);
            return square <= distance * distance;
          }))
        expected.push_back(row);
    EXPECT_EQ(selected("within " + std::to_string(distance) + " of (x * y > 5)", table), expected) << distance;
  }
}

TEST(PointsSelection, RowsOfTheSameGroup) {
  const Table table = residues();
  EXPECT_EQ(selected("same residue as (x == 2)", table), (Places{2, 3})) << "not those of the other chain";
  EXPECT_EQ(selected("same chain as (x == 2)", table), (Places{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(selected("same residue_number as (x == 2)", table), (Places{2, 3, 8, 9}));
  EXPECT_EQ(selected("same residue as (within 1 of (x == 1))", table), (Places{0, 1, 2, 3}));
}

TEST(PointsSelection, FaultsOfRowsByOthers) {
  const Table table = residues();
  for (const auto& [text, fault] :
       {std::pair("within of (x == 1)", "expected a number"), std::pair("within 0 of (x == 1)", "above 0"),
        std::pair("within 5 (x == 1)", "expected `of`"), std::pair("within 5 of x", "expects a condition"),
        std::pair("same residue (x == 1)", "expected `as`"),
        std::pair("same molecule as (x == 1)", "unknown column molecule")}) {
    try {
      selected(text, table);
      ADD_FAILURE() << text;
    } catch (const base::Error& error) {
      EXPECT_TRUE(test::mentions(fault_text(error), {fault})) << text << ": " << fault_text(error);
    }
  }
}

}  // namespace
}  // namespace orrery::points
