// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "job/forward.h"
#include "preview/forward.h"
#include "preview/sink.h"
#include "preview/target.h"

namespace orrery::cli {

class PreviewScreen;

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
