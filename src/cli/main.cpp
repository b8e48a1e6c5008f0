// SPDX-License-Identifier: Apache-2.0
#include <sys/prctl.h>
#include <unistd.h>

#include <cstdio>

#include "cli/run.h"

int main(int argc, char** argv) {
  prctl(PR_SET_NAME, "orrery");  // so that ps and killall show the launcher's name, not the program file's
  const int status = orrery::cli::run(argc, argv);
  // Without destructors of static objects: none has anything to do, and those of OpenImageIO's 260 libraries take long,
  // and would wait until a thread has loaded them, although the program has found an error.
  std::fflush(nullptr);
  _exit(status);
}
