// SPDX-License-Identifier: Apache-2.0
#include "cli/output.h"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include <fmt/core.h>

#include "base/error.h"
#include "base/text.h"
#include "cli/messages.h"

namespace orrery::cli {

void print_result(const std::string& unchecked) {
  const std::string text = base::printable_lines(unchecked);
  // Names in files may contain control characters. Buffered output fails only when it is flushed.
  if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0) return;
  if (errno == EPIPE) return;
  throw base::Error(base::ErrorKind::kIo, std::string("writing to standard output failed: ") + std::strerror(errno));
}

std::string error_text(const base::Error& error) {
  std::string out;
  for (const base::Diagnostic& diagnostic : error.diagnostics()) out += base::formatted(diagnostic);
  return fmt::format("{}orrery: {}\n", out, base::printable_lines(error.what()));
}

int print_error(const base::Error& error) {
  print_message(error_text(error));
  return base::exit_status(error.kind());
}

}  // namespace orrery::cli
