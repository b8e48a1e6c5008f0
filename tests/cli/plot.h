// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "cli/program.h"

namespace orrery::test {

/// A frame of particles with the columns id type x y z radius vx.
inline std::string frame(const std::vector<std::string>& rows) {
  std::string out = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n" + std::to_string(rows.size()) +
                    "\nITEM: BOX BOUNDS pp pp pp\n0 10\n0 10\n0 10\nITEM: ATOMS id type x y z radius vx\n";
  for (const std::string& row : rows) out += row + "\n";
  return out;
}

class PlotTest : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write("a.dump", frame({"1 1 0 0 0 1 0", "2 2 3 0 0 1 1"}) + frame({"1 1 0 0 1 1 2", "2 2 3 0 0 1 3"}));
    write("c.csv", "x,y,z,radius,q\n0,0,0,1,0\n3,0,0,1,1\n");
  }

  /// Runs `orrery plot ARGUMENTS` for a small image.
  Outcome plot(const std::string& arguments) { return run("plot " + arguments + " --width 16 --height 9 --samples 1"); }
  void expect_error(const std::string& arguments, int status, const std::string& part) {
    const Outcome r = run(arguments);
    EXPECT_EQ(r.status, status) << arguments << ": " << r.err;
    EXPECT_TRUE(contains(r.err, part)) << arguments << ": " << r.err;
  }
};

}  // namespace orrery::test
