// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "support/temp_dir.h"

namespace orrery::test {

inline std::string text_of(const std::filesystem::path& file) { return support::file_bytes(file); }

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// Exit status and output of one run.
struct Outcome {
  int status = -1;
  std::string out, err;
};

/// Runs the program in a temporary folder, one for each test.
class ProgramTest : public testing::Test {
 protected:
  void SetUp() override { write("good.toml", kGoodScene); }

  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }

  /// Runs `orrery ARGUMENTS` in the folder; `before` precedes the command in the same shell.
  Outcome run(const std::string& arguments, const std::string& before = "") {
    const std::string command = "cd \"" + folder_.string() + "\" && " + before + " \"" ORRERY_PROGRAM "\" " +
                                arguments + " >.out 2>.err </dev/null";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), text_of(folder_ / ".out"),
            text_of(folder_ / ".err")};
  }

  /// Number of files that the program left: all but scene files and captured output.
  int file_count() const {
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
      const std::string name = entry.path().filename().string();
      count += name != ".out" && name != ".err" && entry.path().extension() != ".toml";
    }
    return count;
  }

  static constexpr const char* kGoodScene = R"(
[image]
width = 32
height = 18
[render]
samples = 4
[material.grey]
type = "lambertian"
albedo = [0.5, 0.5, 0.5]
[[sphere]]
center = [0, 0, -1]
radius = 0.5
material = "grey"
)";

  support::TempDir scratch_;
  const std::filesystem::path folder_ = scratch_.path();
};

}  // namespace orrery::test
