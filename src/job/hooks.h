// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <string>

#include "base/diagnostic.h"
#include "render/progress.h"

namespace orrery::job {

/// How a job reports to its caller, and how the caller stops it. Every member may be empty.
struct Hooks {
  std::function<void(const render::Progress&)> on_progress;  ///< see render::Settings
  std::function<void(double fraction)> on_build;             ///< see render::Settings
  std::function<void(const base::Diagnostic&)> on_warning;
  std::function<void(const std::string&)> on_note;  ///< answers to requests made by signal
  const std::atomic<bool>* cancel = nullptr;        ///< true stops the job
  std::atomic<bool>* snapshot = nullptr;            ///< true requests a checkpoint; the job resets it to false
};

}  // namespace orrery::job
