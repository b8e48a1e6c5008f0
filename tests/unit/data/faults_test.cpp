// SPDX-License-Identifier: Apache-2.0
#include "data/faults.h"

#include <gtest/gtest.h>

#include <string>

#include "base/error.h"

namespace orrery::data {
namespace {

/// The diagnostics of the error that `raise` throws.
template <class Raise>
std::vector<base::Diagnostic> diagnostics_of(Raise raise) {
  try {
    raise();
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kBadData);
    EXPECT_NE(std::string(error.what()).find("a.csv"), std::string::npos);
    return error.diagnostics();
  }
  ADD_FAILURE() << "no error";
  return {};
}

TEST(DataFaults, NoneIsNoError) {
  Faults faults("a.csv");
  EXPECT_FALSE(faults.has_any());
  faults.raise_if_any();
}

TEST(DataFaults, AllAreThrownWithTheirLines) {
  Faults faults("a.csv");
  faults.add(3, "first");
  const auto found = diagnostics_of([&] { faults.fail(7, "second", "mend it"); });
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].line, 3);
  EXPECT_EQ(found[1].line, 7);
  EXPECT_EQ(found[1].text, "second");
  EXPECT_EQ(found[1].remedy, "mend it");
}

TEST(DataFaults, OfManyTenAreListedAndAllCounted) {
  Faults faults("a.csv");
  for (std::uint64_t line = 1; line <= 25; ++line) faults.add_of_many(line, "bad");
  const auto found = diagnostics_of([&] { faults.raise_if_any(); });
  ASSERT_EQ(found.size(), 11u);
  EXPECT_EQ(found[9].line, 10);
  EXPECT_NE(found[10].text.find("15"), std::string::npos);
  EXPECT_NE(found[10].text.find("25"), std::string::npos);
}

TEST(DataFaults, TakenTextIsTheFirstAndTheNumberOfTheOthers) {
  Faults faults("a.csv");
  for (std::uint64_t line = 4; line < 24; ++line) faults.add_of_many(line, "bad");
  const std::string text = faults.take_text();
  EXPECT_TRUE(text.starts_with("line 4: bad")) << text;
  EXPECT_NE(text.find("19"), std::string::npos) << text;
  EXPECT_FALSE(faults.has_any());
}

TEST(DataFaults, LongWordsAreCut) {
  EXPECT_EQ(quoted_word("abc"), "`abc`");
  EXPECT_EQ(quoted_word(std::string(41, 'x')), "`" + std::string(40, 'x') + "...`");
}

}  // namespace
}  // namespace orrery::data
