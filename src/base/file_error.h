// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"

namespace orrery::base {

/// An Error of the system for a file. It keeps both, for callers that report them separately.
class FileError : public Error {
 public:
  /// `message`  names the file and the reason
  /// `number`   errno
  FileError(ErrorKind kind, const std::string& message, std::filesystem::path file, int number,
            std::vector<Diagnostic> diagnostics = {})
      : Error(kind, message, std::move(diagnostics)), file_(std::move(file)), number_(number) {}

  const std::filesystem::path& file() const noexcept { return file_; }
  int number() const noexcept { return number_; }

 private:
  std::filesystem::path file_;
  int number_;
};

/// Throws a FileError of kind kIo.
[[noreturn]] inline void fail_to_write(const std::filesystem::path& file, int number) {
  throw FileError(ErrorKind::kIo, "writing " + file.string() + " failed: " + std::strerror(number), file, number);
}

}  // namespace orrery::base
