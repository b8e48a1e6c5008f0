// SPDX-License-Identifier: Apache-2.0
#include "plot/data_frames.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include <fmt/core.h>

#include "base/error.h"
#include "base/frames.h"
#include "plot/scene_text.h"
#include "points/rows.h"
#include "points/sources.h"
#include "points/spacing.h"
#include "scene/limits.h"

namespace orrery::plot {

namespace {

/// Frames of larger files are not counted for a message: that would read the whole file.
constexpr std::uintmax_t kMaxCountedBytes = std::uintmax_t{2} << 30;

/// Keys that read all particles, whatever is selected.
scene::PointsKeys everything(const scene::PointsKeys& keys) {
  scene::PointsKeys out;
  out.file = keys.file;
  out.component = keys.component;
  out.topology = keys.topology;
  out.material_column = keys.material_column;
  out.radius.value = 1;
  out.skip_bad = true;
  return out;
}

}  // namespace

DataFrames::DataFrames(const DataOptions& options, const std::filesystem::path& folder,
                       const data::DataFile::Expected& kept)
    : options_(options),
      folder_(folder),
      is_sequence_(base::is_sequence(options.file)),
      open_(options.open ? options.open : points::open_once()),
      numbers_(options.frames) {
  data::OpenOptions open_options;
  open_options.component = options.points.component;
  open_options.topology = options.points.topology;
  open_options.limit_memory(options.memory_limit);
  const int first = all().front();
  file_ = open_(file_of(first), open_options);
  fixed_frame_ = options.points.frame;
  if (fixed_frame_.value_or(1) < 0) *fixed_frame_ += file_->frame_count() + 1;
  if (fixed_frame_.value_or(1) < 1)
    throw base::Error(base::ErrorKind::kBadData,
                      fmt::format("--frame: there is no frame {}; {} has {} frames", *options.points.frame,
                                  file_of(first).string(), file_->frame_count()));
  const int frame = fixed_frame_ ? *fixed_frame_ : is_sequence_ ? 1 : first;
  if (frame > 1 && file_->has_frame(frame - 1)) described_ = frame;  // load() reports frames that do not exist
  if (kept) file_->keep(described_ - 1, kept);
  info_ = file_->describe(described_ - 1);
  if (options.points.component && !info_.has_components)
    base::refuse(
        fmt::format("--component: {} is {}; only HDF5 files have components", file_of(first).string(), file_->format));
  points::add_derived_columns(info_);
  require_frames();
  if (!options.all_frames) return;
  if (is_sequence_)
    base::refuse(
        "--frames: `all` selects the frames of a single file; for a sequence of files, write a range, e.g. 1-48");
  are_counted_ = false;
  if (kept) {
    file_->read(0, {info_.roles.position[0]});  // the next frame begins where its rows end
    numbers_ = {1};
    if (file_->has_frame(1)) numbers_.push_back(2);
  } else {
    count();
  }
}

void DataFrames::count() {
  if (are_counted_) return;
  numbers_.resize(static_cast<std::size_t>(file_->frame_count()));
  std::iota(numbers_.begin(), numbers_.end(), 1);
  are_counted_ = true;
}

const char* DataFrames::format() const { return file_->format; }

std::optional<int> DataFrames::frame_count() const {
  if (is_sequence_) return 1;
  std::error_code unknown;
  if (!options_.open && (std::filesystem::file_size(file_of(1), unknown) > kMaxCountedBytes || unknown)) return {};
  try {
    return file_->frame_count();
  } catch (const base::Error&) {
    return {};
  }
}

/// Before anything is written, so that no animation ends at the last frame of its file.
void DataFrames::require_frames() const {
  if (is_sequence_ || fixed_frame_ || numbers_.size() < 2) return;
  const int last = *std::max_element(numbers_.begin(), numbers_.end());
  if (!file_->has_frame(1) || file_->has_frame(last - 1)) return;  // a single frame is the same in all frames
  throw base::Error(base::ErrorKind::kBadData, fmt::format("--frames: there is no frame {}; {} has {} frames", last,
                                                           options_.file.string(), file_->frame_count()));
}

std::filesystem::path DataFrames::file_of(int frame) const {
  return is_sequence_ ? std::filesystem::path(base::with_frame(options_.file.string(), frame)) : options_.file;
}

LoadedFrame DataFrames::load(int frame, const scene::PointsKeys& keys, points::SourceRows* source,
                             const std::function<void(double)>& on_value) const {
  points::LoadRequest request;
  request.file = file_of(frame);
  request.topology = options_.points.topology;
  request.folder = folder_;
  request.key = "points[0]";
  request.frame = frame;
  request.memory_limit = options_.memory_limit;
  request.source = source;
  request.on_value = on_value;
  request.materials = &sphere_materials();
  request.open = open_;
  if (numbers_.empty()) request.moves_from = 0;  // a still image, for which the spheres may be kept
  LoadedFrame out{{keys, {}, {}}, {}, {}};
  if (is_sequence_) out.points.sequence = (keys.file.empty() ? options_.file : keys.file).string();
  if (keys.file.empty()) out.points.file = request.file;
  std::vector<base::Diagnostic> errors;
  out.diagnostics = points::load_points(request, out.points);
  for (const scene::SceneDiagnostic& d : out.diagnostics) {
    const bool has_key = d.key.size() > request.key.size() && d.key != request.key + ".file";
    std::string key = has_key ? d.key.substr(request.key.size() + 1) + ": " : "";
    if (key == "cryptomatte: ") key = "--outline-by: ";  // which alone sets this key of a plot
    const std::string number = numbers_.size() > 1 ? fmt::format("frame {}: ", frame) : "";
    auto& list = d.severity == base::Severity::kError ? errors : out.warnings;
    list.push_back(base::file_diagnostic(d.severity, request.file.string(), number + key + d.text));
  }
  if (!errors.empty()) {
    std::move(out.warnings.begin(), out.warnings.end(), std::back_inserter(errors));  // they may say why
    throw base::Error(base::ErrorKind::kBadData, "cannot use " + request.file.string(), std::move(errors));
  }
  return out;
}

void DataFrames::visit(const std::function<void(int)>& f) {
  if (!are_counted_) {
    numbers_.clear();
    for (int frame = 1; file_->has_frame(frame - 1); ++frame) {
      numbers_.push_back(frame);
      f(frame);
    }
    are_counted_ = true;
    return;
  }
  std::vector<int> frames = all();
  if (frames.size() > 1 && !is_sequence_ && !file_->has_frame(1)) frames.resize(1);
  for (const int frame : frames) f(frame);
}

Measures DataFrames::measures(const scene::PointsKeys& keys, bool of_spacing, bool of_radii) const {
  const bool of_vectors = !keys.vectors.columns.empty();
  scene::PointsKeys all_particles = everything(keys);
  all_particles.vectors.columns = keys.vectors.columns;
  all_particles.vectors.radius = scene::kLargestLength;  // no vector is so long that an arrow is made
  Measures out;
  const auto is_complete_with = [&](int frame) {
    scene::PointsKeys with_radii = all_particles;
    if (of_radii) with_radii.radius = keys.radius;
    LoadedFrame loaded = load(frame, with_radii);
    if (of_radii && out.mean_radius == 0 && !loaded.points.radii.empty()) {
      for (const double radius : loaded.points.radii) out.mean_radius += std::abs(radius);
      out.mean_radius /= static_cast<double>(loaded.points.radii.size());
    }
    // Particles without a valid radius, of which there was a warning, count for the others.
    if (of_radii && (of_spacing || of_vectors) && !loaded.warnings.empty()) loaded = load(frame, all_particles);
    if (of_spacing && out.spacing == 0) out.spacing = points::median_neighbor_distance(loaded.points.centers);
    if (out.rms_vector == 0) out.rms_vector = loaded.points.rms_vector;
    return (!of_spacing || out.spacing > 0) && (!of_radii || out.mean_radius > 0) &&
           (!of_vectors || out.rms_vector > 0);
  };
  if (is_sequence_) {
    const std::vector<int> frames = all();
    for (std::size_t i = 0; i < frames.size() && !is_complete_with(frames[i]);) ++i;
    return out;
  }
  for (int frame = 1; !is_complete_with(frame) && file_->has_frame(frame);) ++frame;
  return out;
}

std::vector<std::string> DataFrames::distinct_values(const scene::PointsKeys& keys, const std::string& column) const {
  scene::PointsKeys all_particles = everything(keys);
  all_particles.color.column = column;
  all_particles.color.map = "set2";
  return load(described_, all_particles).points.color_names;
}

double DataFrames::mean_coordination(const scene::PointsKeys& keys) const {
  constexpr std::size_t kMany = 100'000, kSample = 20'000;
  scene::PointsKeys sample = everything(keys);
  if (info_.rows > kMany) {
    const scene::PointArray centers = load(described_, sample).points.centers;
    if (centers.empty()) return 0;
    const math::Vec3d middle = centers[centers.size() / 2];
    std::vector<double> distances;
    for (const math::Vec3d center : centers) {
      const math::Vec3d d = center - middle;
      distances.push_back(std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}));
    }
    const auto last = distances.begin() + static_cast<std::ptrdiff_t>(std::min(kSample, distances.size() - 1));
    std::nth_element(distances.begin(), last, distances.end());
    const double coordinates[] = {middle.x, middle.y, middle.z};
    for (std::size_t k = 0; k < 3; ++k)
      sample.select +=
          fmt::format("{}abs(`{}` - ({})) <= {}", k == 0 ? "" : " && ", info_.roles.position[k], coordinates[k], *last);
  }
  sample.bonds.are_drawn = true;
  sample.bonds.from = "distance";
  try {
    const scene::Points points = load(described_, sample).points;
    const std::size_t ends = 2 * points.bond_pairs.size() + points.bond_stubs.size();
    return static_cast<double>(ends) / static_cast<double>(std::max<std::size_t>(points.centers.size(), 1));
  } catch (const base::Error&) {
    return 0;
  }
}

std::string all_of(const std::vector<std::string>& conditions) {
  if (conditions.size() == 1) return conditions.front();  // the points table checks it
  std::string out;
  for (const std::string& condition : conditions) {
    try {
      points::require_closed(condition);
    } catch (const base::Error& error) {
      throw base::Error(error.kind(), fmt::format("--select `{}`: {}", condition, points::fault_text(error)));
    }
    out += fmt::format("{}({})", out.empty() ? "" : " && ", condition);
  }
  return out;
}

}  // namespace orrery::plot
