// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "cli/arguments.h"
#include "format/overrides.h"

namespace orrery::cli {

/// The options that override scene keys: --set, and short forms of frequent keys.
class SceneOptions {
 public:
  /// Which short forms a command has: those that have an effect.
  enum class Short { kAll, kSize };

  /// Adds the options to a command.
  ///
  /// Domain     called once; this must not move, and `command` must exist, until the last call of overrides()
  void add_to(Command& command, Short forms = Short::kAll);

  /// All overrides, short forms first, so that --set wins.
  format::Overrides overrides() const;

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

}  // namespace orrery::cli
