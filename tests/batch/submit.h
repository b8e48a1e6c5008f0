// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cli/program.h"

namespace orrery::test {

class SubmitTest : public ProgramTest {
 protected:
  std::string submit(const std::string& words) {
    const Outcome r = run("submit good.toml " + words);
    EXPECT_EQ(r.status, 0) << r.err;
    return r.out;
  }
};

}  // namespace orrery::test
