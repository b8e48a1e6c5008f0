// SPDX-License-Identifier: Apache-2.0
#include "format/source_text.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <thread>

#include "base/error.h"
#include "support/scratch_folder.h"

namespace orrery::format {
namespace {

std::string line_of(const SourceText& source, int line) {
  return source.finding(base::Severity::kError, {"a", line, 1, 1}, "x").source_line;
}

TEST(FormatSourceText, FindsEveryLine) {
  std::string text;
  for (int i = 1; i <= 500; ++i) text += "line " + std::to_string(i) + (i % 2 == 0 ? "\r\n" : "\n");
  SourceText source;
  source.add("a", text + "last");
  for (int i = 1; i <= 500; ++i) EXPECT_EQ(line_of(source, i), "line " + std::to_string(i));
  EXPECT_EQ(line_of(source, 501), "last");
  EXPECT_EQ(line_of(source, 502), "");
  EXPECT_EQ(line_of(source, 100000), "");
}

TEST(FormatSourceText, AddsLinesBehindOthers) {
  SourceText source;
  source.add("a", "one");
  EXPECT_EQ(line_of(source, 1), "one");
  source.add("a", "two");
  EXPECT_EQ(line_of(source, 2), "two") << "also after it has been asked";
  for (int i = 3; i < 200; ++i) source.add("a", std::to_string(i));
  EXPECT_EQ(line_of(source, 199), "199");
  source.add("b", "other");
  EXPECT_EQ(line_of(source, 200), "");
}

TEST(FormatSourceText, CharactersBecomeBytes) {
  SourceText source;
  source.add("a", "\xC3\xBC = \xE2\x82\xAC\xE2\x82\xAC\n");
  const base::Finding f = source.finding(base::Severity::kWarning, {"a", 1, 5, 2}, "text", "remedy");
  EXPECT_EQ(f.column, 6);
  EXPECT_EQ(f.width, 6);
  EXPECT_EQ(f.severity, base::Severity::kWarning);
  EXPECT_EQ(f.text, "text");
  EXPECT_EQ(f.remedy, "remedy");
}

TEST(FormatSourceText, APlaceBehindTheEndOfALine) {
  SourceText source;
  source.add("a", "ab\n");
  const base::Finding f = source.finding(base::Severity::kError, {"a", 1, 3, 1}, "text");
  EXPECT_EQ(f.column, 3);
  EXPECT_EQ(f.source_line, "ab");
}

TEST(FormatSourceText, TextsWithoutAPlaceHaveNoLine) {
  SourceText source;
  source.add("a", "one");
  EXPECT_EQ(source.finding(base::Severity::kError, {"a", 0, 0, 1}, "x").source_line, "");
  EXPECT_EQ(source.finding(base::Severity::kError, {"none", 1, 1, 1}, "x").source_line, "");
}

TEST(FormatSourceText, AVeryLongLineIsNotShown) {
  SourceText source;
  source.add("a", std::string(401, 'x') + "\n" + std::string(400, 'y'));
  EXPECT_EQ(line_of(source, 1), "");
  EXPECT_EQ(line_of(source, 2), std::string(400, 'y'));
}

TEST(FormatSourceText, ReadsAFileWhole) {
  const support::ScratchFolder folder;
  const std::string bytes("a\0\r\n\xff", 5);
  support::write_bytes(folder / "a", bytes);
  EXPECT_EQ(read_file(folder / "a", 5), bytes);
  support::write_bytes(folder / "empty", "");
  EXPECT_EQ(read_file(folder / "empty", 5), "");
}

TEST(FormatSourceText, ALargerFileThanAllowedIsBadData) {
  const support::ScratchFolder folder;
  support::write_bytes(folder / "a", std::string((1 << 20) + 1, 'x'));
  try {
    read_file(folder / "a", 1 << 20);
    FAIL() << "no error";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kBadData);
    EXPECT_NE(std::string(error.what()).find("larger than the 1 MiB"), std::string::npos) << error.what();
  }
}

TEST(FormatSourceText, APipeIsReadToItsEndAndNoFurtherThanAllowed) {
  const support::ScratchFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  const std::string text(200000, 'x');
  const auto read_from_pipe = [&](std::uint64_t largest) {
    std::thread writer([&] { std::ofstream(folder / "pipe") << text; });
    std::string read;
    try {
      read = read_file(folder / "pipe", largest);
    } catch (const base::Error& error) {
      read = error.kind() == base::ErrorKind::kBadData ? "too large" : "other";
    }
    writer.join();
    return read;
  };
  EXPECT_EQ(read_from_pipe(1 << 20), text);
  EXPECT_EQ(read_from_pipe(199999), "too large");
}

}  // namespace
}  // namespace orrery::format
