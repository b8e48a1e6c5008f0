// SPDX-License-Identifier: Apache-2.0
#include <sys/prctl.h>

#include <cstdlib>
#include <string_view>

#include "cli/launcher.h"
#include "cli/run.h"

int main(int argc, char** argv) {
  // The C library has read the variable. Programs that this one starts do not inherit it.
  const char* const tunables = std::getenv(orrery::cli::kTunablesName);
  if (tunables != nullptr && std::string_view(tunables) == orrery::cli::kTunables) unsetenv(orrery::cli::kTunablesName);
  prctl(PR_SET_NAME, "orrery");  // so that ps and killall show the launcher's name, not the program file's
  return orrery::cli::run(argc, argv);
}
