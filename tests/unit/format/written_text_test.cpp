// SPDX-License-Identifier: Apache-2.0
#include "format/written_text.h"

#include <gtest/gtest.h>

#include <string>

#include "base/error.h"
#include "support/temp_dir.h"

namespace orrery::format {
namespace {

std::string refusal(const std::string& bytes) {
  const support::TempDir folder;
  support::write_bytes(folder / "a.toml", bytes);
  try {
    check_unedited(folder / "a.toml");
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kCannotCreate);
    return error.what();
  }
  return "";
}

TEST(FormatWrittenText, AMarkedTextIsAComment) {
  const std::string text = marked_text("[image]\n");
  EXPECT_TRUE(text.starts_with("# Written by orrery")) << text;
  EXPECT_TRUE(text.ends_with("\n[image]\n")) << text;
  EXPECT_EQ(text, marked_text("[image]\n"));
}

TEST(FormatWrittenText, UneditedAndMissingFilesMayBeReplaced) {
  EXPECT_EQ(refusal(marked_text("[image]\nwidth = 3\n")), "");
  EXPECT_EQ(refusal(marked_text("")), "");
  const support::TempDir folder;
  EXPECT_NO_THROW(check_unedited(folder / "none.toml"));
}

TEST(FormatWrittenText, EditedAndForeignFilesMayNot) {
  const std::string text = marked_text("[image]\nwidth = 3\n");
  for (const std::string& edited : {text + "\n", text.substr(0, text.size() - 1), text + "# note\n"})
    EXPECT_NE(refusal(edited).find("edited since orrery wrote it"), std::string::npos) << edited;
  std::string digit = text;
  digit[digit.find('\n') - 1] ^= 1;
  EXPECT_NE(refusal(digit).find("edited since orrery wrote it"), std::string::npos) << digit;
  for (const std::string& foreign : {std::string("[image]\nwidth = 3\n"), std::string(), "\n" + text})
    EXPECT_NE(refusal(foreign).find("not written by orrery"), std::string::npos) << foreign;
}

}  // namespace
}  // namespace orrery::format
