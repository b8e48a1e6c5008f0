// SPDX-License-Identifier: Apache-2.0
#include "cli/live_preview.h"

#include <unistd.h>

#include <utility>

#include "cli/preview_screen.h"
#include "display/picture_info.h"
#include "film/partial.h"
#include "film/picture.h"
#include "film/rendered_pixels.h"
#include "job/hooks.h"
#include "preview/preview.h"

namespace orrery::cli {

PreviewScreen::PreviewScreen() : screen_(STDERR_FILENO) {}

std::unique_ptr<PreviewScreen> open_screen(const preview::Target& target) {
  return target.kind == preview::TargetKind::kTerminal ? std::make_unique<PreviewScreen>() : nullptr;
}

std::unique_ptr<preview::Preview> start_preview(const preview::Target& target, PreviewScreen* screen,
                                                preview::OnNote note, job::Hooks& hooks) {
  std::unique_ptr<preview::Sink> sink = preview::make_sink(target, screen ? &screen->screen() : nullptr, note);
  if (!sink) return nullptr;
  auto out = std::make_unique<preview::Preview>(std::move(sink), std::move(note));
  preview::Preview* const started = out.get();
  hooks.on_start = [started](const display::PictureInfo& picture) { started->begin(picture); };
  hooks.on_pixels = [started](const film::Partial& state, const film::RenderedPixels& rendered) {
    started->write(state, rendered);
  };
  hooks.on_denoised = [started](const film::Picture& picture) { started->write(picture); };
  hooks.develops_pixels = target.is_developed();
  return out;
}

}  // namespace orrery::cli
