// SPDX-License-Identifier: Apache-2.0
// What users start as `orrery`: it becomes the program, once no signal can end it for want of a handler. Loading the
// program's libraries takes some tenths of a second, in which USR1, sent by a supervisor, would end a process that is
// about to handle it. Blocked, the signal waits; prepare_signals lets it through.
//
// It uses the C library alone, so that it is there within a millisecond.
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <climits>
#include <unistd.h>

int main(int, char** argv) {
  sigset_t snapshot;
  sigemptyset(&snapshot);
  sigaddset(&snapshot, SIGUSR1);
  sigprocmask(SIG_BLOCK, &snapshot, nullptr);

  char path[PATH_MAX];
  const ssize_t size = readlink("/proc/self/exe", path, sizeof(path) - 1);
  constexpr char kProgram[] = ORRERY_PROGRAM_FROM_LAUNCHER;
  char* const folder_end = size > 0 ? (path[size] = '\0', std::strrchr(path, '/')) : nullptr;
  if (folder_end != nullptr && static_cast<std::size_t>(folder_end + 1 - path) + sizeof(kProgram) <= sizeof(path)) {
    std::memcpy(folder_end + 1, kProgram, sizeof(kProgram));
    execv(path, argv);
  }
  std::perror("orrery: cannot start its program, which is installed with it as " ORRERY_PROGRAM_FROM_LAUNCHER);
  return EXIT_FAILURE;
}
