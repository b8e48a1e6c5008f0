// SPDX-License-Identifier: Apache-2.0
#include "app/generate_files.h"

#include "format/write_scene.h"

namespace orrery::app {

void generate_final(const FinalScene& options, const std::filesystem::path& file) {
  format::write_scene(make_final_scene(options),
                      "The random final scene of Ray Tracing in One Weekend.\nMade by: orrery generate final --seed " +
                          std::to_string(options.seed) + " --grid " + std::to_string(options.grid) + " -o " +
                          file.filename().string() + "\n",
                      file);
}

void generate_cloud(const Cloud& options, const std::filesystem::path& file) {
  format::write_scene(make_cloud(options, file.filename().replace_extension(".ply")),
                      "A ball of small spheres.\nMade by: orrery generate cloud --seed " + std::to_string(options.seed) +
                          " --count " + std::to_string(options.count) + " -o " + file.filename().string() + "\n",
                      file);
}

}  // namespace orrery::app
