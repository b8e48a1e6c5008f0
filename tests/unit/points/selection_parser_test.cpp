// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "six_atoms.h"
#include "support/mentions.h"

namespace orrery::points {
namespace {

TEST(PointsSelectionParser, PrecedenceIsThatOfC) {
  EXPECT_EQ(selected_rows("type == 1 || type == 2 && z > 0"), "0234");
  EXPECT_EQ(selected_rows("(type == 1 || type == 2) && z > 1"), "34");
  EXPECT_EQ(selected_rows("1 + 2 * 3 == 7"), "012345");
  EXPECT_EQ(selected_rows("8 - 4 - 2 == 2 && 8 / 4 / 2 == 1"), "012345") << "from the left";
  EXPECT_EQ(selected_rows("-x * -1 > 1 - -1"), "3");
  EXPECT_EQ(selected_rows("!(type == 2) && !(z > 2)"), "03");
  EXPECT_EQ(selected_rows("!!(type == 2)"), "124");
}

TEST(PointsSelectionParser, NamesWithIndicesDotsAndBackquotes) {
  EXPECT_EQ(selected_rows("c_stress[1] > 4"), "45");
  EXPECT_EQ(selected_rows("v.x>4"), "01");
  EXPECT_EQ(selected_rows("`Potential Energy` < -5"), "5");
  EXPECT_EQ(selected_rows("`c_stress[1]`==1"), "0");
  EXPECT_EQ(parse_selection("z > 1 && type in [1] && `Potential Energy` < z", columns_of(six_atoms())).columns,
            (std::vector<std::string>{"z", "type", "Potential Energy"}));
}

TEST(PointsSelectionParser, UnknownColumnsAreReportedWithThoseThatExist) {
  EXPECT_TRUE(test::mentions(message("z > 0 && typ == 2"), {"10+3", "column", "`type`"}));
  EXPECT_NE(message("charge > 0").find("columns are x, z, type, id"), std::string::npos);
  EXPECT_NE(message("element == Xe").find("strings are quoted: \"Xe\""), std::string::npos);
}

TEST(PointsSelectionParser, TypesAreChecked) {
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

TEST(PointsSelectionParser, SyntaxErrorsHavePositionAndRemedy) {
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
  EXPECT_EQ(selection_fault("z >").source_line, "z >");
}

TEST(PointsSelectionParser, OperatorsMayBeWords) {
  for (const auto& [words, symbols] :
       {std::pair("type == 2 and z > 0 or id == 60", "type == 2 && z > 0 || id == 60"),
        std::pair("not z > 2 and not type==1", "!(z > 2) && !(type == 1)"), std::pair("!z > 2", "!(z > 2)"),
        std::pair("!!(z > 2)", "z > 2"), std::pair("element == 'C'or z<0", "element == 'C' || z < 0")}) {
    EXPECT_EQ(selected_rows(words), selected_rows(symbols)) << words;
    EXPECT_NE(selected_rows(words), "") << words;
  }
  EXPECT_TRUE(test::mentions(message("type == 2 and"), {"14+1", "== 2", "> 0"}));
  EXPECT_TRUE(test::mentions(message("z && not type").substr(0, 42), {"10+4", "expects", "condition"}));
}

TEST(PointsSelectionParser, ValuesMayFollowAColumn) {
  for (const auto& [values, list] :
       {std::pair("element C", "element == 'C'"), std::pair("element C \"N\"", "element in {C, N}"),
        std::pair("element C+N and type 2", "element in {C, N} && type == 2"), std::pair("type 2", "type == 2"),
        std::pair("id 10 30:40", "id in [10, 30:40]"), std::pair("id 10-20+50 to 60", "id in [10:20, 50:60]"),
        std::pair("not (element C)", "element != 'C'"), std::pair("id 50:", "id >= 50")}) {
    EXPECT_EQ(selected_rows(values), selected_rows(list)) << values;
    EXPECT_NE(selected_rows(values), "") << values;
  }
  EXPECT_TRUE(test::mentions(message("element C+"), {"11+1", "[1, 2]", "[20:60]", "{A"}));
  EXPECT_TRUE(test::mentions(message("id 3+"), {"6+1", "[1, 2]", "[20:60]", "{A"}));
  EXPECT_EQ(message("id 60-20").substr(0, 20), "4+5 the range is emp");
  EXPECT_EQ(message("2 * id 3").substr(0, 21), "5+2 * expects a numbe");
  EXPECT_EQ(message("type C").substr(0, 24), "6+1 expected an operator");
}

TEST(PointsSelectionParser, HostileSelectionsAreRefusedOrEvaluated) {
  const std::size_t many = 100'000;
  EXPECT_NE(message(std::string(many, '(')).find("more than 100 nested"), std::string::npos);
  EXPECT_NE(message(std::string(many, '!')).find("the condition ends too early"), std::string::npos);
  EXPECT_NE(message(std::string(many, '-')).find("more than 100 nested"), std::string::npos);
  EXPECT_NE(message(std::string(2'000'000, ' ')).find("longer than"), std::string::npos);
  // Chains are as long as the text: no recursion.
  std::string chain = "type == 1";
  for (std::size_t i = 0; i < 50'000; ++i) chain += "||x>9";
  EXPECT_EQ(selected_rows(chain), "03");
  std::string nested = "z > 2";
  for (int i = 0; i < 49; ++i) nested = "(x == 0 || (" + nested + "))";
  EXPECT_EQ(selected_rows(nested), "045");
}

}  // namespace
}  // namespace orrery::points
