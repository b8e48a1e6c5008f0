// SPDX-License-Identifier: Apache-2.0
// The executable `orrery`: prepares what only exec can change, and executes the program.
//
// Links only the C library, so that it runs within a millisecond.
#include <algorithm>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <initializer_list>

#include <unistd.h>

#include "cli/launcher.h"

namespace orrery::cli {
namespace {

/// Blocks USR1. While the program's libraries are being loaded, no handler is installed, and a supervisor's USR1 would
/// end the process. The blocked signal stays pending until prepare_signals unblocks it.
void block_checkpoint_requests() {
  sigset_t usr1;
  sigemptyset(&usr1);
  sigaddset(&usr1, SIGUSR1);
  sigprocmask(SIG_BLOCK, &usr1, nullptr);
}

/// glibc requests huge pages for its heap. A start without them is half page faults, most in OpenImageIO's table of
/// strings. Without effect before glibc 2.35 and where the system denies them. The program removes the variable.
void use_huge_pages() { setenv(kTunablesName, kTunables, 0); }

/// Returns what this processor lacks of the least instruction set that the program is compiled for, or null.
const char* missing_instruction_set() {
#ifdef __x86_64__
  __builtin_cpu_init();
#ifdef ORRERY_SSE4
  if (!__builtin_cpu_supports("sse4.2") || !__builtin_cpu_supports("aes") || !__builtin_cpu_supports("pclmul"))
    return "SSE4.2, AES and PCLMUL";
#elif defined(ORRERY_AVX2)
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma") || !__builtin_cpu_supports("bmi2"))
    return "AVX2";
#else
  if (!__builtin_cpu_supports("avx512bw") || !__builtin_cpu_supports("avx512dq") || !__builtin_cpu_supports("avx512vl"))
    return "AVX-512";
#endif
#endif
  return nullptr;
}

/// Replaces this process by a program. In the archive for all systems, the program is started by the loader beside it,
/// that of its libraries.
///
/// `program`  its path, relative to the launcher's folder
/// Result     errno is set, if it cannot be executed
void execute(const char* program, int argc, char** argv) {
  char path[PATH_MAX], loader[PATH_MAX];
  const ssize_t size = readlink("/proc/self/exe", path, sizeof(path) - 1);
  if (size < 0) return;
  path[size] = '\0';
  char* const name = std::strrchr(path, '/') + 1;  // a path from the kernel is absolute
  if (std::strlen(program) >= sizeof(path) - static_cast<std::size_t>(name - path)) return;
  std::strcpy(name, program);
  const auto folder = static_cast<int>(std::strrchr(path, '/') - path);
  auto** const words = static_cast<char**>(std::calloc(static_cast<std::size_t>(argc) + 5, sizeof(char*)));
  if (words != nullptr && std::snprintf(loader, sizeof(loader), "%.*s/orrery-loader", folder, path) < PATH_MAX) {
    char inhibit_cache[] = "--inhibit-cache", argv0[] = "--argv0";
    char* const first[] = {loader, inhibit_cache, argv0, argv[0], path};
    std::copy_n(first, 5, words);
    std::copy_n(argv + 1, argc, words + 5);  // with the null at the end
    execv(loader, words);
    if (errno != ENOENT) return;
  }
  std::free(words);
  execv(path, argv);
}

}  // namespace
}  // namespace orrery::cli

int main(int argc, char** argv) {
  orrery::cli::block_checkpoint_requests();
  orrery::cli::use_huge_pages();
  if (const char* const missing = orrery::cli::missing_instruction_set()) {
    std::fprintf(stderr, "orrery: error: this processor lacks %s, for which this program was compiled\n", missing);
#ifndef ORRERY_SSE4
    std::fputs("Build it on this machine, or for all processors: cmake -DORRERY_ISAS=all\n", stderr);
#endif
    return 70;
  }
  for (const char* program : {ORRERY_INSTALLED_PROGRAM, ORRERY_BUILT_PROGRAM})
    orrery::cli::execute(program, argc, argv);
  const char* const why = std::strerror(errno);
  const bool has_proc = access("/proc/self/exe", F_OK) == 0;
  std::fprintf(stderr, "orrery: cannot start the program, which is installed as %s: %s%s\n", ORRERY_INSTALLED_PROGRAM,
               why, has_proc ? "" : "; it is found through /proc, which is not mounted");
  return 70;  // base::ErrorKind::kInternal; the launcher links no library of the project
}
