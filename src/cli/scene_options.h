// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "job/load_scene.h"
#include "cli/arguments.h"

namespace orrery::cli {

/// Flags that change the scene: --set, and short forms of the most used keys.
class SceneOptions {
 public:
  /// Domain     called once; neither this moves nor `command` goes until overrides() was asked
  ///
  /// `allows_range`  --samples may be A:B
  void add_to(Command& command, bool allows_range = false);

  /// What --samples says, where that is a range, A:B, of the scene's samples; then it overrides nothing.
  std::optional<std::string> sample_range() const;

  /// All of them, in an order in which --set wins over the short forms.
  std::vector<format::Override> overrides() const;

  /// Adds --frame, for a command that looks at one frame.
  void add_frame_to(Command& command);

  /// What --frame says; without it the frame that a render without --frames gives.
  ///
  /// Errors     base::Error(kUsage) for what is not one frame
  int frame() const;

 private:
  struct Short {
    const char* name;  ///< "--samples"
    const char* key;
    std::string value;
    const Option* flag;
    bool is_list;  ///< words between commas
  };
  bool is_range(const Short& option) const;

  bool allows_range_ = false;
  std::vector<std::string> set_;
  std::string frame_;
  std::deque<Short> short_forms_;  ///< a deque: the parser holds on to where the values are
};

}  // namespace orrery::cli
