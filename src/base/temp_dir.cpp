// SPDX-License-Identifier: Apache-2.0
#include "base/temp_dir.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <system_error>

#include "base/error.h"

namespace orrery::base {

TempDir::TempDir() {
  std::error_code failed;
  const std::filesystem::path parent = std::filesystem::temp_directory_path(failed);
  std::string name = ((failed ? std::filesystem::path("/tmp") : parent) / "orrery-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr)
    throw Error(ErrorKind::kCannotCreate,
                name + ": " + std::strerror(errno) + "; set $TMPDIR to another folder for temporary files");
  path_ = name;
}

TempDir::~TempDir() {
  std::error_code ignored;  // destructors cannot report errors
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace orrery::base
