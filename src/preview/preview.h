// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "display/develop.h"
#include "display/settings.h"
#include "film/picture.h"
#include "preview/canvas.h"

namespace orrery::preview {

/// Fraction of the render's processor time that updates may use. The limit of the whole preview is 1 %; the rest is for
/// the copies that rendering threads make, and for the last update, which is not delayed.
inline constexpr double kShareOfTime = 0.003;

/// Decides when a preview is updated: once per interval, and less often if updates are expensive.
class Pacing {
 public:
  /// Starts without any updates.
  ///
  /// `interval_s`   minimum time between updates
  explicit Pacing(double interval_s) : interval_s_(interval_s) {}

  /// True if an update is due. It is assumed to cost as much as the last one.
  ///
  /// `now_s`        time since the render began
  /// `processor_s`  processor time of all threads since then
  bool is_due(double now_s, double processor_s) const noexcept {
    return now_s >= last_s_ + interval_s_ && spent_s_ + last_cost_s_ <= kShareOfTime * processor_s;
  }

  /// Records an update, and the processor time that it took.
  void updated(double now_s, double cost_s) noexcept {
    last_s_ = now_s;
    last_cost_s_ = cost_s;
    spent_s_ += cost_s;
  }

  /// Records processor time that was spent between updates.
  void spend(double cost_s) noexcept { spent_s_ += cost_s; }

 private:
  double interval_s_;
  double last_s_ = 0, last_cost_s_ = 0, spent_s_ = 0;
};

/// The file that the value of --preview names: a PNG. Empty if the value is.
///
/// Errors     base::Error(kUsage)
std::filesystem::path preview_file(const std::string& text);

/// Receives whole lines for the user. Called on the preview's thread.
using OnNote = std::function<void(const std::string& text)>;

/// Shows the images of consecutive renders while they are rendered: on a separate thread, rewrites a PNG, uncompressed
/// and through the display transform. Its readers never see an incomplete file.
///
/// The rendering threads only copy their pixels into a Canvas. Everything else happens on the preview's thread, which
/// uses at most kShareOfTime of the render's processor time.
class Preview {
 public:
  /// Starts the preview's thread.
  ///
  /// `on_note`  may be called until the destructor returns
  Preview(std::filesystem::path file, OnNote on_note);
  /// Ends the last image.
  ~Preview();
  Preview(const Preview&) = delete;
  Preview& operator=(const Preview&) = delete;

  /// Begins an image. The previous one has ended.
  void begin(const display::PictureInfo& picture);

  /// Takes rendered pixels. Called on the rendering threads, between begin() and end(); see Canvas::write.
  void write(const film::Sums& state, const film::RenderedPixels& rendered) noexcept {
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
  void set_up();
  void refresh();
  void attempt(const std::function<void()>& what);

  std::filesystem::path file_;
  OnNote on_note_;
  display::PictureInfo picture_;
  std::unique_ptr<Canvas> canvas_;
  std::optional<display::PixelDeveloper> develop_;
  film::EncodedPicture codes_;  ///< the content of the file
  bool failed_ = false;         ///< the file could not be written
  std::mutex mutex_;            // guards request_
  std::condition_variable wake_, served_;
  Request request_ = Request::kNone;
  std::thread thread_;
};

}  // namespace orrery::preview
