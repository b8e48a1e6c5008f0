// SPDX-License-Identifier: Apache-2.0
#include <limits>
#include <memory>

#include "cli/commands.h"
#include "generate/generate.h"
#include "scene/limits.h"

namespace orrery::cli {
namespace {

struct GenerateOptions {
  generate::FinalScene final_scene;
  generate::Cloud cloud;
  std::filesystem::path output;
  bool force = false;
  bool quiet = false;  ///< neither generator prints anything but errors
};

constexpr std::uint64_t kMaxSeed = std::numeric_limits<std::uint64_t>::max();

/// Adds the options of all generators. -q is the option that other commands have.
void add_scene_options(Command& command, GenerateOptions& options) {
  command.add_option("-o,--output", options.output, "FILE", "Scene file to write")->required();
  command.add_flag("-q,--quiet", options.quiet, "Print only errors, which is the default");
  command.add_flag("--force", options.force, "Replace a scene file that was edited, or not written by orrery")
      ->details("Without it, the exit status is 73.");
}

void add_seed(Command& command, std::uint64_t& seed) {
  command.add_option("--seed", seed, "N", "Random seed; default: 1")->transform(whole_number(0, kMaxSeed));
}

void add_final(Command& generate, const std::shared_ptr<GenerateOptions>& options) {
  Command& command = *generate.add_subcommand("final", "The random final scene of Ray Tracing in One Weekend");
  add_scene_options(command, *options);
  add_seed(command, options->final_scene.seed);
  command
      .add_option("--grid", options->final_scene.grid, "N",
                  "Grid cells from the centre to the edge, 0 to 1000; default: 11")
      ->details("As in the book. Above 32, the spheres are written to a PLY file.")
      ->transform(whole_number(0, generate::kLargestFinalGrid));
  command.footer("Example:\n  orrery generate final -o final.toml --seed 7");
  command.act([options] { generate::generate_final(options->final_scene, options->output, options->force); });
}

void add_cloud(Command& generate, const std::shared_ptr<GenerateOptions>& options) {
  Command& command =
      *generate.add_subcommand("cloud", "A cloud of small spheres: a scene file and a PLY file next to it");
  add_scene_options(command, *options);
  add_seed(command, options->cloud.seed);
  command.add_option("--count", options->cloud.count, "N", "Number of spheres; default: 1000")
      ->transform(whole_number(1, generate::kLargestCloud));
  command
      .add_option("--radius", options->cloud.radius, "R",
                  "Radius of all spheres, in scene units; default: random, with a mean that depends on --count")
      ->check(real_number(scene::kSmallestRadius, generate::kLargestCloudRadius));
  command.details("An existing PLY file is replaced only if orrery wrote it; otherwise the exit status is 73.");
  command.footer("Example:\n  orrery generate cloud -o cloud.toml --count 1000000");
  command.act([options] { generate::generate_cloud(options->cloud, options->output, options->force); });
}

}  // namespace

void add_generate(Command& program) {
  const auto options = std::make_shared<GenerateOptions>();
  Command& command = *program.add_subcommand("generate", "Generate a scene file");
  command.require_subcommand();
  add_final(command, options);
  add_cloud(command, options);
  command.footer(
      "Examples:\n"
      "  orrery generate final -o final.toml --seed 7\n"
      "  orrery generate cloud -o cloud.toml --count 1000000");
}

}  // namespace orrery::cli
