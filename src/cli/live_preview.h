// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "cli/progress.h"
#include "job/hooks.h"
#include "preview/preview.h"
#include "preview/screen.h"
#include "preview/target.h"

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

/// Opens the terminal of `--preview terminal`; null for other targets.
///
/// Errors     those of PreviewScreen
std::unique_ptr<PreviewScreen> open_screen(const preview::Target& target);

/// Starts a preview and connects the hooks of jobs with it; null and no hooks without one.
///
/// `screen`   open_screen(target)
/// `note`     prints whole lines from any thread
/// Domain     the result outlives the jobs; `screen` and what `note` refers to outlive the result
std::unique_ptr<preview::Preview> start_preview(const preview::Target& target, PreviewScreen* screen,
                                                preview::OnNote note, job::Hooks& hooks);

}  // namespace orrery::cli
