// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace orrery::cli {

/// Makes films in a folder, one at a time, each by a command in a process of its own.
class Films {
 public:
  /// Errors     base::Error(kMissingInput) if there is no such folder
  explicit Films(std::filesystem::path folder);
  /// Stops the film, and waits for the end of its command.
  ~Films();
  Films(const Films&) = delete;
  Films& operator=(const Films&) = delete;

  /// Starts `orrery COMMAND FILE WORDS... -o NAME`, where a number is inserted into the name if the folder has such a
  /// file already: no file is replaced.
  ///
  /// Errors     base::Error(kUsage) while a film is made
  void start(const std::string& command, const std::filesystem::path& file, const std::vector<std::string>& words,
             const std::string& name);
  void cancel();
  /// JSON: `file`; `is_running`; `progress`, the last line of --progress json; `messages`; `status`, of the process
  /// that has ended.
  std::string state() const;

 private:
  void run(const std::filesystem::path& program, std::vector<std::string> words);

  const std::filesystem::path folder_;
  mutable std::mutex mutex_;  // guards what follows
  std::filesystem::path file_;
  bool is_running_ = false, is_cancelled_ = false;
  pid_t process_ = 0;  ///< 0: none
  int status_ = 0;
  std::string progress_ = "null";
  std::vector<std::string> messages_;
  std::thread runner_;
};

}  // namespace orrery::cli
