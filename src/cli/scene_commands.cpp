// SPDX-License-Identifier: Apache-2.0
// What looks at scenes without rendering them: info and check.
#include <algorithm>
#include <cstdio>
#include <memory>

#include "app/info.h"
#include "base/error.h"
#include "cli/commands.h"
#include "cli/output.h"
#include "cli/scene_options.h"

namespace orrery::cli {
namespace {

struct InfoOptions {
  std::filesystem::path scene;
  SceneOptions overrides;
  bool json = false, settings = false, measure = false;
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
  app::SceneInfo found = app::scene_info(options.scene, options.overrides.overrides());
  if (options.measure) app::measure_savings(options.scene, options.overrides.overrides(), found);
  print_warnings(found);
  print_result(options.json       ? app::info_json(found)
               : options.settings ? app::settings_text(found)
                                  : app::info_text(found));
  return 0;
}

/// All scenes are looked at, whatever is wrong with the first; the worst of them decides the status.
int check(const CheckOptions& options) {
  int status = 0;
  for (const auto& scene : options.scenes) {
    try {
      print_warnings(app::scene_info(scene, options.overrides.overrides()));
    } catch (const base::Error& error) {
      status = std::max(status, print_error(error));
      continue;
    }
    if (!options.quiet) print_result(scene.string() + ": ok\n");
  }
  return status;
}

}  // namespace

void add_info(Command& program, Action& action) {
  const auto options = std::make_shared<InfoOptions>();
  Command& command = *program.add_subcommand("info", "Tell what a scene is, what it requires, and what is left out");
  command.add_option("SCENE", options->scene, "Scene file")->required()->type_name("FILE");
  options->overrides.add_to(command);
  command.add_flag("--measure", options->measure, "Measure what leaving out saves; takes some seconds");
  auto* json = command.add_flag("--json", options->json, "As JSON, with all settings");
  command.add_flag("--settings", options->settings, "Every setting, its value and where it came from")->excludes(json);
  command.footer(
      "Examples:\n"
      "  orrery info scenes/book/final.toml\n"
      "  orrery info scene.toml --settings --set camera.vfov=30");
  command.callback([options, &action] { action = [options] { return info(*options); }; });
}

void add_check(Command& program, Action& action) {
  const auto options = std::make_shared<CheckOptions>();
  Command& command = *program.add_subcommand("check", "Find everything that is wrong with scenes, without rendering");
  command.add_option("SCENE", options->scenes, "Scene files")->required()->type_name("FILE")->take_all();
  options->overrides.add_to(command);
  command.add_flag("-q,--quiet", options->quiet, "Say nothing about scenes that are right");
  command.footer("Example:\n  orrery check scenes/book/*.toml");
  command.callback([options, &action] { action = [options] { return check(*options); }; });
}

}  // namespace orrery::cli
