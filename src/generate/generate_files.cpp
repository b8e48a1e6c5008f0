// SPDX-License-Identifier: Apache-2.0
#include "generate/generate_files.h"

#include <string>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_set.h"
#include "format/write_ply.h"
#include "format/write_scene.h"
#include "scene/schema.h"

namespace orrery::generate {
namespace {

std::string comment(const FinalScene& options, const std::string& name) {
  return "Ray Tracing in One Weekend, \"A Final Render\".\n"
         "\n"
         "Three large balls, glass before brown and metal in front, among many small ones on a huge grey ground, "
         "under\n"
         "the sky of all the book's pictures. The lens is open a little: what is far behind the focus plane blurs.\n"
         "\n"
         "Made by\n"
         "  orrery generate final --seed " +
         std::to_string(options.seed) + " --grid " + std::to_string(options.grid) + " -o " + name +
         "\nand rendered by\n"
         "  orrery render " +
         name + " -o final.exr -o final.png --display \"Gamma 2.0 Rec.709\"\n";
}

std::string comment(const Cloud& options, const std::string& name) {
  return "A cloud of " + std::to_string(options.count) + (options.count == 1 ? " sphere" : " spheres") +
         " in the sky. The spheres are in the points file beside this one.\n"
         "\n"
         "Made by\n"
         "  orrery generate cloud --seed " +
         std::to_string(options.seed) + " --count " + std::to_string(options.count) +
         (options.radius ? " --radius " + scene::number_text(*options.radius) : "") + " -o " + name + "\n";
}

/// Where the points go: two scenes in one folder must not share them.
std::filesystem::path points_file_of(const std::filesystem::path& file) {
  return file.filename().replace_extension(".ply");
}

/// Finds out before anything is generated what would fail afterwards. The user names the scene file; the points file
/// beside it is replaced only where an earlier run made it.
void check(const std::filesystem::path& file, bool has_points) {
  if (file.extension() == ".ply")
    throw base::Error(base::ErrorKind::kUsage, file.string() +
                                                   ": .ply is where the spheres go; name the scene, as in " +
                                                   std::filesystem::path(file).replace_extension(".toml").string());
  base::check_creatable(file);
  if (!has_points) return;
  const std::filesystem::path points = file.parent_path() / points_file_of(file);
  base::FileSet files;
  files.add_output(file, "-o");
  files.add_output(points, "points file");
  base::check_creatable(points);
  std::error_code ignored;
  if (std::filesystem::exists(points, ignored) && !format::is_own_ply(points))
    throw base::Error(base::ErrorKind::kCannotCreate,
                      "cannot create " + points.string() +
                          ": a file is there that orrery generate did not make; move it, or choose another -o");
}

}  // namespace

void generate_final(const FinalScene& options, const std::filesystem::path& file) {
  check(file, options.grid > kLargestWrittenGrid);
  format::write_scene(make_final_scene(options, points_file_of(file)), comment(options, file.filename().string()),
                      file);
}

void generate_cloud(const Cloud& options, const std::filesystem::path& file) {
  check(file, true);
  format::write_scene(make_cloud(options, points_file_of(file)), comment(options, file.filename().string()), file);
}

}  // namespace orrery::generate
