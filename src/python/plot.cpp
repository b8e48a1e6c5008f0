// SPDX-License-Identifier: Apache-2.0
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "base/error.h"
#include "cli/film.h"
#include "cli/subject.h"
#include "data/data_file.h"
#include "job/batch.h"
#include "job/run_job.h"
#include "load/read_scene.h"
#include "python/arrays.h"
#include "python/picture.h"
#include "python/render.h"
#include "scene/scene.h"
#include "view/viewer.h"

namespace py = pybind11;

namespace orrery::python {
namespace {

using Triple = std::array<double, 3>;
using BoxTuple = std::tuple<Triple, std::array<Triple, 3>, std::array<bool, 3>>;
using Arrays = std::tuple<std::vector<NamedArray>, std::optional<BoxTuple>>;
/// Returns the arrays of a frame, which are numbered from 1; and the number of frames.
using ArraysOfFrames = std::tuple<py::function, int>;
using Source = std::variant<Arrays, ArraysOfFrames, std::filesystem::path>;

/// The name of arrays in a scene, which has no folder.
constexpr const char* kArraysName = "positions";

math::Vec3d vector_of(const Triple& v) { return {v[0], v[1], v[2]}; }

std::optional<data::Box> box_of(const std::optional<BoxTuple>& from) {
  if (!from) return {};
  const auto& [origin, edges, periodic] = *from;
  return data::Box{vector_of(origin), {vector_of(edges[0]), vector_of(edges[1]), vector_of(edges[2])}, periodic};
}

/// Particles that a function of Python returns, frame by frame. Keeps the arrays of the last frame. Its functions run
/// without the GIL.
class FramesFile : public data::DataFile {
 public:
  explicit FramesFile(const ArraysOfFrames& frames) : frames_(&frames) {
    format = "arrays";
    has_views = true;
  }
  ~FramesFile() override { release(); }
  FramesFile(const FramesFile&) = delete;
  FramesFile& operator=(const FramesFile&) = delete;

  int frame_count() override { return std::get<1>(*frames_); }
  data::FrameInfo describe(int frame) override { return at(frame).describe(0); }
  data::Table read(int frame, const std::vector<std::string>& columns) override { return at(frame).read(0, columns); }

 private:
  data::DataFile& at(int frame) {
    if (file_ && frame == frame_) return *file_;
    release();
    const py::gil_scoped_acquire acquired;
    arrays_ = std::get<0>(*frames_)(frame + 1).cast<Arrays>();
    file_ = data::open_table(kArraysName, table_of(std::get<0>(arrays_)), box_of(std::get<1>(arrays_)));
    frame_ = frame;
    return *file_;
  }
  void release() {
    file_.reset();
    const py::gil_scoped_acquire acquired;
    arrays_ = {};
  }

  const ArraysOfFrames* frames_;
  Arrays arrays_;
  std::unique_ptr<data::DataFile> file_;  ///< of `arrays_`
  int frame_ = 0;
};

/// The name of the data, and a function that opens them; null: they are a file.
///
/// Domain     `source` outlives the function
std::pair<std::string, points::OpenData> opened(const Source& source) {
  if (const auto* const file = std::get_if<std::filesystem::path>(&source)) return {file->string(), nullptr};
  std::function<std::unique_ptr<data::DataFile>()> make;
  if (const auto* const arrays = std::get_if<Arrays>(&source)) {
    const auto& [columns, box] = *arrays;
    make = [table = table_of(columns), box = box_of(box)] {
      return data::settled(data::open_table(kArraysName, table, box));
    };
  } else {
    make = [&source] { return data::settled(std::make_unique<FramesFile>(std::get<ArraysOfFrames>(source))); };
  }
  return {kArraysName, [make](const std::filesystem::path& path, const data::OpenOptions& options) {
            return path == kArraysName ? make() : data::open(path, options);
          }};
}

py::list strings_of(const std::vector<std::string>& texts) {
  py::list out;
  for (const std::string& text : texts) out.append(str_of(text));
  return out;
}

py::tuple plot(const Source& source, const std::vector<std::string>& words, int threads, std::uint64_t memory_limit,
               const py::object& on_progress, const py::object& on_warning) {
  const auto [file, open] = opened(source);
  std::vector<std::string> notes;
  const auto make_job = [&, &name = file, &opener = open] {
    view::Subject subject = cli::data_subject(name, words, {threads, memory_limit}, opener);
    notes = std::move(subject.notes);
    return std::move(subject.job);
  };
  Picture picture = render(make_job, on_progress, on_warning);
  return py::make_tuple(std::move(picture), strings_of(notes));
}

/// A film file that a call of movie() writes.
struct FilmFile {
  std::filesystem::path path;
  cli::FilmSettings settings;
  bool keeps_frames = false;
};

/// Renders the frames of a film and encodes it.
///
/// `hooks`    of all frames: progress is that of the whole film
/// Result     what it shows
view::Subject make_film(const FilmFile& to, const std::string& data, const std::vector<std::string>& words,
                        const job::Resources& resources, const points::OpenData& open, const job::Hooks& hooks) {
  cli::Film film(to.path, to.settings.fps, to.keeps_frames);
  view::Subject subject = cli::data_subject(data, words, resources, open, &to.settings);
  const scene::Window window = load::authored_scene(subject.job.scene).image.data_window();
  film.check_size(window.width, window.height);
  job::Batch batch;
  batch.job = subject.job;
  batch.job.outputs.images = {film.frame_pattern()};
  batch.job.skip_existing = true;  // frames of a stopped call
  batch.job.hooks = hooks;
  batch.scenes = {subject.job.scene.file};
  batch.frames = subject.frames;
  batch.others = {{film.file(), "path"}};
  const std::vector<job::Job> jobs = job::jobs_of(batch);
  film.open_folder();
  for (std::size_t done = 0; done < jobs.size(); ++done) {
    job::Job job = jobs[done];
    job.hooks.on_progress = [&, done](render::Progress p) {
      p.samples_done += done * p.samples_total;
      p.samples_total *= jobs.size();
      hooks.on_progress(p);
    };
    const job::JobReport report = job::run_job(job);
    if (!report.target_missed.empty())
      hooks.on_warning(base::file_diagnostic(base::Severity::kWarning, to.path.string(), report.target_missed));
  }
  film.encode(subject.frames);
  return subject;
}

py::tuple movie(const FilmFile& film, const Source& source, const std::vector<std::string>& words, int threads,
                std::uint64_t memory_limit, const py::object& on_progress, const py::object& on_warning) {
  const auto [file, open] = opened(source);
  view::Subject made;
  run(
      [&, &name = file, &opener = open](const job::Hooks& hooks) {
        made = make_film(film, name, words, {threads, memory_limit}, opener, hooks);
      },
      on_progress, on_warning);
  return py::make_tuple(made.frames, strings_of(made.notes));
}

}  // namespace

void bind_plot(py::module_& m) {
  py::class_<FilmFile>(m, "FilmFile")
      .def(py::init([](std::filesystem::path file, double fps, double turntable_s, bool keeps_frames) {
        return FilmFile{std::move(file), {fps, turntable_s}, keeps_frames};
      }));
  m.def("plot", &plot);
  m.def("movie", &movie);
}

}  // namespace orrery::python
