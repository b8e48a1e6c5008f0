// SPDX-License-Identifier: Apache-2.0
#include "points/selection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "support/mentions.h"

namespace orrery::points {
namespace {

using data::Column;
using data::Table;
using data::Words;

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

/// Six six_atoms with all types of columns.
Table six_atoms() {
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

std::vector<data::ColumnInfo> columns_of(const Table& table) {
  std::vector<data::ColumnInfo> out;
  for (const Column& column : table.columns) out.push_back({column.name, column.type()});
  return out;
}

std::vector<std::uint8_t> mask_of(const std::string& text, const Table& table) {
  return parse_selection(text, columns_of(table)).evaluate(table);
}

/// The selected rows as digits: "024".
std::string rows(const std::string& text, const Table& table = six_atoms()) {
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
base::Diagnostic fault(const std::string& text) {
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

std::string message(const std::string& text) {
  const base::Diagnostic d = fault(text);
  return std::to_string(d.column) + "+" + std::to_string(d.width) + " " + d.text + "; " + d.remedy;
}

TEST(PointsSelection, ComparesNumbersOfAllTypes) {
  EXPECT_EQ(rows("type == 2"), "124");
  EXPECT_EQ(rows("type != 2"), "035");
  EXPECT_EQ(rows("z < 1"), "12");
  EXPECT_EQ(rows("z <= 1"), "012");
  EXPECT_EQ(rows("z > 2"), "45");
  EXPECT_EQ(rows("z >= 2"), "345");
  EXPECT_EQ(rows("id == 30 || class == 255 || intensity == 65535"), "12");
  EXPECT_EQ(rows("2 == type"), "124");
}

TEST(PointsSelection, ComparesStrings) {
  EXPECT_EQ(rows("element == \"C\""), "025");
  EXPECT_EQ(rows("element != 'C'"), "134");
  EXPECT_EQ(rows("'CA' == element"), "3");
  EXPECT_EQ(rows("element == \"Zr\""), "");
  EXPECT_EQ(rows("element == label"), "015") << "indices of different dictionaries";
  EXPECT_EQ(rows("element != label"), "234");
}

TEST(PointsSelection, FindsInLists) {
  EXPECT_EQ(rows("type in [3, 1]"), "035");
  EXPECT_EQ(rows("x in [-5, 2]"), "25");
  EXPECT_EQ(rows("element in [\"N\", 'CA']"), "134");
  EXPECT_EQ(rows("!(element in[\"N\"])"), "0235");
  EXPECT_EQ(rows("id / 10 in [2]"), "1");
  EXPECT_EQ(rows("type in {3, 1}"), "035");
}

TEST(PointsSelection, FindsInClosedRanges) {
  EXPECT_EQ(rows("id in [20:40]"), "123");
  EXPECT_EQ(rows("id in [20.5:39.5]"), "2");
  EXPECT_EQ(rows("x in [-5:0]"), "05");
  EXPECT_EQ(rows("x in [-5:-1]"), "5");
  EXPECT_EQ(rows("id in [50:]"), "45");
  EXPECT_EQ(rows("id in [:20]"), "01");
  EXPECT_EQ(rows("id in [ 20 : 20 ]"), "1");
  EXPECT_EQ(rows("id in [10, 55:, 30:40, 35:45]"), "0235") << "lists may have ranges that overlap";
  EXPECT_EQ(rows("id in {10, 55:}"), "05");
  EXPECT_EQ(rows("x in [:]", six_atoms()), "01235") << "every number, but not NaN";
  EXPECT_EQ(rows("x in [:100]"), "01235");
}

TEST(PointsSelection, StringsInBracesNeedNoQuotes) {
  EXPECT_EQ(rows("element in {N, CA}"), "134");
  EXPECT_EQ(rows("element in{C}&&label in {'N', C}"), "05");
  Table table;
  table.rows = 4;
  table.columns = {Column{"chain", Words{{"A", "1", "2MG", "O5*"}, {0, 1, 2, 3}}}};
  EXPECT_EQ(rows("chain in {1, 2MG}", table), "12") << "digits are strings in a column of strings";
  EXPECT_EQ(rows("chain in {'O5*', A}", table), "03");
}

TEST(PointsSelection, PrecedenceIsThatOfC) {
  EXPECT_EQ(rows("type == 1 || type == 2 && z > 0"), "0234");
  EXPECT_EQ(rows("(type == 1 || type == 2) && z > 1"), "34");
  EXPECT_EQ(rows("1 + 2 * 3 == 7"), "012345");
  EXPECT_EQ(rows("8 - 4 - 2 == 2 && 8 / 4 / 2 == 1"), "012345") << "from the left";
  EXPECT_EQ(rows("-x * -1 > 1 - -1"), "3");
  EXPECT_EQ(rows("!(type == 2) && !(z > 2)"), "03");
  EXPECT_EQ(rows("!!(type == 2)"), "124");
}

TEST(PointsSelection, Functions) {
  EXPECT_EQ(rows("abs(x) == 5"), "5");
  EXPECT_EQ(rows("sqrt(id * 10) == 10"), "0");
  EXPECT_EQ(rows("min(z, 1, v.x) == 1"), "0345");
  EXPECT_EQ(rows("max(x, z) == 1"), "01");
  EXPECT_EQ(rows("sqrt(x * x + z * z) < 2"), "01");
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
  EXPECT_EQ(rows("type^2 == 4"), "124") << "in conditions, too";
  EXPECT_EQ(error_of_expression("x > 1"), "expected an arithmetic operator");
  EXPECT_EQ(error_of_expression("element"), "expected a number, not a string");
  EXPECT_EQ(error_of_expression("sqrt(y)"), "unknown column y");
  EXPECT_TRUE(test::mentions(error_of_expression("x ^"), {"condition", "early"}));
}

TEST(PointsSelection, NamesWithIndicesDotsAndBackquotes) {
  EXPECT_EQ(rows("c_stress[1] > 4"), "45");
  EXPECT_EQ(rows("v.x>4"), "01");
  EXPECT_EQ(rows("`Potential Energy` < -5"), "5");
  EXPECT_EQ(rows("`c_stress[1]`==1"), "0");
  EXPECT_EQ(parse_selection("z > 1 && type in [1] && `Potential Energy` < z", columns_of(six_atoms())).columns,
            (std::vector<std::string>{"z", "type", "Potential Energy"}));
}

TEST(PointsSelection, ComparisonsWithNanAreFalse) {
  for (const char* op : {"==", "!=", "<", "<=", ">", ">="}) {
    EXPECT_EQ(rows(std::string("x ") + op + " 0").find('4'), std::string::npos) << op;
    EXPECT_EQ(rows(std::string("0 ") + op + " x").find('4'), std::string::npos) << op;
  }
  EXPECT_EQ(rows("x in [0, 1, 2]"), "012");
  EXPECT_EQ(rows("min(x, 0) <= 0 || min(0, x) <= 0 || max(x, 0) >= 0 || max(0, x) >= 0"), "01235");
  EXPECT_EQ(rows("sqrt(x) >= 0"), "0123") << "the root of a negative number is NaN";
}

TEST(PointsSelection, EmptySelectsAll) {
  EXPECT_EQ(rows(""), "012345");
  EXPECT_EQ(rows(" \t\n"), "012345");
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

TEST(PointsSelection, UnknownColumnsAreReportedWithThoseThatExist) {
  EXPECT_TRUE(test::mentions(message("z > 0 && typ == 2"), {"10+3", "column", "`type`"}));
  EXPECT_NE(message("charge > 0").find("columns are x, z, type, id"), std::string::npos);
  EXPECT_NE(message("element == Xe").find("strings are quoted: \"Xe\""), std::string::npos);
}

TEST(PointsSelection, TypesAreChecked) {
  EXPECT_TRUE(test::mentions(message("z > 0 && element == 2"), {"10+7", "compared", "== \"C\""}));
  EXPECT_TRUE(test::mentions(message("type == \"2\""), {"9+3", "compared", "numbers"}));
  EXPECT_TRUE(test::mentions(message("element < 'C'"), {"11+3 <", "==", "!="}));
  EXPECT_TRUE(test::mentions(message("element in [1]"), {"1+7", "expects", "numbers"}));
  EXPECT_TRUE(test::mentions(message("type in ['1']"), {"1+4", "expects", "strings"}));
  EXPECT_EQ(message("type && z > 0").substr(0, 43), "1+4 && expects a condition, not a number; c");
  EXPECT_EQ(message("(z > 0) == (x > 0)").substr(0, 37), "9+2 a condition cannot be compared; c");
  EXPECT_EQ(message("!type").substr(0, 41), "2+4 ! expects a condition, not a number; ");
  EXPECT_TRUE(test::mentions(message("z"), {"1+1", "condition", "!= 0"}));
  EXPECT_TRUE(test::mentions(message("element"), {"1+7", "condition", "!= 0"}));
  EXPECT_EQ(message("'C' == 'C'").substr(0, 23), "5+2 two strings are com");
  EXPECT_EQ(message("abs(z > 0) == 1").substr(0, 9), "7+1 expec");
}

TEST(PointsSelection, SyntaxErrorsHavePositionAndRemedy) {
  EXPECT_EQ(message("type = 2"), "6+1 unknown operator =; equality is ==");
  EXPECT_EQ(message("type == 2 & z > 0"), "11+1 unknown operator &; write &&");
  EXPECT_TRUE(test::mentions(message("(z > 0"), {"1+1", "parenthesis", "closed"}));
  EXPECT_TRUE(test::mentions(message("z > 0)"), {"6+1", "expected", "parenthesis"}));
  EXPECT_TRUE(test::mentions(message("0 < z < 2"), {"7+1", "1 <", "< 2"}));
  EXPECT_TRUE(test::mentions(message("z >"), {"4+1", "== 2", "> 0"}));
  EXPECT_TRUE(test::mentions(message("element == \"C"), {"12+2", "quote", "closed"}));
  EXPECT_EQ(message("type in []").substr(0, 29), "10+1 expected a number or a s");
  EXPECT_EQ(message("type in 1").substr(0, 29), "9+1 expected a list after `in");
  EXPECT_TRUE(test::mentions(message("type in [1, 'a']").substr(0, 29), {"13+3", "numbers"}));
  EXPECT_TRUE(test::mentions(message("id in [60:20]"), {"8+5", "smaller", "[20:60]"}));
  EXPECT_EQ(message("id in [1:'a']").substr(0, 22), "10+3 expected , or ]; ");
  EXPECT_EQ(message("type in {C}").substr(0, 34), "10+1 expected a number or a string");
  EXPECT_EQ(message("element in [C]").substr(0, 34), "13+1 expected a number or a string");
  EXPECT_EQ(message("element in {C]").substr(0, 20), "14+1 expected , or }");
  EXPECT_TRUE(test::mentions(message("element in ['C', 2:]").substr(0, 29), {"18+1", "numbers"}));
  EXPECT_EQ(message("z : 1").substr(0, 24), "3+1 expected an operator");
  EXPECT_TRUE(test::mentions(message("floof(z) > 1"), {"1+5", "functions", "log10"}));
  EXPECT_EQ(message("abs(z, x) > 1").substr(0, 23), "1+3 abs with 2 operands");
  EXPECT_EQ(message("min(z) > 1").substr(0, 23), "1+3 min with 1 operands");
  EXPECT_TRUE(test::mentions(message("`` > 1"), {"1+2", "between", "backquotes"}));
  EXPECT_TRUE(test::mentions(message("z > 1e999"), {"5+5", "number", "1.8e308"}));
  EXPECT_EQ(message("2x > 1").substr(0, 23), "1+2 malformed number 2x");
  EXPECT_EQ(message("z > 0 # comment").substr(0, 26), "7+1 unexpected character; ");
  EXPECT_EQ(fault("z >").source_line, "z >");
}

TEST(PointsSelection, OperatorsMayBeWords) {
  for (const auto& [words, symbols] :
       {std::pair("type == 2 and z > 0 or id == 60", "type == 2 && z > 0 || id == 60"),
        std::pair("not z > 2 and not type==1", "!(z > 2) && !(type == 1)"), std::pair("!z > 2", "!(z > 2)"),
        std::pair("!!(z > 2)", "z > 2"), std::pair("element == 'C'or z<0", "element == 'C' || z < 0")}) {
    EXPECT_EQ(rows(words), rows(symbols)) << words;
    EXPECT_NE(rows(words), "") << words;
  }
  EXPECT_TRUE(test::mentions(message("type == 2 and"), {"14+1", "== 2", "> 0"}));
  EXPECT_TRUE(test::mentions(message("z && not type").substr(0, 42), {"10+4", "expects", "condition"}));
}

TEST(PointsSelection, ValuesMayFollowAColumn) {
  for (const auto& [values, list] :
       {std::pair("element C", "element == 'C'"), std::pair("element C \"N\"", "element in {C, N}"),
        std::pair("element C+N and type 2", "element in {C, N} && type == 2"), std::pair("type 2", "type == 2"),
        std::pair("id 10 30:40", "id in [10, 30:40]"), std::pair("id 10-20+50 to 60", "id in [10:20, 50:60]"),
        std::pair("not (element C)", "element != 'C'"), std::pair("id 50:", "id >= 50")}) {
    EXPECT_EQ(rows(values), rows(list)) << values;
    EXPECT_NE(rows(values), "") << values;
  }
  EXPECT_TRUE(test::mentions(message("element C+"), {"11+1", "[1, 2]", "[20:60]", "{A"}));
  EXPECT_TRUE(test::mentions(message("id 3+"), {"6+1", "[1, 2]", "[20:60]", "{A"}));
  EXPECT_EQ(message("id 60-20").substr(0, 20), "4+5 the range is emp");
  EXPECT_EQ(message("2 * id 3").substr(0, 21), "5+2 * expects a numbe");
  EXPECT_EQ(message("type C").substr(0, 24), "6+1 expected an operator");
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

TEST(PointsSelection, HostileSelectionsAreRefusedOrEvaluated) {
  const std::size_t many = 100'000;
  EXPECT_NE(message(std::string(many, '(')).find("more than 100 nested"), std::string::npos);
  EXPECT_NE(message(std::string(many, '!')).find("the condition ends too early"), std::string::npos);
  EXPECT_NE(message(std::string(many, '-')).find("more than 100 nested"), std::string::npos);
  EXPECT_NE(message(std::string(2'000'000, ' ')).find("longer than"), std::string::npos);
  // Chains are as long as the text: no recursion.
  std::string chain = "type == 1";
  for (std::size_t i = 0; i < 50'000; ++i) chain += "||x>9";
  EXPECT_EQ(rows(chain), "03");
  std::string nested = "z > 2";
  for (int i = 0; i < 49; ++i) nested = "(x == 0 || (" + nested + "))";
  EXPECT_EQ(rows(nested), "045");
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
