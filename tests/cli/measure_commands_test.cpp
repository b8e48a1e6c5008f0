// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace orrery::test {
namespace {

class CliBench : public ProgramTest {};

TEST_F(CliBench, PrintsOnlyATableOrJson) {
  const Outcome text = run("bench good.toml --rounds 1 --seconds 0.001");
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_TRUE(text.err.ends_with("\n100% done\n")) << text.err;
  EXPECT_NE(text.out.find("\nlist book "), std::string::npos) << text.out;
  const Outcome json = run("bench good.toml --rounds 1 --seconds 0.001 --json -q");
  EXPECT_EQ(json.status, 0) << json.err;
  EXPECT_EQ(json.err, "");
  EXPECT_EQ(nlohmann::json::parse(json.out)["cases"].size(), 7u);
  EXPECT_EQ(file_count(), 0);
}

TEST_F(CliBench, BadInputExitsWithDocumentedStatus) {
  EXPECT_EQ(run("bench none.toml").status, 66);
  EXPECT_EQ(run("bench good.toml --rounds 0").status, 2);
  EXPECT_EQ(run("bench good.toml", "ORRERY_ISA=mmx").status, 2);
  EXPECT_EQ(run("bench good.toml --set render.samples=0").status, 65);
}

TEST_F(CliBench, OptionsWithoutEffectAreRefused) {
  for (const char* option : {"--samples 1", "--precision fast", "--layers Z"}) {
    const Outcome r = run(std::string("bench good.toml ") + option);
    EXPECT_EQ(r.status, 2) << option;
    EXPECT_TRUE(contains(r.err, "unknown option")) << r.err;
  }
}

}  // namespace
}  // namespace orrery::test
