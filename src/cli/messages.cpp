// SPDX-License-Identifier: Apache-2.0
#include "cli/messages.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <sstream>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "base/error.h"

namespace orrery::cli {
namespace {

int log_file = -1;
bool is_json = false;

/// "2026-11-21T22:48:05.123Z".
std::string time_text() {
  const auto now = std::chrono::system_clock::now();
  const std::time_t seconds = std::chrono::system_clock::to_time_t(now);
  const auto milliseconds =
      std::chrono::duration_cast<std::chrono::milliseconds>(now.time_since_epoch()).count() % 1000;
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  char text[32];
  std::strftime(text, sizeof(text), "%Y-%m-%dT%H:%M:%S", &utc);
  return fmt::format("{}.{:03}Z", text, milliseconds);
}

}  // namespace

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
  log_message(text);
}

void log_message(const std::string& text) {
  if (log_file < 0) return;
  const std::string begin = fmt::format("{} {} ", time_text(), getpid());
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::string whole = fmt::format("{}{}\n", begin, line);
    // A failed write to the log must not end the render.
    [[maybe_unused]] const ssize_t written = ::write(log_file, whole.data(), whole.size());
  }
}

void open_log(const std::filesystem::path& file) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(file, ignored);
  // Opening a pipe would wait for its reader.
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    throw base::Error(base::ErrorKind::kCannotCreate,
                      fmt::format("cannot create {}: it is not a regular file", file.string()));
  log_file = ::open(file.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0666);
  if (log_file < 0)
    throw base::Error(base::ErrorKind::kCannotCreate,
                      fmt::format("cannot create {}: {}", file.string(), std::strerror(errno)));
}

}  // namespace orrery::cli
