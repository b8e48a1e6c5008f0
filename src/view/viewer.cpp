// SPDX-License-Identifier: Apache-2.0
#include "view/viewer.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <new>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include <fmt/core.h>

#include "annotation/annotate.h"
#include "annotation/drawing.h"
#include "base/error.h"
#include "base/stop_point.h"
#include "base/stopwatch.h"
#include "display/develop.h"
#include "display/settings.h"
#include "film/picture.h"
#include "image/write.h"
#include "job/job.h"
#include "job/outputs.h"

namespace orrery::view {
namespace {

using Clock = std::chrono::steady_clock;

/// Time for a moving image, of which developing and encoding take a part.
constexpr double kMovingTime_s = 0.045;
constexpr int kNarrowestMoving = 160;  // px
constexpr int kMovingDepth = 4;        // of paths
constexpr std::chrono::milliseconds kRefresh{150};
/// Time for which an image with parts that are not rendered yet is held back: the one before is shown longer.
constexpr std::chrono::milliseconds kHoldBack{1000};
constexpr int kMovingQuality = 60, kQuality = 85;  // of JPEG

/// Text of an error with its diagnostics, a line each.
std::string text_of(const base::Error& error) {
  std::string out = error.what();
  for (const base::Diagnostic& diagnostic : error.diagnostics())
    out += "\n" + diagnostic.text + (diagnostic.remedy.empty() ? "" : "; " + diagnostic.remedy);
  return out;
}

double pixels_of(int width, int height) { return static_cast<double>(width) * static_cast<double>(height); }

}  // namespace

/// An image that is being rendered, and its development so far.
struct Viewer::Live {
  Live(const display::PictureInfo& info, const annotation::Drawing& drawing)
      : canvas(info.width, info.height),
        develop(info.display),
        codes(3 * static_cast<std::size_t>(info.width) * static_cast<std::size_t>(info.height)) {
    if (!drawing.is_empty()) overlay = annotation::draw(drawing, annotation::shown_by(info.display));
    empty_cells.resize(canvas.cell_count());
    std::iota(empty_cells.begin(), empty_cells.end(), std::size_t{0});
  }

  preview::Canvas canvas;
  display::PixelDeveloper develop;
  std::optional<annotation::Overlay> overlay;  ///< without outlines, which are found when the image is complete
  std::mutex mutex;                            // guards what follows
  std::vector<std::uint8_t> codes;
  std::vector<std::size_t> empty_cells = {};  ///< ascending
  Clock::time_point next = Clock::now(), hold_end = next + kHoldBack;
  std::atomic<double> samples{0};  ///< per pixel
  std::uint64_t wish = 0;
};

Viewer::Viewer(MakeSubject make, std::vector<std::string> fixed, Wish first)
    : make_(std::move(make)),
      fixed_(std::move(fixed)),
      prepared_(std::make_shared<job::PreparedScene>(true)),
      picker_(*prepared_) {
  state_.wish = std::move(first);
  thread_ = std::thread([this] { run(); });
}

Viewer::~Viewer() {
  stop();
  thread_.join();
}

void Viewer::stop() {
  const std::lock_guard lock(mutex_);
  stops_ = true;
  cancel_ = true;
  changed_.notify_all();
}

std::uint64_t Viewer::ask(Wish wish) {
  const std::lock_guard lock(mutex_);
  const bool keeps_moving = moves_ && wish.options == state_.wish.options;
  if (is_cancellable_ && !keeps_moving) cancel_ = true;  // moving images are completed, or none would be seen
  state_.wish = std::move(wish);
  announce();
  return ++asked_;
}

State Viewer::state() const {
  const std::lock_guard lock(mutex_);
  State out = state_;
  out.words = words_of(fixed_, state_.wish);
  return out;
}

std::shared_ptr<const job::Rendering> Viewer::finished() const {
  const std::lock_guard lock(mutex_);
  return finished_;
}

Frame Viewer::frame(std::uint64_t after, std::chrono::milliseconds patience, std::optional<std::uint64_t> state) {
  const Clock::time_point end = Clock::now() + patience;
  std::unique_lock lock(mutex_);
  while (!stops_ && frame_.number <= after && state.value_or(state_.number) == state_.number && Clock::now() < end) {
    changed_.wait_until(lock, std::min(end, Clock::now() + kRefresh));
    if (frame_.number > after || !live_) continue;
    const std::shared_ptr<Live> live = live_;
    lock.unlock();
    refresh(*live);
    lock.lock();
  }
  return frame_;
}

/// Lets all who wait look again at the state. Domain: mutex_ is locked
void Viewer::announce() {
  ++state_.number;
  changed_.notify_all();
}

void Viewer::set_activity(const std::string& activity) {
  const std::lock_guard lock(mutex_);
  state_.activity = activity;
  announce();
}

/// Announces the end of a wish. Domain: mutex_ is locked
void Viewer::set_served(std::uint64_t wish, const std::string& problem) {
  state_.served = wish;
  state_.problem = problem;
  state_.activity.clear();
  announce();
}

/// Publishes the image that is being rendered, if it has changed.
void Viewer::refresh(Live& live) {
  const std::lock_guard lock(live.mutex);
  if (Clock::now() < live.next) return;
  const std::vector<std::size_t> cells = live.canvas.take_changed();
  if (cells.empty()) return;
  const auto row_codes = 3 * static_cast<std::size_t>(live.canvas.width());
  std::vector<float> rgb(3 * static_cast<std::size_t>(preview::Canvas::kSide));
  for (const std::size_t index : cells) {
    const preview::Cell cell = live.canvas.cell(index);
    for (int y = cell.y; y < cell.y + cell.height; ++y) {
      const std::span codes(&live.codes[static_cast<std::size_t>(y) * row_codes + 3 * static_cast<std::size_t>(cell.x)],
                            3 * static_cast<std::size_t>(cell.width));
      live.canvas.read(cell.x, y, cell.width, rgb.data());
      live.develop(rgb.data(), static_cast<std::size_t>(cell.width), codes.data());
      if (live.overlay) annotation::blend(*live.overlay, cell.x, y, codes);
    }
  }
  std::erase_if(live.empty_cells,
                [&](std::size_t cell) { return std::binary_search(cells.begin(), cells.end(), cell); });
  if (!live.empty_cells.empty() && Clock::now() < live.hold_end) return;
  Frame frame;
  frame.width = live.canvas.width();
  frame.height = live.canvas.height();
  frame.samples = live.samples;
  frame.type = "image/jpeg";
  frame.bytes =
      std::make_shared<const std::string>(image::jpeg_bytes(frame.width, frame.height, live.codes.data(), kQuality));
  live.next = Clock::now() + kRefresh;
  const std::lock_guard own(mutex_);
  if (live_.get() != &live) return;  // finished meanwhile
  frame.number = frame_.number + 1;
  frame.wish = live.wish;
  frame_ = std::move(frame);
  changed_.notify_all();
}

void Viewer::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return stops_ || asked_ != served_; });
    if (stops_) return;
    const Wish wish = state_.wish;
    const std::uint64_t number = asked_;
    moves_ = wish.moves;
    cancel_ = false;
    is_cancellable_ = false;
    lock.unlock();
    std::string problem;
    bool was_stopped = false;
    try {
      if (made_options_ != wish.options) make_subject(wish);
      render(wish, number);
    } catch (const base::Error& error) {
      was_stopped = error.kind() == base::ErrorKind::kStopped;
      if (!was_stopped) problem = text_of(error);
    } catch (const std::bad_alloc&) {
      problem = "out of memory";
    } catch (const std::exception& error) {
      problem = std::string("internal error: ") + error.what();
    }
    lock.lock();
    live_ = nullptr;
    moves_ = false;
    served_ = number;
    if (was_stopped) continue;
    if (!problem.empty()) set_served(number, problem);
  }
}

void Viewer::make_subject(const Wish& wish) {
  {
    const std::lock_guard lock(mutex_);
    is_cancellable_ = true;
    state_.activity = "reading";
    announce();
  }
  const base::StopScope scope(&cancel_);
  Subject subject = make_(words_of(fixed_, {wish.options}));  // without the camera
  made_options_ = wish.options;
  is_new_subject_ = true;
  const std::lock_guard lock(mutex_);
  is_cancellable_ = false;
  state_.subject = std::move(subject);
}

/// An image that is made for a wish.
struct Viewer::Image {
  std::uint64_t wish = 0;  ///< its number
  bool moves = false;
  std::vector<std::string> warnings = {};
  std::shared_ptr<job::Rendering> rendering = std::make_shared<job::Rendering>();
  std::shared_ptr<Live> live = nullptr;  ///< null for a moving image
  double build_reported = -1;            ///< fraction of the BVH build that the state tells; negative: none
};

void Viewer::render(const Wish& wish, std::uint64_t number) {
  job::Job job = state_.subject.job;  // written by this thread only
  int width = 0, height = 0;
  {
    const std::lock_guard lock(mutex_);
    width = state_.width;
    height = state_.height;
    finished_ = nullptr;
  }
  if (wish.camera)
    for (const std::string& setting : camera_settings(*wish.camera)) job.scene.overrides.add(setting);
  Image image{number, wish.moves && width > 0};
  if (image.moves) {
    const double pixels = std::max(pixels_per_second_ * kMovingTime_s, 1.0);
    const double scale =
        std::clamp(std::sqrt(pixels / pixels_of(width, height)), std::min(1.0, double{kNarrowestMoving} / width), 1.0);
    const auto side = [scale](int full) { return std::max(1, static_cast<int>(std::lround(full * scale))); };
    job.scene.overrides.add(fmt::format("image.width={}", side(width)));
    job.scene.overrides.add(fmt::format("image.height={}", side(height)));
    job.scene.overrides.add("render.samples=1");
    job.scene.overrides.add("annotation.outline=0");
    if (prepared_depth_ > kMovingDepth) job.scene.overrides.add(fmt::format("render.max_depth={}", kMovingDepth));
    job.sampling = {};
    job.denoise = false;
  }
  picker_.close(job.scene, std::exchange(is_new_subject_, false));
  job.prepared = prepared_;
  job.hooks = hooks_for(image);
  job.keep = image.rendering.get();
  const base::Stopwatch watch;
  job::run_job(job);
  picker_.open();
  finish(image);
  if (image.moves)
    pixels_per_second_ = pixels_of(image.rendering->picture.width, image.rendering->picture.height) / watch.seconds();
}

job::Hooks Viewer::hooks_for(Image& image) {
  job::Hooks hooks;
  hooks.cancel = &cancel_;
  hooks.develops_pixels = true;
  hooks.on_warning = [&image](const base::Diagnostic& warning) { image.warnings.push_back(base::formatted(warning)); };
  hooks.on_preparation = [this, &image](const char*, double fraction) {
    if (fraction - image.build_reported < 0.05) return;  // only a build reports more than its start
    image.build_reported = fraction;
    set_activity(fmt::format("building the BVH: {:.0f} %", 100 * fraction));
  };
  hooks.on_start = [this, &image](const display::PictureInfo& info) { begin(image, info); };
  if (image.moves) return hooks;
  hooks.on_pixels = [&image](const film::Partial& state, const film::RenderedPixels& rendered) {
    image.live->canvas.write(state, rendered);
  };
  hooks.on_progress = [this, &image](const render::Progress& progress) {
    // There is no progress before the BVH has been built. Outlines of translucent objects replace the opacities that a
    // pick would read, see render::outlines(): it is then possible when the image is complete.
    if (image.rendering->drawing.outline_px == 0 || prepared_->compiled().opacity.empty()) picker_.open();
    if (std::exchange(image.build_reported, -1) >= 0) set_activity("");
    const preview::Canvas& canvas = image.live->canvas;
    image.live->samples = static_cast<double>(progress.samples_done) / pixels_of(canvas.width(), canvas.height());
  };
  return hooks;
}

/// Tells clients about an image whose scene has been read.
void Viewer::begin(Image& image, const display::PictureInfo& info) {
  if (!image.moves) {
    image.live = std::make_shared<Live>(info, image.rendering->drawing);
    image.live->wish = image.wish;
  }
  const scene::Scene& scene = prepared_->loaded().read.scene;
  const std::lock_guard lock(mutex_);
  live_ = image.live;
  is_cancellable_ = true;
  state_.warnings = image.warnings;
  state_.camera = scene.camera;
  if (!image.moves) {
    if (asked_ != image.wish) cancel_ = true;
    prepared_depth_ = scene.render.max_depth;
    if (state_.width == 0) state_.first_size = {info.width, info.height};
    state_.width = info.width;
    state_.height = info.height;
  }
  state_.activity.clear();
  state_.problem.clear();  // that of a wish before
  announce();
}

/// Publishes a finished image.
void Viewer::finish(Image& image) {
  const job::Rendering& rendering = *image.rendering;
  const film::EncodedPicture picture =
      job::develop_annotated(rendering.picture, rendering.drawing, rendering.display, 8, display::Alpha::kOverBlack);
  const render::Statistics& statistics = rendering.report.render;
  Frame frame;
  frame.width = picture.width;
  frame.height = picture.height;
  frame.samples = static_cast<double>(statistics.paths) / pixels_of(picture.width, picture.height);
  frame.wish = image.wish;
  frame.is_finished = !image.moves;
  frame.noise = statistics.noise;
  frame.type = image.moves ? "image/jpeg" : "image/png";
  if (image.moves) {
    const std::vector<std::uint8_t> codes(picture.values.begin(), picture.values.end());
    frame.bytes = std::make_shared<const std::string>(
        image::jpeg_bytes(picture.width, picture.height, codes.data(), kMovingQuality));
  } else {
    frame.bytes = std::make_shared<const std::string>(image::png_bytes(picture, image::kUncompressed));
  }
  const std::lock_guard lock(mutex_);
  live_ = nullptr;
  if (!image.moves) finished_ = image.rendering;
  frame.number = frame_.number + 1;
  frame_ = std::move(frame);
  state_.warnings = std::move(image.warnings);  // more may have come while it was rendered
  set_served(image.wish, "");
}

}  // namespace orrery::view
