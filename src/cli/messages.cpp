// SPDX-License-Identifier: Apache-2.0
#include "cli/messages.h"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "base/text.h"

namespace orrery::cli {
namespace {

bool is_json = false;

}  // namespace

void print_result(const std::string& unchecked) {
  const std::string text = base::printable_lines(unchecked);  // names in files may contain control characters
  // Buffered output fails only when it is flushed.
  if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0) return;
  if (errno == EPIPE) return;
  throw base::Error(base::ErrorKind::kIo, std::string("writing to standard output failed: ") + std::strerror(errno));
}

void use_json_messages() { is_json = true; }

std::string printed_message(const std::string& text) {
  if (!is_json || text.empty()) return text;
  const std::string whole = text.ends_with('\n') ? text.substr(0, text.size() - 1) : text;
  const nlohmann::json line = {{"message", whole}};
  return line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

void print_message(const std::string& text) {
  std::fputs(printed_message(text).c_str(), stderr);
  std::fflush(stderr);
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
