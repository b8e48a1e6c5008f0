// SPDX-License-Identifier: Apache-2.0
#include "cli/films.h"

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/frames.h"
#include "cli/film.h"

namespace orrery::cli {
namespace {

constexpr std::size_t kMostMessages = 20;  // that are kept: the last ones

/// A name that the folder has not, with a number before its first dot.
std::filesystem::path unused(const std::filesystem::path& folder, const std::string& name) {
  const std::size_t dot = name.find('.');
  std::filesystem::path out = folder / name;
  const auto exists = [](const std::filesystem::path& path) {
    std::error_code none;
    return std::filesystem::exists(base::with_frame(path.string(), 1), none);
  };
  for (int i = 2; exists(out); ++i) out = folder / fmt::format("{}-{}{}", name.substr(0, dot), i, name.substr(dot));
  return out;
}

}  // namespace

Films::Films(std::filesystem::path folder) : folder_(std::move(folder)) {
  if (!std::filesystem::is_directory(folder_))
    throw base::Error(base::ErrorKind::kMissingInput,
                      fmt::format("--save-to: there is no folder {}", folder_.string()));
}

Films::~Films() {
  cancel();
  if (runner_.joinable()) runner_.join();
}

void Films::start(const std::string& command, const std::filesystem::path& file, const std::vector<std::string>& words,
                  const std::string& name) {
  const std::lock_guard lock(mutex_);
  if (is_running_) base::refuse("a film is being made; cancel it, or wait until it is complete");
  if (runner_.joinable()) runner_.join();  // it has ended
  is_cancelled_ = false;
  file_ = unused(folder_, name);
  progress_ = "null";
  messages_.clear();
  // In an archive, the program is run by a loader beside it: launcher.cpp.
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe");
  std::vector<std::string> all = {"orrery"};
  if (self.filename() == "orrery-loader")
    all = {self, "--inhibit-cache", "--argv0", "orrery", self.parent_path() / "orrery-program"};
  all.insert(all.end(), {command, file.string()});
  all.insert(all.end(), words.begin(), words.end());
  all.insert(all.end(), {"-o", file_.string(), "--progress", "json"});
  is_running_ = true;
  runner_ = std::thread([this, self, all] { run(self, all); });
}

/// Runs a command, and reads what it prints until it ends.
void Films::run(const std::filesystem::path& program, std::vector<std::string> words) {
  int ends[2] = {-1, -1};
  const pid_t child =
      pipe2(ends, O_CLOEXEC) == 0 ? start_program(program, std::move(words), {-1, ends[1], ends[1]}, SIGINT) : -1;
  close(ends[1]);
  {
    const std::lock_guard lock(mutex_);
    process_ = child;
    if (child > 0 && is_cancelled_) kill(child, SIGINT);
  }
  std::FILE* const lines = fdopen(ends[0], "r");
  char* line = nullptr;
  std::size_t size = 0;
  while (child > 0 && lines != nullptr && getline(&line, &size, lines) > 0) {
    const nlohmann::json value = nlohmann::json::parse(line, nullptr, false);
    const std::lock_guard lock(mutex_);
    if (value.is_object() && value.contains("progress"))
      progress_ = line;
    else
      messages_.push_back(value.is_object() ? value.value("message", "") : line);
    if (messages_.size() > kMostMessages) messages_.erase(messages_.begin());
  }
  std::free(line);
  if (lines != nullptr) std::fclose(lines);
  siginfo_t ended;
  if (child > 0) waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOWAIT);
  const std::lock_guard lock(mutex_);  // from here on the number may be that of another process
  int status = 0;
  if (child > 0) waitpid(child, &status, 0);
  process_ = 0;
  is_running_ = false;
  status_ = child <= 0 ? 1 : WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  if (child <= 0 || status_ == 127) messages_.push_back("the command of a film cannot be started");
}

void Films::cancel() {
  const std::lock_guard lock(mutex_);
  is_cancelled_ = true;
  if (process_ > 0) kill(process_, SIGINT);
}

std::string Films::state() const {
  const std::lock_guard lock(mutex_);
  nlohmann::json out = {{"file", file_.string()}, {"is_running", is_running_}, {"status", status_}};
  out["progress"] = nlohmann::json::parse(progress_, nullptr, false);
  out["messages"] = messages_;
  return out.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace orrery::cli
