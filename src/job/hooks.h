// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <string>

#include "base/error.h"
#include "display/forward.h"
#include "film/forward.h"
#include "render/forward.h"
#include "render/progress.h"

namespace orrery::job {

/// Callbacks by which a job reports to its caller, and flags by which the caller controls it. Every member may be
/// empty.
struct Hooks {
  std::function<void(const render::Progress&)> on_progress;   ///< see render::Settings
  std::function<void(double fraction)> on_build;              ///< see render::Settings
  std::function<void(const display::PictureInfo&)> on_start;  ///< called before rendering starts
  /// See render::Settings. Not called for a merge.
  std::function<void(const film::Partial&, const film::RenderedPixels&)> on_pixels;
  std::function<void(const film::Picture&)> on_denoised;  ///< receives the denoised image
  bool develops_pixels = false;  ///< `on_pixels` applies the display transform, so its names must be checked
  std::function<void(const base::Diagnostic&)> on_warning;
  std::function<void(const std::string&)> on_note;  ///< receives replies to requests that were made by a signal
  const std::atomic<bool>* cancel = nullptr;        ///< true stops the job
  std::atomic<bool>* snapshot = nullptr;            ///< true requests a checkpoint; the job resets it to false
};

}  // namespace orrery::job
