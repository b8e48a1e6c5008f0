// SPDX-License-Identifier: Apache-2.0
#include <sys/prctl.h>
#include <unistd.h>

#include <cstdio>

#include "cli/run.h"

int main(int argc, char** argv) {
  prctl(PR_SET_NAME, "orrery");  // so that ps and killall show the launcher's name, not the program file's
  const int status = orrery::cli::run(argc, argv);
  // Static objects are not destroyed. None of ours does anything then; those of OpenImageIO's 260 libraries take time,
  // and would wait for the thread that loads them even if the program has already found an error.
  std::fflush(nullptr);
  _exit(status);
}
