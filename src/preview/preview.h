// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "display/develop.h"
#include "display/settings.h"
#include "film/picture.h"
#include "preview/canvas.h"

namespace orrery::preview {

/// Fraction of the render's processor time that updates may use. The limit of the whole preview is 1 %; the rest is for
/// the copies that rendering threads make, and for the last update, which is not delayed.
inline constexpr double kShareOfTime = 0.003;

/// Minimum time between updates.
inline constexpr double kInterval_s = 1;

/// True if an update is due: when the interval has passed since the last one, and the processor time that it took is at
/// most kShareOfTime of what has been used since.
///
/// `since_s`      time since the last update
/// `processor_s`  processor time of all threads since then
/// `cost_s`       processor time of that update
constexpr bool is_due(double since_s, double processor_s, double cost_s) {
  return since_s >= kInterval_s && cost_s <= kShareOfTime * processor_s;
}

/// The file that the value of --preview names: a PNG. Empty if the value is.
///
/// Errors     base::Error(kUsage)
std::filesystem::path preview_file(const std::string& text);

/// Receives whole lines for the user. Called on the preview's thread.
using OnNote = std::function<void(const std::string& text)>;

/// Shows the images of consecutive renders while they are rendered: on a separate thread, rewrites a PNG, uncompressed
/// and through the display transform. Its readers never see an incomplete file.
///
/// The rendering threads only copy their pixels into a Canvas. Everything else happens on the image's own thread, which
/// uses at most kShareOfTime of the render's processor time.
class Preview {
 public:
  /// `on_note`  may be called until the destructor returns
  Preview(std::filesystem::path file, OnNote on_note) : file_(std::move(file)), on_note_(std::move(on_note)) {}
  /// Ends the last image.
  ~Preview() { end(); }
  Preview(const Preview&) = delete;
  Preview& operator=(const Preview&) = delete;

  /// Begins an image and its thread. The previous one has ended.
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
  void show(const display::Settings& settings);
  void refresh(const display::PixelDeveloper& develop, film::EncodedPicture& codes);

  std::filesystem::path file_;
  OnNote on_note_;
  std::unique_ptr<Canvas> canvas_;
  bool failed_ = false;  ///< the preview has ended
  std::mutex mutex_;     // guards is_over_
  std::condition_variable wake_;
  bool is_over_ = false;  ///< all pixels of the image have been rendered
  std::thread thread_;
};

}  // namespace orrery::preview
