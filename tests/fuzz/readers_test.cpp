// SPDX-License-Identifier: Apache-2.0
#include "fuzz/readers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "fuzz/mutator.h"
#include "support/temp_dir.h"

namespace orrery::fuzz {
namespace {

using Fault = std::string (*)(const std::filesystem::path&, const std::string&);

/// Contents of the files of a corpus folder, sorted by name.
std::vector<std::string> seeds_of(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<std::string> seeds;
  for (const auto& file : files) seeds.push_back(support::file_bytes(file));
  return seeds;
}
std::filesystem::path corpus() { return ORRERY_CORPUS; }

std::vector<std::string> scene_words() {
  return {"[",
          "]",
          "[[",
          "]]",
          "{",
          "}",
          "=",
          ".",
          "\"",
          "\"\"\"",
          "'",
          "'''",
          "#",
          "\n",
          ",",
          "nan",
          "inf",
          "-inf",
          "1e400",
          "-0.0",
          "1e18",
          "1e-30",
          "0x10",
          "-1",
          "2147483648",
          "\xff",
          "\xC3\xBC",
          "[sphere]",
          "a.b.c",
          "[camera]",
          "[points]",
          "vfov",
          "\\u",
          "1979-05-27",
          "[[material]]",
          "true",
          "sphere",
          "type",
          "metal",
          "material",
          std::string(1, '\0')};
}
std::vector<std::string> ply_words() {
  return {"element vertex 99999999999999999999\n",
          "element vertex 1000000000000\n",
          "element vertex -1\n",
          "property list uchar int a\n",
          "property list double double a\n",
          "property double x\n",
          "format ascii 1.0\n",
          "format ascii 2.0\n",
          "format binary_big_endian 1.0\n",
          "end_header\n",
          "comment ",
          "\r\n",
          "\n",
          " ",
          "nan",
          "1e999",
          "-",
          "ply\n",
          std::string(4, '\0'),
          std::string(8, '\xff')};
}

void expect_no_fault(Fault fault, const std::string& bytes, const std::string& what) {
  static const support::TempDir folder;
  const std::string told = fault(folder.path(), bytes);
  EXPECT_EQ(told, "") << what << ", " << bytes.size() << " bytes:\n" << bytes.substr(0, 2000);
}

void expect_no_fault_with_mutants(Fault fault, Mutator mutator, int count) {
  for (int i = 0; i < count && !testing::Test::HasFailure(); ++i)
    expect_no_fault(fault, mutator.mutant(), "mutant " + std::to_string(i));
}

void expect_no_fault_with_noise(Fault fault, std::uint64_t seed, int count, const std::string& begin = {}) {
  Mutator mutator(seed, {""}, {""});
  for (int i = 0; i < count && !testing::Test::HasFailure(); ++i)
    expect_no_fault(fault, begin + mutator.noise(300), "noise " + std::to_string(i));
}

TEST(FuzzReaders, CorpusPasses) {
  const support::TempDir folder;
  for (const std::string& seed : seeds_of(corpus() / "scene")) EXPECT_EQ(fault_with_scene(folder.path(), seed), "");
  for (const std::string& seed : seeds_of(corpus() / "ply")) EXPECT_EQ(fault_with_ply(folder.path(), seed), "");
  for (const std::string& seed : seeds_of(corpus() / "override"))
    EXPECT_EQ(fault_with_overrides(folder.path(), seed), "");
}

TEST(FuzzReaders, RandomBytesAsScene) { expect_no_fault_with_noise(fault_with_scene, 1, 3000); }

TEST(FuzzReaders, RandomBytesAsPly) { expect_no_fault_with_noise(fault_with_ply, 2, 3000); }

TEST(FuzzReaders, RandomBytesAfterAValidHeader) {
  const std::string properties =
      "property float x\nproperty float y\nproperty float z\nproperty double radius\nend_header\n";
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"})
    expect_no_fault_with_noise(fault_with_ply, 3, 1000,
                               std::string("ply\nformat ") + format +
                                   " 1.0\nelement face 1\nproperty list uchar uchar c\n" + "element vertex 3\n" +
                                   properties);
}

TEST(FuzzReaders, RandomBytesAsOverrides) { expect_no_fault_with_noise(fault_with_overrides, 4, 3000); }

TEST(FuzzReaders, MutatedScenes) {
  std::vector<std::string> seeds = seeds_of(corpus() / "scene");
  expect_no_fault_with_mutants(fault_with_scene, Mutator(5, seeds, scene_words()), 6000);
}

TEST(FuzzReaders, MutatedPlyFiles) {
  expect_no_fault_with_mutants(fault_with_ply, Mutator(6, seeds_of(corpus() / "ply"), ply_words()), 10000);
}

TEST(FuzzReaders, MutatedOverrides) {
  expect_no_fault_with_mutants(fault_with_overrides, Mutator(7, seeds_of(corpus() / "override"), scene_words()), 6000);
}

/// UTF-8 encoding of a character from U+0800 to U+FFFF.
std::string character(unsigned code) {
  return {static_cast<char>(0xE0 | code >> 12), static_cast<char>(0x80 | (code >> 6 & 63)),
          static_cast<char>(0x80 | (code & 63))};
}

// Non-ASCII characters are valid in strings and comments only. The library's tables of blanks have gaps: see run.sh.
TEST(FuzzReaders, NonAsciiLettersOutsideStrings) {
  for (unsigned code = 0x0800; code <= 0x3100 && !testing::Test::HasFailure(); ++code) {
    const std::string letter = character(code);
    expect_no_fault(fault_with_scene, "camera.vfov =" + letter + "30\n" + letter + "[camera]\n", "letter");
    expect_no_fault(fault_with_overrides, "camera.vfov=" + letter + "\nrender.precision=" + letter + "fast", "letter");
  }
}

// Shows that the checks can fail.
TEST(FuzzReaders, FaultsAreDetected) {
  const support::TempDir folder;
  EXPECT_EQ(
      fault_with_scene(folder.path() / "none", ""),
      "not bad data: cannot open " + (folder.path() / "none" / "scene.toml").string() + ": No such file or directory");
}

}  // namespace
}  // namespace orrery::fuzz
