// SPDX-License-Identifier: Apache-2.0
#include "measure/temp_dir.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <system_error>

#include <fmt/core.h>

#include "base/error.h"

namespace orrery::measure {

TempDir::TempDir() {
  std::error_code failed;
  const std::filesystem::path parent = std::filesystem::temp_directory_path(failed);
  std::string name = ((failed ? std::filesystem::path("/tmp") : parent) / "orrery-study-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr)
    throw base::Error(
        base::ErrorKind::kCannotCreate,
        fmt::format("{}: {}; set $TMPDIR to another folder for temporary files", name, std::strerror(errno)));
  path_ = name;
}

TempDir::~TempDir() {
  std::error_code ignored;  // destructors cannot report errors
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace orrery::measure
