// SPDX-License-Identifier: Apache-2.0
#include "job/text.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace orrery::job {
namespace {

TEST(JobText, JsonAcceptsFileNamesThatAreNotUtf8) {
  const std::string text = json_text({{"file", "a\xff.toml"}});
  EXPECT_EQ(text, "{\n  \"file\": \"a\xEF\xBF\xBD.toml\"\n}\n");
}

}  // namespace
}  // namespace orrery::job
