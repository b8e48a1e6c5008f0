// SPDX-License-Identifier: Apache-2.0
#include <sys/prctl.h>

#include "cli/run.h"

int main(int argc, char** argv) {
  prctl(PR_SET_NAME, "orrery");  // so that ps and killall show the launcher's name, not the program file's
  return orrery::cli::run(argc, argv);
}
