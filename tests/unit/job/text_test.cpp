// SPDX-License-Identifier: Apache-2.0
#include "job/text.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace orrery::job {
namespace {

TEST(JobText, AppendTakesAnyLength) {
  const std::string word(5000, 'x');
  std::string out = "a ";
  base::append(out, "%s %d", word.c_str(), 42);
  EXPECT_EQ(out, "a " + word + " 42");
  base::append(out, "%s", "");
  EXPECT_EQ(out, "a " + word + " 42");
}

TEST(JobText, BytesHaveTheLargestUnitAboveOne) {
  EXPECT_EQ(base::bytes_text(0), "0.0 KiB");
  EXPECT_EQ(base::bytes_text(1536), "1.5 KiB");
  EXPECT_EQ(base::bytes_text(1024 * 1024), "1.0 MiB");
  EXPECT_EQ(base::bytes_text(5ull << 40), "5.0 TiB");
  EXPECT_EQ(base::bytes_text(5ull << 50), "5120.0 TiB");
}

TEST(JobText, JsonAcceptsFileNamesThatAreNotUtf8) {
  const std::string text = json_text({{"file", "a\xff.toml"}});
  EXPECT_EQ(text, "{\n  \"file\": \"a\xEF\xBF\xBD.toml\"\n}\n");
}

}  // namespace
}  // namespace orrery::job
