// SPDX-License-Identifier: Apache-2.0
#include "cli/output.h"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "base/exit_status.h"

namespace orrery::cli {

void print_result(const std::string& text) {
  // What stdio holds back is only known to have arrived once it is flushed.
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
    throw base::Error(base::ErrorKind::kIo, std::string("writing to standard output failed: ") + std::strerror(errno));
}

int print_error(const base::Error& error) {
  for (const base::Finding& finding : error.findings()) std::fputs(base::formatted(finding).c_str(), stderr);
  std::fprintf(stderr, "orrery: %s\n", error.what());
  return base::exit_status(error.kind());
}

}  // namespace orrery::cli
