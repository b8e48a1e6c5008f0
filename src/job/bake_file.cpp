// SPDX-License-Identifier: Apache-2.0
#include "job/bake_file.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_name.h"
#include "display/settings.h"
#include "load/scene_files.h"

namespace orrery::job {

void bake_file(const display::Settings& display, int cube_size, const std::filesystem::path& file) {
  const std::string extension = base::extension(file);
  if (extension != ".cube" && extension != ".clf")
    throw base::Error(base::ErrorKind::kUsage,
                      file.string() + " is not a display transform file; use the extension .cube or .clf");
  base::FileSet files;
  load::add_ocio_configs(display.config, files);
  files.add_output(file, "-o");
  base::check_creatable(file);
  base::write_text_file(
      file, extension == ".cube" ? display::bake_cube(display, cube_size) : display::bake_clf(display, cube_size));
}

}  // namespace orrery::job
