// SPDX-License-Identifier: Apache-2.0
#include "cli/program.h"

namespace orrery::test {
namespace {

class CliMain : public ProgramTest {
 protected:
  /// Makes a film with a program in place of ffmpeg, which stores its variables and the name of the process that has
  /// started it.
  void make_film(const std::string& before) {
    write("a.csv", "x,y,z,radius\n0,0,0,1\n");
    std::filesystem::create_directory(folder_ / "looks");
    write("looks/ffmpeg",
          "#!/bin/sh\nenv > variables; cat /proc/$PPID/comm > starter; cat > /dev/null; for last; do :; done; "
          "echo film > \"${last#file:}\"\n");
    std::filesystem::permissions(folder_ / "looks/ffmpeg", std::filesystem::perms::owner_all);
    const Outcome r =
        run("plot a.csv -o a.mp4 --frames 1 --width 17 --height 9 --samples 1", before + " PATH=\"$PWD/looks:$PATH\"");
    ASSERT_EQ(r.status, 0) << r.err;
  }
};

TEST_F(CliMain, TheProcessHasTheNameOfTheCommand) {
  make_film("");
  EXPECT_EQ(text_of(folder_ / "starter"), "orrery\n");
}

TEST_F(CliMain, ProgramsThatItStartsDoNotInheritTheVariableOfTheLauncher) {
  make_film("unset GLIBC_TUNABLES &&");
  EXPECT_FALSE(contains(text_of(folder_ / "variables"), "GLIBC_TUNABLES"));
  make_film("GLIBC_TUNABLES=glibc.malloc.hugetlb=0");
  EXPECT_TRUE(contains(text_of(folder_ / "variables"), "GLIBC_TUNABLES=glibc.malloc.hugetlb=0")) << "of the user";
}

}  // namespace
}  // namespace orrery::test
