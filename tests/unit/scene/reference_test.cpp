// SPDX-License-Identifier: Apache-2.0
#include "scene/schema.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "support/temp_dir.h"

namespace orrery::scene {
namespace {

constexpr const char* kBegin = "<!-- generated from the schema: begin -->\n";
constexpr const char* kEnd = "<!-- generated from the schema: end -->\n";

std::filesystem::path document() { return std::filesystem::path(ORRERY_ROOT) / "docs" / "scene-format.md"; }

// With ORRERY_UPDATE_DOCS in the environment, the test updates the document instead.
TEST(SceneReference, DocumentMatchesTheSchema) {
  const std::string text = support::file_bytes(document());
  const std::size_t begin = text.find(kBegin), end = text.find(kEnd);
  ASSERT_TRUE(begin != std::string::npos && end != std::string::npos) << document() << " has lost its markers";
  const std::size_t body = begin + std::string(kBegin).size();
  const std::string wanted = "\n" + reference_markdown() + "\n";
  if (std::getenv("ORRERY_UPDATE_DOCS") != nullptr) {
    support::write_bytes(document(), text.substr(0, body) + wanted + text.substr(end));
    return;
  }
  EXPECT_EQ(text.substr(body, end - body), wanted)
      << "run this test with ORRERY_UPDATE_DOCS=1 in the environment, and read what it changed";
}

TEST(SceneReference, RowsHaveRangeUnitDefaultAndCost) {
  const std::string text = reference_markdown();
  EXPECT_NE(text.find("| `vfov` | number | above 0 and below 180 | degrees | 90 |"), std::string::npos) << text;
  EXPECT_NE(text.find("| `samples` | integer | 1..2147483647 | per pixel | 100 | Paths per pixel | Time scales"),
            std::string::npos);
  EXPECT_NE(text.find("| `fresnel` | one of | `schlick, exact, none` | - | \"schlick\" |"), std::string::npos);
  EXPECT_NE(text.find("| `albedo` | [r, g, b] | each 0..1 | scene-linear | **required** |"), std::string::npos);
}

}  // namespace
}  // namespace orrery::scene
