// SPDX-License-Identifier: Apache-2.0
#include "view/viewer.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <new>
#include <utility>
#include <variant>

#include <fmt/core.h>

#include "base/error.h"
#include "base/stop_point.h"
#include "compile/compiled_scene.h"
#include "data/table.h"
#include "display/develop.h"
#include "display/settings.h"
#include "film/picture.h"
#include "image/jpeg_bytes.h"
#include "job/job.h"
#include "job/outputs.h"
#include "preview/file_sink.h"
#include "render/sphere_at.h"
#include "scene/value_text.h"

namespace orrery::view {
namespace {

using Clock = std::chrono::steady_clock;

/// Time for a moving image, of which developing and encoding take a part.
constexpr double kMovingTime_s = 0.045;
constexpr int kNarrowestMoving = 160;  // px
constexpr int kMovingDepth = 4;        // of paths
constexpr std::chrono::milliseconds kRefresh{150};
constexpr std::uint64_t kKeptSource = std::uint64_t{256} << 20;  ///< columns of picked particles, bytes
constexpr int kMovingQuality = 60, kQuality = 85;                // of JPEG

/// Text of an error with its diagnostics, a line each.
std::string text_of(const base::Error& error) {
  std::string out = error.what();
  for (const base::Diagnostic& diagnostic : error.diagnostics())
    out += "\n" + diagnostic.text + (diagnostic.remedy.empty() ? "" : "; " + diagnostic.remedy);
  return out;
}

/// A value of a data file, as short as it can be without loss.
std::string text_of(const data::Column& column, std::size_t row) {
  return std::visit(
      [row](const auto& values) {
        if constexpr (requires { values.words; })
          return values.words[values.index[row]];
        else
          return fmt::format("{}", values[row]);
      },
      column.values);
}

}  // namespace

/// An image that is being rendered, and its development so far.
struct Viewer::Live {
  explicit Live(const display::PictureInfo& info)
      : canvas(info.width, info.height),
        develop(info.display),
        codes(3 * static_cast<std::size_t>(info.width) * static_cast<std::size_t>(info.height)) {}

  preview::Canvas canvas;
  display::PixelDeveloper develop;
  std::mutex mutex;  // guards what follows
  std::vector<std::uint8_t> codes;
  Clock::time_point next = Clock::now();
  std::atomic<double> samples{0};  ///< per pixel
  std::uint64_t wish = 0;
};

Viewer::Viewer(MakeSubject make, std::vector<std::string> fixed, Wish first)
    : make_(std::move(make)), fixed_(std::move(fixed)), prepared_(std::make_shared<job::PreparedScene>(true)) {
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

/// The data of a points table from which particles were picked last.
struct Viewer::Source {
  std::size_t table = 0;
  points::SourceRows rows;
};

std::optional<Picked> Viewer::pick(double x, double y) {
  {
    const std::lock_guard lock(preparation_);
    if (!is_prepared_) return {};
    ++looks_;
  }
  struct End {
    Viewer& viewer;
    ~End() {
      const std::lock_guard lock(viewer.preparation_);
      --viewer.looks_;
      viewer.looked_.notify_all();
    }
  } const end{*this};
  const compile::CompiledScene& compiled = prepared_->compiled();
  const std::optional<std::uint32_t> id =
      render::sphere_at(compiled, prepared_->built(), x * compiled.width, y * compiled.height);
  if (!id) return {};
  const scene::Scene& scene = prepared_->loaded().read.scene;
  Picked out;
  const auto add_names = [&out](const auto& authored) {
    if (!authored.name.empty()) out.values.emplace_back("name", authored.name);
    if (!authored.group.empty()) out.values.emplace_back("group", authored.group);
  };
  if (const kernel::RodArray rods = compiled.view().rods; rods.contains(*id)) {
    std::size_t index = rods.index(*id);
    const kernel::Rod rod = rods[index];
    const math::Vec3d a{rod.a[0], rod.a[1], rod.a[2]}, b{rod.b[0], rod.b[1], rod.b[2]};
    out.center = (a + b) * 0.5;
    out.radius = rod.radius;
    // Finds the table that the rod belongs to, and its number in that table.
    const auto table_of = [&index](const std::vector<std::size_t>& sizes) {
      std::size_t table = 0;
      while (table < sizes.size() && index >= sizes[table]) index -= sizes[table++];
      return table;
    };
    if (index < scene.rods.size()) {
      out.title = fmt::format("rod[{}]", index);
      add_names(scene.rods[index]);
    } else {
      index -= scene.rods.size();
      if (const std::size_t file = table_of(compiled.rod_file_sizes); file < scene.rod_files.size()) {
        out.title = fmt::format("row {} of {}", index + 1, scene.rod_files[file].file.filename().string());
        add_names(scene.rod_files[file]);
      } else if (const std::size_t of_stub = table_of(compiled.stub_counts); of_stub < scene.points.size()) {
        add_bond(scene, of_stub, true, index, out);
      } else {
        add_bond(scene, table_of(compiled.bond_counts), false, index, out);
      }
    }
    out.values.emplace_back("ends", scene::vector_text(a) + ", " + scene::vector_text(b));
    return out;
  }
  const kernel::Sphere sphere = compiled.spheres[*id];
  out.center = {sphere.x, sphere.y, sphere.z};
  out.radius = sphere.radius;
  std::size_t index = *id;
  if (index < scene.spheres.size()) {
    const scene::Sphere& authored = scene.spheres[index];
    out.title = fmt::format("sphere[{}]", index);
    add_names(authored);
    out.values.emplace_back("material", scene.materials[authored.material].name);
    return out;
  }
  index -= scene.spheres.size();
  std::size_t table = 0;
  while (index >= compiled.points_sizes[table]) index -= compiled.points_sizes[table++];
  const std::shared_ptr<const Source> source = source_of(scene, table);
  if (index >= source->rows.rows.size())
    throw base::Error(base::ErrorKind::kBadData, scene.points[table].file.string() + " has changed");
  const std::uint32_t row = source->rows.rows[index];
  out.title = fmt::format("row {} of {}", row + 1, scene.points[table].file.filename().string());
  for (const data::Column& column : source->rows.table.columns)
    out.values.emplace_back(column.name, text_of(column, row));
  return out;
}

void Viewer::add_bond(const scene::Scene& scene, std::size_t table, bool is_stub, std::size_t index, Picked& out) {
  const std::shared_ptr<const Source> source = source_of(scene, table);
  const points::SourceRows& read = source->rows;
  const std::string file = scene.points[table].file.filename().string();
  if (index >= (is_stub ? read.bond_stubs.size() : read.bond_pairs.size()))
    throw base::Error(base::ErrorKind::kBadData, file + " has changed");
  const scene::SphereBond ends = is_stub
                                     ? scene::SphereBond{read.bond_stubs[index].sphere, read.bond_stubs[index].partner}
                                     : read.bond_pairs[index];
  const std::uint32_t a = read.rows.at(ends.a), b = read.rows.at(ends.b);
  const bool is_arrow = !is_stub && index + scene.points[table].arrow_count >= read.bond_pairs.size();
  out.title = is_arrow ? fmt::format("arrow of row {} of {}", std::size_t{a} + 1, file)
                       : fmt::format("bond of rows {} and {} of {}", std::size_t{a} + 1, std::size_t{b} + 1, file);
  for (const data::Column& column : read.table.columns)
    out.values.emplace_back(column.name,
                            is_arrow ? text_of(column, a) : text_of(column, a) + ", " + text_of(column, b));
}

std::shared_ptr<const Viewer::Source> Viewer::source_of(const scene::Scene& scene, std::size_t table) {
  const std::lock_guard lock(picking_);
  if (picked_from_ && picked_from_->table == table) return picked_from_;
  picked_from_ = nullptr;
  const auto source = std::make_shared<Source>();
  source->table = table;
  source->rows = load::read_source_rows(source_, scene, table);
  std::uint64_t bytes = source->rows.bond_pairs.size() * sizeof(scene::SphereBond);
  for (const data::Column& column : source->rows.table.columns)
    bytes += source->rows.table.rows * data::bytes_per_value(column.type());
  if (bytes <= kKeptSource) picked_from_ = source;
  return source;
}

/// Lets all who wait look again at the state. Domain: mutex_ is locked
void Viewer::announce() {
  ++state_.number;
  changed_.notify_all();
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
      live.canvas.read(cell.x, y, cell.width, rgb.data());
      live.develop(rgb.data(), static_cast<std::size_t>(cell.width),
                   &live.codes[static_cast<std::size_t>(y) * row_codes + 3 * static_cast<std::size_t>(cell.x)]);
    }
  }
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
  Wish without_camera = wish;
  without_camera.camera.reset();
  const base::StopScope scope(&cancel_);
  Subject subject = make_(words_of(fixed_, without_camera));
  made_options_ = wish.options;
  is_new_subject_ = true;
  const std::lock_guard lock(mutex_);
  is_cancellable_ = false;
  state_.subject = std::move(subject);
}

void Viewer::render(const Wish& wish, std::uint64_t number) {
  job::Job job = state_.subject.job;  // written by this thread only
  if (wish.camera)
    for (const std::string& setting : camera_settings(*wish.camera)) job.scene.overrides.add(setting);
  int width = 0, height = 0;
  {
    const std::lock_guard lock(mutex_);
    width = state_.width;
    height = state_.height;
    finished_ = nullptr;
  }
  const bool moves = wish.moves && width > 0;
  if (moves) {
    const double pixels = std::max(pixels_per_second_ * kMovingTime_s, 1.0);
    const double all = static_cast<double>(width) * static_cast<double>(height);
    const double scale = std::clamp(std::sqrt(pixels / all), std::min(1.0, double{kNarrowestMoving} / width), 1.0);
    const auto side = [scale](int full) { return std::max(1, static_cast<int>(std::lround(full * scale))); };
    job.scene.overrides.add(fmt::format("image.width={}", side(width)));
    job.scene.overrides.add(fmt::format("image.height={}", side(height)));
    job.scene.overrides.add("render.samples=1");
    job.scene.overrides.add("annotation.outline=0");
    if (prepared_depth_ > kMovingDepth) job.scene.overrides.add(fmt::format("render.max_depth={}", kMovingDepth));
    job.sampling = {};
    job.denoise = false;
  }
  {
    std::unique_lock lock(preparation_);
    is_prepared_ = false;
    looked_.wait(lock, [this] { return looks_ == 0; });
    source_ = job.scene;
    if (std::exchange(is_new_subject_, false)) picked_from_ = nullptr;  // no pick is under way
  }
  const auto set_prepared = [this] {
    const std::lock_guard lock(preparation_);
    is_prepared_ = true;
  };
  job.prepared = prepared_;
  job.hooks = {};
  job.hooks.cancel = &cancel_;
  job.hooks.develops_pixels = true;
  std::vector<std::string> warnings;
  job.hooks.on_warning = [&](const base::Diagnostic& warning) { warnings.push_back(base::formatted(warning)); };
  std::shared_ptr<Live> live;
  double build_reported = -1;
  job.hooks.on_build = [&](double fraction) {
    if (fraction - build_reported < 0.05) return;
    build_reported = fraction;
    const std::lock_guard lock(mutex_);
    state_.activity = fmt::format("building the BVH: {:.0f} %", 100 * fraction);
    announce();
  };
  job.hooks.on_start = [&](const display::PictureInfo& info) {
    if (!moves) {
      live = std::make_shared<Live>(info);
      live->wish = number;
    }
    const std::lock_guard lock(mutex_);
    live_ = live;
    is_cancellable_ = true;
    if (!moves && asked_ != number) cancel_ = true;
    state_.warnings = warnings;
    state_.camera = prepared_->loaded().read.scene.camera;
    if (!moves) {
      prepared_depth_ = prepared_->loaded().read.scene.render.max_depth;
      state_.width = info.width;
      state_.height = info.height;
    }
    state_.activity.clear();
    announce();
  };
  if (!moves) {
    job.hooks.on_pixels = [&](const film::Partial& state, const film::RenderedPixels& rendered) {
      live->canvas.write(state, rendered);
    };
    job.hooks.on_progress = [&](const render::Progress& progress) {
      set_prepared();  // there is no progress before the BVH has been built
      if (build_reported >= 0) {
        build_reported = -1;
        const std::lock_guard lock(mutex_);
        state_.activity.clear();
        announce();
      }
      live->samples = static_cast<double>(progress.samples_done) /
                      (static_cast<double>(live->canvas.width()) * static_cast<double>(live->canvas.height()));
    };
  }
  const auto rendering = std::make_shared<job::Rendering>();
  job.keep = rendering.get();
  const Clock::time_point begin = Clock::now();
  const job::JobReport report = job::run_job(job);
  set_prepared();

  const film::EncodedPicture picture = job::develop_annotated(rendering->picture, moves ? nullptr : &rendering->drawing,
                                                              rendering->display, 8, display::Alpha::kOverBlack);
  const std::vector<std::uint8_t> codes(picture.values.begin(), picture.values.end());
  Frame frame;
  frame.width = picture.width;
  frame.height = picture.height;
  frame.samples = static_cast<double>(report.render.paths) /
                  (static_cast<double>(picture.width) * static_cast<double>(picture.height));
  frame.wish = number;
  frame.is_finished = !moves;
  frame.noise = report.render.noise;
  frame.type = moves ? "image/jpeg" : "image/png";
  frame.bytes = std::make_shared<const std::string>(
      moves ? image::jpeg_bytes(picture.width, picture.height, codes.data(), kMovingQuality)
            : preview::encode_png({picture.width, picture.height, codes}));
  {
    const std::lock_guard lock(mutex_);
    live_ = nullptr;
    if (!moves) finished_ = rendering;
    frame.number = frame_.number + 1;
    frame_ = std::move(frame);
    state_.warnings = std::move(warnings);  // more may have come while it was rendered
    set_served(number, "");
  }
  if (moves)
    pixels_per_second_ = static_cast<double>(picture.width) * static_cast<double>(picture.height) /
                         std::chrono::duration<double>(Clock::now() - begin).count();
}

}  // namespace orrery::view
