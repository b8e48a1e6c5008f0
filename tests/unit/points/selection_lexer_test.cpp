// SPDX-License-Identifier: Apache-2.0
#include "points/selection_lexer.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "base/error.h"
#include "points/selection.h"

namespace orrery::points {
namespace {

/// The tokens of a selection, separated by spaces: each with a letter for its kind.
std::string tokens_of(const std::string& text, bool takes_words = false) {
  SelectionLexer lexer(text);
  std::string out;
  for (Token token = lexer.next(takes_words); token.kind != TokenKind::kEnd; token = lexer.next(takes_words)) {
    constexpr char kKinds[] = {'e', 'n', 't', 'w', 'q', 's'};
    out += std::string(out.empty() ? "" : " ") + kKinds[static_cast<std::size_t>(token.kind)] + ':';
    out += token.kind == TokenKind::kNumber ? text.substr(token.span.begin, token.span.end - token.span.begin)
                                            : std::string(token.text);
  }
  return out;
}

/// The place of the error in a selection that cannot be read: first and last byte.
std::pair<int, int> fault_in(const std::string& text) {
  try {
    tokens_of(text);
  } catch (const base::Error& error) {
    const base::Diagnostic d = error.diagnostics().at(0);
    EXPECT_FALSE(d.remedy.empty()) << text;
    return {d.column, d.column + d.width - 1};
  }
  return {0, 0};
}

TEST(PointsSelectionLexer, TokensOfAllKinds) {
  EXPECT_EQ(tokens_of("z<=-1.5e3&&!(`a b` != 'C')"), "w:z s:<= s:- n:1.5e3 s:&& s:! s:( q:a b s:!= t:C s:)");
  EXPECT_EQ(tokens_of(" \t\n"), "");
  EXPECT_EQ(tokens_of("größe > .5"), "w:größe s:> n:.5") << "bytes beyond ASCII are letters";
}

TEST(PointsSelectionLexer, AnIndexIsPartOfAName) {
  EXPECT_EQ(tokens_of("c_stress[1] in[1]"), "w:c_stress[1] w:in s:[ n:1 s:]");
  EXPECT_EQ(tokens_of("v[1:2]"), "w:v s:[ n:1 s:: n:2 s:]") << "a range is no index";
}

TEST(PointsSelectionLexer, WordsMayBeginWithADigitWhereTheyAreExpected) {
  EXPECT_EQ(tokens_of("1ABC +", true), "w:1ABC s:+");
  EXPECT_EQ(fault_in("x == 1ABC"), (std::pair{6, 9}));
}

TEST(PointsSelectionLexer, ErrorsHaveAPlace) {
  EXPECT_EQ(fault_in("x == 'C"), (std::pair{6, 7}));
  EXPECT_EQ(fault_in("x > ``"), (std::pair{5, 6}));
  EXPECT_EQ(fault_in("x > 1e999"), (std::pair{5, 9}));
  EXPECT_EQ(fault_in("x = 1"), (std::pair{3, 3}));
  EXPECT_EQ(fault_in("x # 1"), (std::pair{3, 3}));
}

TEST(PointsSelectionLexer, ParenthesesAreClosed) {
  EXPECT_NO_THROW(require_closed("(x > 0) && chain in {A, 1B}"));
  EXPECT_THROW(require_closed("(x > 0"), base::Error);
  EXPECT_THROW(require_closed("x > 0) || (y > 0"), base::Error);
}

}  // namespace
}  // namespace orrery::points
