// SPDX-License-Identifier: Apache-2.0
#include "view/viewer.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <new>
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
#include "job/outputs.h"
#include "job/run_job.h"
#include "job/write_outputs.h"
#include "load/read_scene.h"
#include "math/pixels.h"

namespace orrery::view {
namespace {

using Clock = std::chrono::steady_clock;

/// Time for a sketch, of which developing and encoding take a part.
constexpr double kSketchTime_s = 0.045;
constexpr int kNarrowestSketch = 160;  // px
constexpr std::chrono::milliseconds kRefresh{150};
/// Samples per pixel with which all pixels have some: those of the first pass of each half, or more than those of the
/// first of all.
constexpr double kShownSamples = 2;
constexpr const char* kReading = "reading";
constexpr double kProgressStep = 0.01, kBuildStep = 0.05;
constexpr int kSketchQuality = 75, kQuality = 85;  // of JPEG

double pixels_of(int width, int height) { return static_cast<double>(width) * static_cast<double>(height); }

/// Lights an image without shading, which has normals, from the camera. Lamps, which are black in it, become white.
void light(film::Picture& picture, const scene::Camera& camera) {
  const math::Vec3d back = math::normalized(camera.look_from - camera.look_at);
  const auto plane = [&picture](const char* name) {
    const auto is_it = [name](const film::Plane& p) { return p.name == name; };
    return std::find_if(picture.planes.begin(), picture.planes.end(), is_it)->values.data();
  };
  float* const color[3] = {plane("R"), plane("G"), plane("B")};
  const float* const normal[3] = {plane("N.X"), plane("N.Y"), plane("N.Z")};
  for (std::size_t i = 0; i < math::pixel_count(picture.width, picture.height); ++i) {
    const math::Vec3d n{normal[0][i], normal[1][i], normal[2][i]};
    if (n == math::Vec3d{}) continue;  // the background
    const bool is_lamp = color[0][i] + color[1][i] + color[2][i] == 0;
    const auto factor = static_cast<float>(0.4 + 0.6 * std::abs(math::dot(n, back)));  // edges keep some light
    for (float* const c : color) c[i] = (is_lamp ? 1 : c[i]) * factor;
  }
}

}  // namespace

std::string text_of(const base::Error& error) {
  std::string out;
  for (const base::Diagnostic& diagnostic : error.diagnostics()) out += base::formatted(diagnostic);
  return out + error.what();
}

/// An image that is being rendered, and its development so far.
struct Viewer::Live {
  Live(display::PictureInfo shown, annotation::Drawing over, Frame known)
      : info(std::move(shown)), drawing(std::move(over)), frame(std::move(known)) {}

  const display::PictureInfo info;
  const annotation::Drawing drawing;  ///< without outlines, which are found when the image is complete
  Frame frame;                        ///< what is known of its images
  preview::Canvas canvas{info.width, info.height};
  std::atomic<double> samples{0};    ///< per pixel
  std::atomic<bool> is_over{false};  ///< it is finished, or not wanted any more
  std::mutex mutex;                  // guards what follows
  Clock::time_point next = Clock::now();
  std::optional<display::PixelDeveloper> develop;  ///< empty: nothing has been shown
  annotation::Overlay overlay;
  std::vector<std::uint8_t> codes;
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
  std::shared_ptr<const job::Rendering> before;  // freed after the lock
  const std::lock_guard lock(mutex_);
  const bool keeps_moving = moves_ && wish.options == state_.wish.options;
  if (is_cancellable_ && !keeps_moving) {  // images of a drag are completed, or none would be seen
    cancel_ = true;
    drop_live();
  }
  const bool is_read = state_.read == state_.asked && wish.options == state_.wish.options;
  state_.wish = std::move(wish);
  before.swap(finished_);
  ++state_.asked;
  if (is_read) state_.read = state_.asked;
  announce();
  return state_.asked;
}

void Viewer::cancel() {
  const std::lock_guard lock(mutex_);
  if (is_cancellable_) cancel_ = true;
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
    const double read = *reading_;
    if (state_.activity == kReading &&
        (std::abs(read - state_.progress) >= kProgressStep || (read == 1) != (state_.progress == 1))) {
      state_.progress = read;
      announce();
    }
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

void Viewer::set_activity(const std::string& activity, double progress) {
  const std::lock_guard lock(mutex_);
  state_.activity = activity;
  state_.progress = progress;
  announce();
}

void Viewer::set_read(std::uint64_t wish) {
  const std::lock_guard lock(mutex_);
  if (state_.read >= wish) return;
  state_.read = wish;
  announce();
}

/// Announces the end of a wish. Domain: mutex_ is locked
void Viewer::set_served(std::uint64_t wish, const std::string& problem) {
  state_.served = wish;
  state_.problem = problem;
  state_.activity.clear();
  announce();
}

/// Ends the publication of the image that is being rendered. Domain: mutex_ is locked
void Viewer::drop_live() {
  if (live_) live_->is_over = true;
  live_ = nullptr;
}

/// Publishes the image that is being rendered, if it has changed and all of its pixels have samples.
void Viewer::refresh(Live& live) {
  const std::lock_guard lock(live.mutex);
  if (live.samples < kShownSamples || Clock::now() < live.next) return;
  const std::vector<std::size_t> cells = live.canvas.take_changed();
  if (cells.empty()) return;
  if (!live.develop) {
    live.develop.emplace(live.info.display);
    live.codes.resize(3 * math::pixel_count(live.info.width, live.info.height));
    if (!live.drawing.is_empty())
      live.overlay = annotation::draw(live.drawing, annotation::shown_by(live.info.display));
  }
  std::vector<float> coverage(preview::Canvas::kSide), rgb(3 * coverage.size());
  for (const std::size_t index : cells) {
    if (live.is_over) return;
    const preview::Cell cell = live.canvas.cell(index);
    for (int y = cell.y; y < cell.y + cell.height; ++y) {
      const std::size_t begin = 3 * math::pixel_index(cell.x, y, live.info.width);
      const std::span codes(&live.codes[begin], 3 * static_cast<std::size_t>(cell.width));
      live.canvas.read(cell.x, y, cell.width, rgb.data(), coverage.data());
      (*live.develop)(rgb.data(), coverage.data(), static_cast<std::size_t>(cell.width), codes.data());
      if (!live.drawing.is_empty()) annotation::blend(live.overlay, cell.x, y, codes);
    }
  }
  live.frame.samples = live.samples;
  live.frame.bytes = std::make_shared<const std::string>(
      image::jpeg_bytes(live.info.width, live.info.height, live.codes.data(), kQuality));
  live.next = Clock::now() + kRefresh;
  const std::lock_guard own(mutex_);
  if (!live.is_over) publish(live.frame);
}

/// Domain: mutex_ is locked
void Viewer::publish(Frame frame) {
  frame.number = frame_.number + 1;
  frame_ = std::move(frame);
  changed_.notify_all();
}

void Viewer::run() {
  const base::ReadProgressScope scope(reading_);
  const base::StopScope stop(&cancel_);
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return stops_ || state_.asked != served_; });
    if (stops_) return;
    Wish wish = state_.wish;
    const std::uint64_t number = state_.asked;
    moves_ = wish.moves;
    cancel_ = false;
    is_cancellable_ = made_options_ != wish.options;  // make_subject() may read for long
    lock.unlock();
    std::string problem;
    try {
      if (made_options_ != wish.options) make_subject(wish, number);
      set_read(number);
      const auto is_of_other = [other = other_size_](const std::string& setting) { return setting.starts_with(other); };
      if (std::any_of(wish.camera.begin(), wish.camera.end(), is_of_other)) {
        wish.camera.clear();
        correct(wish, number);
      }
      const std::pair of_sketch(words_of(fixed_, wish), wish.client);
      if (wish.moves || sketched_ != of_sketch) render(wish, number, true);
      sketched_ = of_sketch;
      if (!wish.moves) render(wish, number, false);
    } catch (const base::Error& error) {
      problem = error.kind() == base::ErrorKind::kStopped ? "stopped" : text_of(error);
    } catch (const std::bad_alloc&) {
      problem = "out of memory";
    } catch (const std::exception& error) {
      problem = std::string("internal error: ") + error.what();
    }
    lock.lock();
    drop_live();
    moves_ = false;
    served_ = number;
    if (!problem.empty() && (problem != "stopped" || state_.asked == number)) set_served(number, problem);
  }
}

/// Replaces a wish, unless another one has come.
void Viewer::correct(const Wish& wish, std::uint64_t number) {
  const std::lock_guard lock(mutex_);
  if (state_.asked == number) state_.wish = wish;
}

void Viewer::make_subject(Wish& wish, std::uint64_t number) {
  *reading_ = 0;
  set_activity(kReading);
  if (wish.options.erase(kAllFrames) > 0) {
    Wish film{wish.options};
    film.options.erase("--frame");
    film.options[kAllFrames] = {"all"};
    const Subject all = make_(words_of(fixed_, film));
    if (const auto range = all.chosen.find("--range"); range != all.chosen.end())
      wish.options["--range"] = {range->second};
    correct(wish, number);
  }
  Subject subject = make_(words_of(fixed_, {wish.options}));  // without the camera
  const scene::Scene scene = load::authored_scene(subject.job.scene);
  if (!subject.up) subject.up = scene.camera.up;
  if (scene.annotation.color_bar) subject.legend = {};  // it is in the image
  made_options_ = wish.options;
  is_new_subject_ = true;
  other_size_ = scene.camera.projection == scene::Projection::kPerspective ? "camera.width=" : "camera.vfov=";
  shading_ = scene.render.shading;
  const std::lock_guard lock(mutex_);
  state_.width = scene.image.width;
  state_.height = scene.image.height;
  state_.subject = std::make_shared<const Subject>(std::move(subject));
}

/// An image that is made for a wish.
struct Viewer::Image {
  Frame frame;  ///< its wish and client
  bool is_sketch = false;
  bool is_last = false;  ///< of the wish
  bool is_new = false;   ///< the first one of its subject
  std::vector<std::string> warnings = {};
  std::shared_ptr<job::Rendering> rendering = nullptr;
  std::shared_ptr<Live> live = nullptr;  ///< null for a sketch
  double progress = 0;                   ///< of a preparation that the state tells
};

void Viewer::render(const Wish& wish, std::uint64_t number, bool is_sketch) {
  {
    const std::lock_guard lock(mutex_);
    if (cancel_) throw base::Error(base::ErrorKind::kStopped, "another wish has come");
    is_cancellable_ = false;  // until the scene is prepared
    finished_ = nullptr;
  }
  job::Job job = state_.subject->job;  // the subject and its size are written by this thread only
  for (const std::string& setting : wish.camera) job.scene.overrides.add(setting);
  Image image{{0, number, wish.client}, is_sketch, is_sketch == wish.moves, is_new_subject_};
  if (is_sketch) {
    const int width = state_.width, height = state_.height;
    const double pixels = std::max(pixels_per_second_ * kSketchTime_s, 1.0);
    const double scale =
        std::clamp(std::sqrt(pixels / pixels_of(width, height)), std::min(1.0, double{kNarrowestSketch} / width), 1.0);
    const auto side = [scale](int full) { return std::max(1, static_cast<int>(std::lround(full * scale))); };
    job.scene.overrides.add(fmt::format("image.width={}", side(width)));
    job.scene.overrides.add(fmt::format("image.height={}", side(height)));
    job.scene.overrides.add("render.samples=1");
    job.scene.overrides.add("annotation.outline=0");
    job.scene.overrides.add("output.layers=[\"N\"]");
    if (shading_ == scene::Shading::kPath) job.scene.overrides.add("render.shading=flat");
    job.settings = {};
    job.denoise = false;
  }
  picker_.close(job.scene, std::exchange(is_new_subject_, false));
  job.prepared = prepared_;
  job.hooks = hooks_for(image);
  const base::Stopwatch watch;
  image.rendering = std::make_shared<job::Rendering>(job::render_in_memory(job));
  picker_.open();
  finish(image);
  const job::Phases& phases = image.rendering->report.phases;
  const double seconds = watch.seconds() - phases.read_s - phases.compile_s - phases.build_s;
  const film::Picture& picture = image.rendering->picture;
  if (is_sketch) pixels_per_second_ = pixels_of(picture.width, picture.height) / std::max(seconds, 1e-3);
}

job::Hooks Viewer::hooks_for(Image& image) {
  job::Hooks hooks;
  hooks.cancel = &cancel_;
  hooks.develops_pixels = true;
  hooks.on_warning = [&image](const base::Diagnostic& warning) { image.warnings.push_back(base::formatted(warning)); };
  hooks.on_preparation = [this, &image](const char* phase, double fraction) {
    if (!image.is_new || (fraction > 0 && fraction - image.progress < kBuildStep)) return;
    image.progress = fraction;
    set_activity(phase, fraction);
  };
  hooks.on_start = [this, &image](const display::PictureInfo& info, const annotation::Drawing& drawing) {
    begin(image, info, drawing);
  };
  if (image.is_sketch) return hooks;
  hooks.on_pixels = [&image](const film::Sums& state, const film::RenderedPixels& rendered) {
    image.live->canvas.write(state, rendered);
  };
  hooks.on_progress = [this, &image](const render::Progress& progress) {
    picker_.open();  // there is no progress before the BVH has been built
    const display::PictureInfo& info = image.live->info;
    image.live->samples = static_cast<double>(progress.samples_done) / pixels_of(info.width, info.height);
  };
  return hooks;
}

/// Tells clients about an image whose scene has been read.
void Viewer::begin(Image& image, const display::PictureInfo& info, const annotation::Drawing& drawing) {
  if (!image.is_sketch) {
    image.live = std::make_shared<Live>(info, drawing, image.frame);
    image.live->frame.type = "image/jpeg";
  }
  const scene::Scene& scene = prepared_->loaded().read.scene;
  const std::lock_guard lock(mutex_);
  live_ = image.live;
  is_cancellable_ = true;
  state_.warnings = image.warnings;
  state_.camera = scene.camera;
  if (!image.is_sketch && state_.asked != image.frame.wish) cancel_ = true;
  state_.activity.clear();
  state_.problem.clear();  // that of a wish before
  announce();
}

/// Publishes a finished image.
void Viewer::finish(Image& image) {
  const job::Rendering& rendering = *image.rendering;
  if (image.is_sketch && shading_ == scene::Shading::kPath)
    light(image.rendering->picture, prepared_->loaded().read.scene.camera);
  const film::EncodedPicture picture =
      job::develop_annotated(rendering.picture, rendering.drawing, rendering.display, 8, display::Alpha::kOverBlack);
  const render::Statistics& statistics = rendering.report.render;
  Frame& frame = image.frame;
  frame.samples =
      image.is_sketch ? 0 : static_cast<double>(statistics.paths) / pixels_of(picture.width, picture.height);
  frame.is_finished = !image.is_sketch;
  frame.noise = statistics.noise;
  frame.type = image.is_sketch ? "image/jpeg" : "image/png";
  if (image.is_sketch) {
    const std::vector<std::uint8_t> codes(picture.values.begin(), picture.values.end());
    frame.bytes = std::make_shared<const std::string>(
        image::jpeg_bytes(picture.width, picture.height, codes.data(), kSketchQuality));
  } else {
    frame.bytes = std::make_shared<const std::string>(image::png_bytes(picture, image::kUncompressed));
  }
  const auto bounds = image.is_new ? picker_.bounds() : std::nullopt;
  const std::lock_guard lock(mutex_);
  drop_live();
  if (image.is_new) state_.bounds = bounds;
  if (!image.is_sketch && state_.asked == frame.wish) finished_ = image.rendering;
  publish(frame);
  state_.warnings = std::move(image.warnings);  // more may have come while it was rendered
  if (image.is_last) set_served(frame.wish, "");
}

}  // namespace orrery::view
