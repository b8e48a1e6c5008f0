// SPDX-License-Identifier: Apache-2.0
#include "base/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "base/error.h"

namespace orrery::base {

void require_readable(const std::filesystem::path& file) {
  const auto refuse = [&](const std::string& reason, int number) {
    throw FileError(ErrorKind::kMissingInput, "cannot open " + file.string() + ": " + reason, file, number);
  };
  // The type is checked before opening: opening a pipe blocks, and opening a device may have side effects.
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) refuse(std::strerror(errno), errno);
  if (S_ISDIR(status.st_mode)) refuse("it is a directory", EISDIR);
  if (!S_ISREG(status.st_mode)) refuse("it is not a regular file", EINVAL);
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) refuse(std::strerror(errno), errno);
  ::close(descriptor);
}

std::string file_version(const std::filesystem::path& file) {
  std::error_code size_error, time_error;
  const std::uintmax_t size = std::filesystem::file_size(file, size_error);
  const std::filesystem::file_time_type time = std::filesystem::last_write_time(file, time_error);
  std::string out = std::filesystem::absolute(file).string();
  if (!size_error && !time_error)
    out += '\n' + std::to_string(size) + ' ' + std::to_string(time.time_since_epoch().count());
  return out;
}

}  // namespace orrery::base
