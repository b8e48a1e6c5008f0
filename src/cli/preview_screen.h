// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cli/progress.h"
#include "preview/screen.h"

namespace orrery::cli {

/// The terminal of `--preview terminal`, which then shows progress and messages as well.
class PreviewScreen : public BarDisplay {
 public:
  /// Opens the terminal of stderr.
  ///
  /// Errors     base::Error(kUsage) if stderr is not a terminal, or one without colours
  PreviewScreen();
  ~PreviewScreen() override { screen_.finish(); }

  void bar(const std::string& text) override { screen_.bar(text); }
  void note(const std::string& text) override { screen_.note(text); }
  preview::Screen& screen() { return screen_; }

 private:
  preview::Screen screen_;
};

}  // namespace orrery::cli
