// SPDX-License-Identifier: Apache-2.0
// What looks at scenes without rendering them, or makes them: info, check, generate.
#include <cstdio>
#include <memory>

#include "app/generate_files.h"
#include "app/info.h"
#include "base/error.h"
#include "base/exit_status.h"
#include "cli/commands.h"
#include "cli/scene_options.h"

namespace orrery::cli {
namespace {

struct InfoOptions {
  std::filesystem::path scene;
  SceneOptions overrides;
  bool json = false, settings = false;
};

struct CheckOptions {
  std::vector<std::filesystem::path> scenes;
  SceneOptions overrides;
  bool quiet = false;
};

void print_warnings(const app::SceneInfo& info) {
  for (const base::Finding& warning : info.warnings) std::fputs(base::formatted(warning).c_str(), stderr);
}

int info(const InfoOptions& options) {
  const app::SceneInfo found = app::scene_info(options.scene, options.overrides.overrides());
  print_warnings(found);
  const std::string text =
      options.json ? app::info_json(found) : options.settings ? app::settings_text(found) : app::info_text(found);
  std::fputs(text.c_str(), stdout);
  return 0;
}

/// All scenes are looked at, whatever is wrong with the first; the worst of them decides the status.
int check(const CheckOptions& options) {
  int status = 0;
  for (const auto& scene : options.scenes) {
    try {
      print_warnings(app::scene_info(scene, options.overrides.overrides()));
      if (!options.quiet) std::printf("%s: ok\n", scene.c_str());
    } catch (const base::Error& error) {
      for (const base::Finding& finding : error.findings()) std::fputs(base::formatted(finding).c_str(), stderr);
      std::fprintf(stderr, "orrery: %s\n", error.what());
      status = std::max(status, base::exit_status(error.kind()));
    }
  }
  return status;
}

struct GenerateOptions {
  app::FinalScene final_scene;
  app::Cloud cloud;
  std::filesystem::path output;
};

}  // namespace

void add_info(CLI::App& program, Action& action) {
  const auto options = std::make_shared<InfoOptions>();
  CLI::App& command = *program.add_subcommand("info", "Tell what a scene is, what it requires, and what is left out");
  command.add_option("SCENE", options->scene, "Scene file")->required();
  options->overrides.add_to(command);
  auto* json = command.add_flag("--json", options->json, "As JSON");
  command.add_flag("--settings", options->settings, "Every setting, its value and where it came from")->excludes(json);
  command.footer("Examples:\n  orrery info scenes/book/final.toml\n  orrery info scene.toml --settings --set camera.vfov=30");
  command.callback([options, &action] { action = [options] { return info(*options); }; });
}

void add_check(CLI::App& program, Action& action) {
  const auto options = std::make_shared<CheckOptions>();
  CLI::App& command = *program.add_subcommand("check", "Find everything that is wrong with scenes, without rendering");
  command.add_option("SCENE", options->scenes, "Scene files")->required();
  options->overrides.add_to(command);
  command.add_flag("-q,--quiet", options->quiet, "Say nothing about scenes that are right");
  command.footer("Example:\n  orrery check scenes/book/*.toml");
  command.callback([options, &action] { action = [options] { return check(*options); }; });
}

void add_generate(CLI::App& program, Action& action) {
  const auto options = std::make_shared<GenerateOptions>();
  CLI::App& command = *program.add_subcommand("generate", "Make a scene file");
  command.require_subcommand(1);
  CLI::App& final_scene = *command.add_subcommand("final", "The random final scene of the book");
  final_scene.add_option("-o,--output", options->output, "Scene file to write")->required()->type_name("FILE");
  final_scene.add_option("--seed", options->final_scene.seed, "Another seed is another scene")->type_name("N");
  final_scene.add_option("--grid", options->final_scene.grid, "Cells from the middle to the edge; 11 is the book's")->type_name("N");
  CLI::App& cloud = *command.add_subcommand("cloud", "A cloud of small spheres: a scene file and a PLY file beside it");
  cloud.add_option("-o,--output", options->output, "Scene file to write")->required()->type_name("FILE");
  cloud.add_option("--seed", options->cloud.seed, "Another seed is another scene")->type_name("N");
  cloud.add_option("--count", options->cloud.count, "Spheres")->type_name("N");
  cloud.add_option("--radius", options->cloud.radius, "Of every sphere; by the count, and varied, where not given")->type_name("R");
  command.footer("Examples:\n  orrery generate final -o final.toml --seed 7\n  orrery generate cloud -o cloud.toml --count 1000000");
  final_scene.callback([options, &action] {
    action = [options] { return app::generate_final(options->final_scene, options->output), 0; };
  });
  cloud.callback([options, &action] {
    action = [options] { return app::generate_cloud(options->cloud, options->output), 0; };
  });
}

}  // namespace orrery::cli
