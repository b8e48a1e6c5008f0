// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace orrery::cli {

/// Flags that change the scene: --set, and short forms of the most used.
class SceneOptions {
 public:
  void add_to(CLI::App& command);

  /// All of them as "key=value", in an order in which --set wins over the short forms.
  std::vector<std::string> overrides() const;

 private:
  std::vector<std::string> set_;
  std::string samples_, width_, height_, seed_, max_depth_, precision_, accelerator_;
};

}  // namespace orrery::cli
