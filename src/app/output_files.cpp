// SPDX-License-Identifier: Apache-2.0
#include "app/output_files.h"

#include <algorithm>

#include "base/atomic_file.h"
#include "base/error.h"
#include "image/format.h"

namespace orrery::app {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& file, const std::string& reason) {
  throw base::Error(base::ErrorKind::kUsage, file.string() + reason);
}

/// The one name of a file that may not be there yet.
fs::path canonical_name(const fs::path& file) {
  std::error_code failed;
  const fs::path absolute = fs::absolute(file, failed);
  const fs::path canonical = fs::weakly_canonical(absolute, failed);
  return failed ? absolute.lexically_normal() : canonical;
}

}  // namespace

void check_output_files(const std::vector<fs::path>& pictures, int bits, const std::vector<fs::path>& others,
                        const std::vector<fs::path>& inputs) {
  for (const fs::path& file : pictures) {
    const image::Format format = image::format_of(file);
    if (image::is_display_format(format) && bits > image::most_bits(format))
      refuse(file, " holds 8 bits in a channel; PNG and TIFF hold 16");
  }
  std::vector<fs::path> read;
  for (const fs::path& file : inputs) read.push_back(canonical_name(file));
  std::vector<fs::path> all = pictures, seen;
  all.insert(all.end(), others.begin(), others.end());
  for (const fs::path& file : all) {
    const fs::path name = canonical_name(file);
    if (std::find(read.begin(), read.end(), name) != read.end()) refuse(file, " is read and would be overwritten");
    if (std::find(seen.begin(), seen.end(), name) != seen.end()) refuse(file, " is to be written twice");
    seen.push_back(name);
  }
  for (const fs::path& file : all) base::check_creatable(file);
}

}  // namespace orrery::app
