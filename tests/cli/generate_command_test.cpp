// SPDX-License-Identifier: Apache-2.0
// The command generate.
#include "cli/program.h"

namespace orrery::test {
namespace {

class CliGenerateCommand : public ProgramTest {};

TEST_F(CliGenerateCommand, GeneratedScenesRender) {
  ASSERT_EQ(run("generate final -o f.toml --grid 2 --seed 5").status, 0);
  ASSERT_EQ(run("generate cloud -o c.toml --count 500").status, 0);
  EXPECT_EQ(run("render f.toml -o f.png -q --width 32 --height 18 --samples 2").status, 0);
  EXPECT_EQ(run("render c.toml -o c.png -q --width 32 --height 18 --samples 2").status, 0);
  EXPECT_EQ(run("generate final -o g.toml --grid 5000").status, 2);
}

}  // namespace
}  // namespace orrery::test
