// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "display/picture_info.h"
#include "preview/canvas.h"
#include "preview/sink.h"

namespace orrery::preview {

/// Shows the images of consecutive renders while they are rendered, on a separate thread.
///
/// The rendering threads only copy their pixels into a Canvas. Everything else happens on the preview's thread, which
/// uses at most kShareOfTime of the render's processor time.
class Preview {
 public:
  /// Starts the preview's thread.
  ///
  /// `on_note`  may be called until the destructor returns
  Preview(std::unique_ptr<Sink> sink, OnNote on_note);
  /// Ends the last image.
  ~Preview();
  Preview(const Preview&) = delete;
  Preview& operator=(const Preview&) = delete;

  /// Begins an image. The previous one has ended.
  void begin(const display::PictureInfo& picture);

  /// Takes rendered pixels. Called on the rendering threads, between begin() and end(); see Canvas::write.
  void write(const film::Partial& state, const film::RenderedPixels& rendered) noexcept {
    canvas_->write(state, rendered);
  }

  /// Replaces the image. Called after all pixels have been rendered, before end().
  void write(const film::Picture& picture) noexcept { canvas_->write(picture); }

  /// Ends the image, after showing the pixels that are still missing. Does nothing without an image.
  void end();

 private:
  enum class Request { kNone, kBegin, kEnd, kQuit };

  void ask(Request request);
  void run();
  void answer();
  void serve(Request request);
  void refresh();

  std::unique_ptr<Sink> sink_;
  OnNote on_note_;
  display::PictureInfo picture_;
  std::unique_ptr<Canvas> canvas_;
  bool failed_ = false;  ///< the sink threw an exception
  std::mutex mutex_;     // guards request_
  std::condition_variable wake_, served_;
  Request request_ = Request::kNone;
  std::thread thread_;
};

}  // namespace orrery::preview
