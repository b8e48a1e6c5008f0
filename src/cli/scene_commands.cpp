// SPDX-License-Identifier: Apache-2.0
// The commands that inspect scenes and data files without rendering: info and check.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include <fmt/core.h>

#include "base/error.h"
#include "base/frames.h"
#include "cli/commands.h"
#include "cli/messages.h"
#include "cli/options.h"
#include "info/data_info.h"
#include "info/info.h"
#include "job/prepared_scene.h"
#include "load/load_scene.h"
#include "load/read_scene.h"

namespace orrery::cli {
namespace {

struct InfoOptions {
  std::filesystem::path file;
  SceneOptions overrides;
  std::optional<int> component;
  std::filesystem::path topology;
  bool json = false, settings = false;
};

struct CheckOptions {
  std::vector<std::filesystem::path> scenes;
  SceneOptions overrides;
  std::string frames;
  bool quiet = false;
};

std::string warnings_text(const info::SceneInfo& info) {
  std::string out;
  for (const base::Diagnostic& warning : info.warnings) out += base::formatted(warning);
  return out;
}

/// Rejects an option that does not apply to the kind of file.
void refuse_option(bool is_given, const std::string& option, const InfoOptions& options, const char* kind) {
  if (is_given) base::refuse(fmt::format("{}: {} is a {}", option, options.file.string(), kind));
}

int data_info(const InfoOptions& options) {
  constexpr const char* kKind = "data file; the option applies to scenes, which are *.toml";
  refuse_option(options.settings, "--settings", options, kKind);
  for (const load::Override& override : options.overrides.overrides())
    refuse_option(true, override.option, options, kKind);
  info::DataInfoRequest request;
  request.file = options.file;
  request.frame = options.overrides.frame();
  request.component = options.component;
  request.topology = options.topology;
  const info::DataInfo found = info::data_info(request);
  print_result(options.json ? info::data_info_json(found) : info::data_info_text(found));
  return 0;
}

int info(const InfoOptions& options) {
  if (options.json && options.settings) base::refuse("--json excludes --settings; it prints them, too");
  if (!load::is_scene_file(options.file)) return data_info(options);
  for (const auto& [is_given, option] :
       {std::pair{options.component.has_value(), "--component"}, std::pair{!options.topology.empty(), "--topology"}})
    refuse_option(is_given, option, options, "scene; the option applies to data files");
  load::SceneRequest request;
  request.source.file = options.file;
  request.source.overrides = options.overrides.overrides();
  request.source.frame = options.overrides.frame();
  const info::SceneInfo found = info::scene_info(request);
  std::fputs(warnings_text(found).c_str(), stderr);
  print_result(options.json       ? info::info_json(found)
               : options.settings ? info::settings_text(found)
                                  : info::info_text(found));
  return 0;
}

/// Warning if the scene exceeds this machine's free memory; not an error, since it may be rendered on another machine.
std::string memory_warning(const info::SceneInfo& info) {
  try {
    job::require_memory(info.memory, 0);
    return {};
  } catch (const base::Error& error) {
    return base::warning_line(error.what());
  }
}

/// Checks the frames of one scene. Prints equal messages of several frames once.
class FrameChecks {
 public:
  explicit FrameChecks(load::SceneRequest request) : request_(std::move(request)) {}

  /// Result     the exit status
  int run(const std::vector<int>& frames) {
    for (const int frame : frames) {
      request_.source.frame = frame;
      try {
        const info::SceneInfo info = info::scene_info(request_, prepared_);
        print_once(warnings_text(info) + memory_warning(info));
      } catch (const base::Error& error) {
        if (status_ == 0) status_ = base::exit_status(error.kind());
        print_once(error_text(error));
        if (error.diagnostics().empty()) return status_;  // not an error of the scene; it would repeat in other frames
        bad_.push_back(frame);
      }
    }
    if (frames.size() > 1 && !bad_.empty())
      std::fputs(fmt::format("orrery: {}: {} of {} frames have errors: {}\n", request_.source.file.string(),
                             bad_.size(), frames.size(), base::frames_text(bad_))
                     .c_str(),
                 stderr);
    return status_;
  }

 private:
  void print_once(const std::string& text) {
    if (!text.empty() && printed_.size() < kMaxTexts && printed_.insert(text).second) std::fputs(text.c_str(), stderr);
  }

  /// Limits the output, e.g. for a thousand frames without their files.
  static constexpr std::size_t kMaxTexts = 100;

  load::SceneRequest request_;
  job::PreparedScene prepared_;
  std::set<std::string> printed_;
  std::vector<int> bad_;
  int status_ = 0;
};

/// Checks all scenes, even if some have errors. Returns the largest exit status.
int check(const CheckOptions& options) {
  const std::vector<int> frames =
      options.frames.empty() ? std::vector<int>{load::kFirstFrame} : base::parse_frames(options.frames);
  int status = 0;
  for (const auto& scene : options.scenes) {
    load::SceneRequest request;
    request.source.file = scene;
    request.source.overrides = options.overrides.overrides();
    request.develops = true;  // also find what a render to a display format would reject
    const int own = FrameChecks(std::move(request)).run(frames);
    status = std::max(status, own);
    const std::string count = frames.size() > 1 ? fmt::format(", {} frames", frames.size()) : "";
    if (own == 0 && !options.quiet) print_result(fmt::format("{}: ok{}\n", scene.string(), count));
  }
  return status;
}

}  // namespace

void add_info(Command& program) {
  const auto options = std::make_shared<InfoOptions>();
  Command& command = *program.add_subcommand("info", "Print the contents of a scene or of a data file");
  command.add_option("FILE", options->file, "FILE", "Scene file, *.toml, or data file")->required();
  options->overrides.add_to(command);
  options->overrides.add_frame_to(command);
  command.add_option("--component", options->component, "N", "HDF5: particle type, N of PartTypeN")
      ->transform(whole_number(0, 1000));
  command.add_option("--topology", options->topology, "FILE", "Trajectories: data file that names the atoms");
  command.add_flag("--json", options->json, "Print JSON, with all settings")
      ->details("Schema orrery.info/1, for data files orrery.data/1.");
  command.add_flag("--settings", options->settings, "Print every setting, its value and its origin");
  command.details(
      "Of a scene: its contents, memory estimate, required and unused features, emitters and how they and the "
      "background are sampled, available layers, unused columns of data files, and a warning if the chosen precision "
      "is insufficient. A file whose name does not end in .toml is a data file, of which it prints format, number of "
      "frames, box, biological assemblies and the columns of a frame: type, smallest and largest finite value, number "
      "of NaN, up to eight distinct strings. Roles are the columns that plot and convert use by default.");
  command.footer(
      "Examples:\n"
      "  orrery info scenes/book/final.toml\n"
      "  orrery info scene.toml --settings --set camera.vfov=30\n"
      "  orrery info melt.dump --frame 2");
  command.action([options] { return info(*options); });
}

void add_check(Command& program) {
  const auto options = std::make_shared<CheckOptions>();
  Command& command = *program.add_subcommand("check", "Read and validate scenes without rendering");
  command.add_option("SCENE", options->scenes, "FILE", "Scene files")->required();
  options->overrides.add_to(command);
  command.add_option("--frames", options->frames, "RANGE", "Frames to check, e.g. 1-48, 1-48x2 or 1,3,7-9; default: 1")
      ->details(
          "The values of animated keys must be in range, and the data files and background image of each frame must "
          "exist. Errors that several frames have in common are printed once.");
  command.add_flag("-q,--quiet", options->quiet, "Print nothing about valid scenes");
  command.details(
      "A scene that it accepts is also accepted by orrery render, which may still reject its own options. A scene that "
      "needs more than the free memory of this machine gives a warning, since another machine may render it. All "
      "scenes are checked; the exit status is that of the worst. At most 100 errors of a scene are printed, and their "
      "total number.");
  command.footer(
      "Examples:\n"
      "  orrery check scenes/book/*.toml\n"
      "  orrery check shot.toml --frames 1-240");
  command.action([options] { return check(*options); });
}

}  // namespace orrery::cli
