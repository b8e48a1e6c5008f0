// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "cli/arguments.h"
#include "display/forward.h"
#include "job/forward.h"
#include "load/overrides.h"

namespace orrery::cli {

// Options that several commands share. The variables that they write to must not move until the command line is parsed.

/// Headings in the help.
inline constexpr const char* kImageOptions = "Image options";
inline constexpr const char* kDisplayOptions = "Display options";
inline constexpr const char* kDataOptions = "Data options";
inline constexpr const char* kViewOptions = "View options";
inline constexpr const char* kLookOptions = "Look options";
inline constexpr const char* kAnnotationOptions = "Annotation options";

/// Refuses an option that sets the same key as an override.
///
/// Errors     base::Error(kUsage)
void refuse_second(const std::string& option, const load::Overrides& overrides, const char* key);

/// The options that override scene keys: --set, and short forms of frequent keys.
class SceneOptions {
 public:
  /// Which short forms a command has: those that have an effect.
  enum class Short { kAll, kSize, kNone };

  /// Adds the options to a command.
  ///
  /// Domain     called once; this must not move, and `command` must exist, until the last call of overrides()
  void add_to(Command& command, Short forms = Short::kAll);

  /// Adds a --set that another option stands for.
  void set(const std::string& setting) { set_.push_back(setting); }

  /// All overrides: those of --set, and of the options that stand for keys. Two for one key are an error.
  load::Overrides overrides() const;

  /// Adds --frame, for a command that uses one frame.
  void add_frame_to(Command& command);

  /// The frame of --frame; by default the frame of a render without --frames.
  ///
  /// Errors     base::Error(kUsage) if --frame is not a single frame
  int frame() const;

 private:
  struct ShortForm {
    const char* name;  ///< "--samples"
    const char* key;
    std::string value;
    Option* flag;
    bool is_list;  ///< comma-separated words
  };
  std::vector<std::string> set_;
  std::string frame_;
  std::deque<ShortForm> short_forms_;  ///< a deque: the parser keeps pointers to the values
};

/// Adds the options of the display transform, for commands that have no scene.
void add_display_options(Command& command, display::Settings& settings);

/// Adds --bits.
void add_bits_option(Command& command, int& bits);

/// Adds --denoise.
void add_denoise_option(Command& command, job::Job& job);

/// The options that select a job's image files and their formats.
class PictureOptions {
 public:
  /// Adds the options to a command.
  ///
  /// Domain     called once; neither this nor `job` moves until the command line is parsed
  void add_to(Command& command, job::Job& job);

  /// Returns a warning for each kind of option that affects none of the files, one per line.
  std::string unused_options(const job::Job& job) const;

  /// Replaces file names.
  ///
  /// `replaced`  returns the new name
  void rename(const std::function<std::filesystem::path(const std::filesystem::path&)>& replaced) {
    for (std::filesystem::path& file : files_) file = replaced(file);
  }

  /// Converts the options that are not members of a job.
  ///
  /// Errors     base::Error(kUsage) for a file with an unknown extension
  void finish(job::Job& job) const;

 private:
  std::vector<std::filesystem::path> files_;
  std::string type_ = "half";
};

/// Adds -t, --threads.
///
/// `otherwise`  the default, in the help
void add_threads_option(Command& command, int& threads, const char* otherwise = "all CPUs available to the process");

}  // namespace orrery::cli
