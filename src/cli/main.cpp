// SPDX-License-Identifier: Apache-2.0
#include <sys/prctl.h>

#include "cli/run.h"

int main(int argc, char** argv) {
  prctl(PR_SET_NAME, "orrery");  // ps and killall show the launcher's name, not that of the program's file
  return orrery::cli::run(argc, argv);
}
