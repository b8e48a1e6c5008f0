// SPDX-License-Identifier: Apache-2.0
#include <limits>
#include <memory>

#include "cli/commands.h"
#include "cli/option_checks.h"
#include "cli/signals.h"
#include "generate/generate_files.h"

namespace orrery::cli {
namespace {

struct GenerateOptions {
  generate::FinalScene final_scene;
  generate::Cloud cloud;
  std::filesystem::path output;
};

constexpr std::uint64_t kMaxSeed = std::numeric_limits<std::uint64_t>::max();

/// Adds the options of all generators.
void add_common(Command& command, std::filesystem::path& output, std::uint64_t& seed) {
  command.add_option("-o,--output", output, "Scene file to write")->required()->type_name("FILE");
  command.add_option("--seed", seed, "Random seed; default: 1")->transform(whole_number(0, kMaxSeed))->type_name("N");
}

void add_final(Command& generate, const std::shared_ptr<GenerateOptions>& options, Action& action) {
  Command& command = *generate.add_subcommand("final", "The random final scene of Ray Tracing in One Weekend");
  add_common(command, options->output, options->final_scene.seed);
  command
      .add_option("--grid", options->final_scene.grid, "Cells from the centre to the edge; default: 11, as in the book")
      ->transform(whole_number(0, generate::kLargestFinalGrid))
      ->type_name("N");
  command.footer("Example:\n  orrery generate final -o final.toml --seed 7");
  command.callback([options, &action] {
    action = [options] {
      end_on_signals();
      generate::generate_final(options->final_scene, options->output);
      return 0;
    };
  });
}

void add_cloud(Command& generate, const std::shared_ptr<GenerateOptions>& options, Action& action) {
  Command& command =
      *generate.add_subcommand("cloud", "A cloud of small spheres: a scene file and a PLY file next to it");
  add_common(command, options->output, options->cloud.seed);
  command.add_option("--count", options->cloud.count, "Number of spheres; default: 1000")
      ->transform(whole_number(1, generate::kLargestCloud))
      ->type_name("N");
  command
      .add_option("--radius", options->cloud.radius,
                  "Radius of all spheres, in scene units; default: random, with a mean that depends on --count")
      ->check(real_number(0, generate::kLargestCloudRadius))
      ->type_name("R");
  command.footer("Example:\n  orrery generate cloud -o cloud.toml --count 1000000");
  command.callback([options, &action] {
    action = [options] {
      end_on_signals();
      generate::generate_cloud(options->cloud, options->output);
      return 0;
    };
  });
}

}  // namespace

void add_generate(Command& program, Action& action) {
  const auto options = std::make_shared<GenerateOptions>();
  Command& command = *program.add_subcommand("generate", "Generate a scene file");
  command.require_subcommand();
  add_final(command, options, action);
  add_cloud(command, options, action);
  command.footer(
      "Examples:\n"
      "  orrery generate final -o final.toml --seed 7\n"
      "  orrery generate cloud -o cloud.toml --count 1000000");
}

}  // namespace orrery::cli
