// SPDX-License-Identifier: Apache-2.0
#include "points/load_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include "base/error.h"
#include "base/frames.h"
#include "base/text.h"
#include "data/columns.h"
#include "data/data_file.h"
#include "points/bonds.h"
#include "points/copies.h"
#include "points/sources.h"
#include "scene/limits.h"
#include "scene/value_text.h"

namespace orrery::points {

namespace {

using data::Vec3d;

/// Rows are numbered by 32 bits.
constexpr std::uint64_t kMaxRows = std::numeric_limits<std::uint32_t>::max();

/// Columns of traces.
constexpr const char *kNameColumn = "name", *kResidueColumn = "residue_number";
/// Radius of a trace, in radii of bonds.
constexpr double kTraceFraction = 4;

/// The largest distance of an atom with this name to the one before in a trace; 0 for atoms beside it.
double longest_step(const std::string& name) { return name == "CA" ? 4.6 : name == "P" ? 8.6 : 0; }

std::shared_ptr<data::DataFile> open(const LoadRequest& request, const scene::PointsKeys& points) {
  data::OpenOptions options;
  options.component = points.component;
  options.topology = request.topology;
  options.limit_memory(request.memory_limit);
  return request.open && points.sequence.empty() ? request.open(request.file, options)
                                                 : data::open(request.file, options);
}

/// The requested frame, from 1; before the file is opened.
int requested_frame(const LoadRequest& request, const scene::PointsKeys& points) {
  return points.frame ? *points.frame : !points.sequence.empty() ? 1 : request.frame;
}

/// The frame to read, from 1. A file of a single frame is the same in all rendered frames.
int frame_in(data::DataFile& file, const LoadRequest& request, const scene::PointsKeys& points) {
  const int frame = requested_frame(request, points);
  if (frame == 1 || points.frame) return frame;  // without counting: that may read the whole file
  return file.has_frame(1) ? frame : 1;
}

/// Loads the spheres of one points table.
class Loader {
 public:
  Loader(const LoadRequest& request, scene::Points& points)
      : request_(request), points_(points), faults_(request.key) {}

  std::vector<scene::SceneDiagnostic> run() {
    points_.release_data();
    file_ = open(request_, points_);
    if (const std::optional<int> frame = choose_frame()) {
      info_ = file_->describe(*frame);
      for (const std::string& warning : info_.warnings) faults_.warning(".file", warning);
      if (points_.component && !info_.has_components)
        faults_.warning(".component", "has no effect: only HDF5 files have components");
      add_derived_columns(info_);
      plan();
      if (!faults_.has_errors()) load(*frame);
    }
    if (faults_.has_errors()) points_.release_data();
    return faults_.take();
  }

 private:
  /// Returns the frame of the file, from 0.
  std::optional<int> choose_frame() {
    const int frame = frame_in(*file_, request_, points_);
    if (frame == 1) return 0;
    if (frame >= 1 && file_->has_frame(frame - 1)) return frame - 1;
    const int count = file_->frame_count();
    faults_.error(points_.frame ? ".frame" : ".file",
                  fmt::format("there is no frame {}; {} has {}{}", frame, points_.file.string(), count,
                              count == 1 ? " frame" : " frames"));
    return {};
  }

  void need(const std::string& column) {
    if (const std::vector<std::string> sources = sources_of(info_, column); !sources.empty()) {
      speed_sources_ = sources;
      for (const std::string& source : sources) need(source);
      return;
    }
    if (column.empty()) return;
    if (!base::contains(columns_, column)) columns_.push_back(column);
    ++uses_[column];
  }

  /// Determines the sources of radii, colours and opacities, and the columns to read.
  void plan() {
    for (const std::string& column : info_.roles.position) need(column);
    radius_ = radius_source(info_, points_.radius, faults_);
    need(radius_.column);
    color_ = color_source(info_, points_.color, request_.folder, faults_);
    for (const std::string& column : color_.columns) need(column);
    opacity_ = opacity_source(info_, points_.opacity, faults_);
    need(opacity_.column);
    need(info_.roles.id);
    for (const std::string& column : points_.cryptomatte)
      if (require_column(info_, column, false, ".cryptomatte", faults_)) need(column);
    labels_ = rules_of(info_, points_.labels, ".labels", parse_label, faults_, Colon::kFirst);
    representations_ = rules_of(info_, points_.representation, ".representation", parse_representation, faults_);
    plan_materials();
    need_columns_of(radius_.rules, color_.rules, opacity_.rules, labels_, representations_, materials_);
    plan_traces();
    plan_selection();
    copies_ = copies_of(info_, points_, faults_);
    if (std::any_of(copies_.begin(), copies_.end(), [](const Copy& c) { return c.chains != nullptr; }))
      need(info_.roles.chain);
    if (points_.unwrap) plan_unwrap();
    draws_bonds_ =
        points_.bonds.are_drawn || has_rule_for(Representation::kBallAndStick) || has_rule_for(Representation::kSticks);
    if (draws_bonds_ || joins_molecules_) {
      bond_source_ = bond_source(info_, points_.bonds, faults_);
      need(bond_source_.element);
    }
    if (draws_bonds_) {
      points_.bonds_from = !bond_source_.is_distance ? "file" : bond_source_.is_file ? "both" : "distance";
    }
    if (!points_.vectors.columns.empty()) plan_arrows();
    if (moves()) velocity_ = velocity_columns(info_, points_.motion, faults_);
    for (const std::string& column : velocity_) need(column);
    if (request_.source != nullptr) {  // all, in the order of the file
      columns_.clear();
      for (const data::ColumnInfo& column : info_.columns)
        if (!column.is_derived) columns_.push_back(column.name);
    }
    for (const data::ColumnInfo& column : info_.columns)
      if (!column.is_derived && !base::contains(columns_, column.name)) points_.unused.push_back(column.name);
    if (info_.rows > kMaxRows)
      faults_.error(".file", fmt::format("has {} rows; the maximum is {}", info_.rows, kMaxRows));
  }

  /// Needs the columns of the conditions of rules.
  void need_columns_of(const auto&... lists) {
    const auto need_list = [&](const auto& rules) {
      for (const auto& rule : rules)
        for (const std::string& column : rule.condition.columns) need(column);
    };
    (need_list(lists), ...);
  }

  bool has_rule_for(Representation kind) const {
    return std::any_of(representations_.begin(), representations_.end(),
                       [&](const auto& rule) { return rule.value == kind; });
  }

  void plan_materials() {
    if (info_.may_be_of_scene && data::has_column(info_.columns, points_.material_column))
      need(material_ = points_.material_column);
    std::vector<std::string> names;
    if (!points_.material_where.empty() && request_.materials != nullptr)
      for (const scene::Material& material : *request_.materials) names.push_back(material.name);
    const auto parse = [&](const std::string& name) { return index_of_name(name, names, "a material"); };
    materials_ = rules_of(info_, points_.material_where, ".material_where", parse, faults_);
  }

  void plan_traces() {
    if (!has_rule_for(Representation::kTrace)) return;
    for (const std::string& column : {std::string(kNameColumn), info_.roles.chain, std::string(kResidueColumn)}) {
      if (data::has_column(info_.columns, column))
        need(column);
      else
        return faults_.error(
            ".representation",
            fmt::format("a trace needs the columns `{}`, `{}` and a chain, which PDB and mmCIF files have", kNameColumn,
                        kResidueColumn));
    }
  }

  void plan_selection() {
    try {
      selection_ = parse_selection(points_.select, info_.columns, info_.roles.position);
    } catch (const base::Error& error) {
      return faults_.error(".select", fault_text(error));
    }
    for (const std::string& column : selection_.columns) need(column);
  }

  bool moves() const { return request_.moves_from && points_.motion.is_set(); }

  void plan_arrows() {
    const std::vector<std::string>& columns = points_.vectors.columns;
    if (columns.size() != 3)
      return faults_.error(".vectors.columns",
                           fmt::format("has {} columns; a vector has three, e.g. vx, vy and vz", columns.size()));
    for (const std::string& column : columns)
      if (require_column(info_, column, true, ".vectors.columns", faults_)) need(column);
    // The shafts are bonds too, and a table has one radius of bonds.
    if (points_.vectors.radius && points_.bonds.are_drawn)
      faults_.error(".vectors.radius", "shafts have the radius of the bonds; set `bonds.radius` instead");
  }

  void plan_unwrap() {
    if (!info_.box) return faults_.error(".unwrap", "the file has no box");
    joins_molecules_ = info_.roles.image[0].empty();
    for (const std::string& column : info_.roles.image) need(column);
  }

  /// Whether columns are needed once, so that their memory can be returned then.
  bool are_needed_once(const auto& columns) const {
    return request_.source == nullptr && std::all_of(columns.begin(), columns.end(), [&](const std::string& column) {
             const auto uses = uses_.find(column);
             return column.empty() || (uses != uses_.end() && uses->second == 1);
           });
  }

  /// Whether the centres replace a column piece by piece, see take_points().
  bool is_replaced_by_centers(const std::string& column) const {
    const std::array<std::string, 3>& position = info_.roles.position;
    const data::ColumnType type = type_of(info_, position[0]);
    return are_needed_once(position) && points_.select.empty() && info_.roles.id.empty() &&
           (type == data::ColumnType::kFloat32 || type == data::ColumnType::kFloat64) &&
           type_of(info_, position[1]) == type && type_of(info_, position[2]) == type &&
           std::find(position.begin(), position.end(), column) != position.end();
  }

  /// `count`         number of spheres in one image of the periodic box
  /// `are_rounded`   whether make_copies() rounds their centres
  /// `bonds`         of these spheres
  void require_memory(std::uint64_t count, bool are_rounded, const BondSet& bonds = {}) const {
    std::uint64_t row_bytes = color_.expression ? sizeof(double) : 0;
    for (const std::string& column : columns_)
      if (!is_replaced_by_centers(column)) row_bytes += data::bytes_per_value(type_of(info_, column));
    std::uint64_t sphere_bytes = bytes_per_sphere(info_, points_, radius_, are_rounded);
    if (has_materials()) sphere_bytes += sizeof(std::uint32_t);
    if (color_.is_set()) sphere_bytes += sizeof(std::uint16_t);
    if (opacity_.is_set()) sphere_bytes += sizeof(float);
    if (!points_.cryptomatte.empty()) sphere_bytes += sizeof(std::uint32_t);
    if (moves()) sphere_bytes += (request_.has_previous ? 2 : 1) * sizeof(Vec3d);
    if (moves() && velocity_.empty()) row_bytes += sizeof(Vec3d) + sizeof(std::uint64_t);  // of the frame beside it
    if (request_.source != nullptr) sphere_bytes += sizeof(std::uint32_t) + row_bytes;
    const Vec3d n = points_.replicate;
    const double images = n.x * n.y * n.z;
    double spheres = static_cast<double>(count) * images;
    double bytes = static_cast<double>(file_->memory() + info_.rows * row_bytes) +
                   images * static_cast<double>(copies_.size() * sizeof(Copy));
    if (draws_bonds_ || joins_molecules_) {
      const std::size_t rods = bonds.pairs.size() + 2 * bonds.crossing.size();  // those to other images are two stubs
      bytes += images * static_cast<double>(copies_.size() * rods * sizeof(scene::SphereBond));
      if (bond_source_.is_file) bytes += static_cast<double>(info_.bonds * kFileBondBytes);
      if (bond_source_.is_distance) bytes += static_cast<double>(info_.rows * kBondSearchBytes);
    }
    if (!points_.vectors.columns.empty()) {
      bytes += spheres * (sizeof(scene::SphereBond) + sizeof(Vec3d));
      spheres *= 1 + kHeadSpheres;
    }
    bytes += spheres * static_cast<double>(sphere_bytes);
    if (spheres > static_cast<double>(scene::kMaxSpheres))
      throw base::Error(base::ErrorKind::kBadData,
                        fmt::format("{} and its copies are {} spheres; the maximum is {}", request_.file.string(),
                                    scene::number_text(spheres), scene::kMaxSpheres));
    points::require_memory(request_.file, info_.rows, spheres, bytes, request_.memory_limit);
  }

  /// What a frame says of the chosen rows.
  struct Particles {
    data::Table table;
    Rows rows;
    scene::PointArray centers;
    scene::NumberArray radii;
    bool are_all_rows;  ///< no selection left one out, and ids did not reorder them
  };

  void load(int frame) {
    // Not known yet: the number of selected rows, that of spheres in the chains of an assembly, and how far out they
    // are.
    require_memory(points_.select.empty() ? copied_count(copies_, {}, info_.rows) : 0, !points_.assembly.empty());
    std::optional<Particles> read = read_particles(frame);
    if (!read) return;
    const Rows& rows = read->rows;
    Labels chains;
    if (const data::Column* column = read->table.find(info_.roles.chain); column != nullptr)
      chains = labels_of(*column, rows, read->table.rows);
    const Lattice lattice(points_.assembly.empty() ? info_.box : std::nullopt);
    if (joins_molecules_)
      join_molecules(bonds_of(read->table, rows, read->centers, lattice, frame), lattice, read->centers);
    BondSet bonds = draws_bonds_ ? bonds_of_rods(read->table, rows, read->centers, lattice, frame) : BondSet();
    if (!points_.are_traces.empty()) add_traces(read->table, rows, read->centers, bonds);
    if (faults_.has_errors()) return;
    const std::vector<Copy> ends = is_replicated() ? outermost(copies_, *info_.box, points_.replicate) : copies_;
    require_memory(copied_count(copies_, chains, rows.size()), are_rounded(ends, points_, read->centers, read->radii),
                   bonds);
    set_attributes(read->table, rows, read->centers);
    if (moves()) set_motion(*read, frame);
    points_.header = info_.header;
    if (info_.step) points_.header.emplace(points_.header.begin(), "step", *info_.step);
    points_.centers = std::move(read->centers);
    points_.radii = std::move(read->radii);
    if (request_.source != nullptr) request_.source->rows = rows.list();
    make_images(chains, bonds, lattice);
    points_.spheres_are_rows = read->are_all_rows && copies_.size() == 1 && points_.centers.size() == read->table.rows;
    if (request_.source == nullptr) return;
    request_.source->bond_pairs = points_.bond_pairs;
    request_.source->bond_stubs = points_.bond_stubs;
    request_.source->info = std::move(info_);
    request_.source->table = std::move(read->table);
  }

  /// Whether spheres have materials of their own.
  bool has_materials() const { return !material_.empty() || !materials_.empty(); }

  bool is_replicated() const { return !(points_.replicate == Vec3d{1, 1, 1}); }

  /// Reads the columns, and determines the spheres of the selected rows. Nothing if there are errors.
  std::optional<Particles> read_particles(int frame) {
    data::Table table = file_->read(frame, columns_);
    if (!speed_sources_.empty()) compute_speed(speed_sources_, table);
    add_expression(color_, points_.color, table, faults_);
    Rows rows = chosen_rows(table);
    if (rows.size() == 0)
      faults_.warning(
          table.rows == 0 ? ".file" : ".select",
          table.rows == 0 ? "the frame has no particles" : fmt::format("selects none of the {} particles", table.rows));
    if (!representations_.empty()) rows = represented(table, rows);
    const bool are_all_rows = rows.is_all();
    scene::NumberArray radii = radii_of(table, rows, radius_, points_.radius, faults_);
    bond_radius_ = bond_radius(info_, points_.bonds, radii);
    if (!representations_.empty() && !faults_.has_errors()) set_radii_of_representations(table, rows, radii);
    if (are_needed_once(std::array{radius_.column}))
      std::erase_if(table.columns, [&](const data::Column& column) { return column.name == radius_.column; });
    const std::array<std::string, 3>& position = info_.roles.position;
    scene::PointArray centers =
        are_needed_once(position) ? take_points(table, rows, position) : points_of(table, rows, position);
    if (points_.unwrap && !joins_molecules_) unwrap(table, rows, info_, centers);
    if (faults_.has_errors()) return {};
    // A radius below 0 makes hollow glass, in a scene or in a PLY file that was made for one. In other data it is an
    // error that the image would not show.
    const bool may_be_hollow = radius_.kind == RadiusSource::Kind::kValue || info_.may_be_hollow;
    keep_valid(points_, may_be_hollow, rows, centers, radii, faults_);
    if (faults_.has_errors()) return {};
    return Particles{std::move(table), std::move(rows), std::move(centers), std::move(radii), are_all_rows};
  }

  /// Determines how the rows are represented. Of those that are traces, the atoms that these pass through are left; the
  /// others are returned in their order.
  Rows represented(const data::Table& table, const Rows& rows) {
    kinds_.assign(rows.size(), std::nullopt);
    apply_rules(table, rows, representations_, points_.representation, ".representation", faults_,
                [&](std::size_t i, Representation kind) { kinds_[i] = kind; });
    if (!has_rule_for(Representation::kTrace)) return rows;
    const auto& names = std::get<data::Words>(table.find(kNameColumn)->values);
    std::vector<std::uint32_t> list;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const bool is_trace = kinds_[i] == Representation::kTrace;
      if (is_trace && longest_step(names.words[names.index[rows[i]]]) == 0) continue;
      list.push_back(static_cast<std::uint32_t>(rows[i]));
      points_.are_traces.push_back(is_trace ? 1 : 0);
      kinds_[kept++] = kinds_[i];
    }
    kinds_.resize(kept);
    if (std::find(points_.are_traces.begin(), points_.are_traces.end(), 1) == points_.are_traces.end())
      faults_.warning(".representation", "there are no C-alpha or phosphorus atoms for a trace");
    return list.size() == rows.size() ? rows : Rows(std::move(list));
  }

  /// Spheres of a trace close its ends and joints.
  double trace_radius() const { return points_.radius.value.value_or(kTraceFraction * bond_radius_); }

  void set_radii_of_representations(const data::Table& table, const Rows& rows, scene::NumberArray& radii) {
    constexpr double kBallFraction = 0.5;  // without elements
    scene::NumberArray balls;
    if (has_rule_for(Representation::kBallAndStick) && !info_.roles.element.empty()) {
      scene::PointsRadius ball;
      ball.element = "ball";
      balls = radii_of(table, rows, radius_source(info_, ball, faults_), ball, faults_);
      if (balls.size() != rows.size()) return;
    }
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (!kinds_[i] || *kinds_[i] == Representation::kSpheres) continue;
      radii.set(i, *kinds_[i] == Representation::kTrace          ? trace_radius()
                   : *kinds_[i] != Representation::kBallAndStick ? bond_radius_
                   : balls.empty()                               ? kBallFraction * radii[i]
                                                                 : balls[i]);
    }
    apply_rules(table, rows, radius_.rules, points_.radius.where, ".radius.where", faults_,
                [&](std::size_t i, double value) { radii.set(i, value); });
  }

  /// Returns the bonds between the spheres of the rows that are represented with bonds.
  BondSet bonds_of_rods(const data::Table& table, const Rows& rows, const scene::PointArray& centers,
                        const Lattice& lattice, int frame) {
    if (kinds_.empty()) return bonds_of(table, rows, centers, lattice, frame);
    std::vector<std::uint32_t> spheres, list;
    scene::PointArray places;
    for (std::uint32_t i = 0; i < rows.size(); ++i) {
      const bool has_bonds = kinds_[i]
                                 ? *kinds_[i] == Representation::kBallAndStick || *kinds_[i] == Representation::kSticks
                                 : points_.bonds.are_drawn;
      if (!has_bonds) continue;
      spheres.push_back(i);
      list.push_back(static_cast<std::uint32_t>(rows[i]));
      places.push_back(centers[i]);
    }
    BondSet out = bonds_of(table, Rows(std::move(list)), places, lattice, frame);
    for (scene::SphereBond& bond : out.pairs) bond = {spheres[bond.a], spheres[bond.b]};
    for (CrossingBond& bond : out.crossing) bond = {spheres[bond.a], spheres[bond.b], bond.shift};
    return out;
  }

  /// Joins the atoms of traces that follow each other in a chain, unless residues between them are missing.
  void add_traces(const data::Table& table, const Rows& rows, const scene::PointArray& centers, BondSet& bonds) const {
    const auto& names = std::get<data::Words>(table.find(kNameColumn)->values);
    const auto& chains = std::get<data::Words>(table.find(info_.roles.chain)->values);
    const data::Column& numbers = *table.find(kResidueColumn);
    for (std::uint32_t b = 1, a = 0; b < rows.size(); ++b) {
      if (points_.are_traces[b] == 0) continue;
      const std::size_t from = rows[a], to = rows[b];
      const bool follows = points_.are_traces[a] != 0 && chains.index[from] == chains.index[to] &&
                           std::abs(numbers.number(to) - numbers.number(from)) <= 1;
      if (follows && math::length(centers[b] - centers[a]) <= longest_step(names.words[names.index[to]]))
        bonds.pairs.push_back({a, b});
      a = b;
    }
    std::sort(bonds.pairs.begin(), bonds.pairs.end());
  }

  /// Sets what the spheres have besides centre and radius: colour, opacity, object, label, material, vector.
  void set_attributes(const data::Table& table, const Rows& rows, const scene::PointArray& centers) {
    set_colors(table, rows, color_, points_, faults_);
    if (request_.on_value && points_.color_range)
      for_each_shown(*table.find(points_.color.column), rows, points_.color.log, request_.on_value);
    if (opacity_.is_set()) points_.opacities = opacities_of(table, rows, opacity_, points_, faults_);
    if (!points_.cryptomatte.empty()) divide_into_objects(table, rows);
    points_.placed_labels = placed_labels(table, rows, centers, labels_, copies_.front(), points_, faults_);
    if (has_materials()) set_materials(table, rows);
    if (const std::vector<std::string>& columns = points_.vectors.columns; !columns.empty())
      points_.sphere_vectors = points_of(table, rows, {columns[0], columns[1], columns[2]}, points_.vectors.scale);
  }

  /// Sets the displacements of the spheres.
  void set_motion(const Particles& read, int frame) {
    const auto set = [&](scene::PointArray& to, const scene::PointArray& from, double factor) {
      to = valid_displacements(points_, read.rows, from, factor, faults_);
    };
    if (!velocity_.empty()) {
      const std::array<std::string, 3> columns{velocity_[0], velocity_[1], velocity_[2]};
      return set(points_.to_next, points_of(read.table, read.rows, columns), *points_.motion.frame_time);
    }
    const std::optional<scene::PointArray> next = displacements_to(read, frame, 1);
    std::optional<scene::PointArray> previous;
    if (!next || request_.has_previous) previous = displacements_to(read, frame, -1);
    if (next)
      set(points_.to_next, *next, 1);
    else if (previous)  // the last frame goes on as before
      set(points_.to_next, *previous, -1);
    else
      faults_.error(".motion.next_frame",
                    "the file has one frame; set `motion.frame_time` to move particles by their velocities");
    if (next && previous) set(points_.to_previous, *previous, 1);
  }

  /// The displacements of the spheres to another frame; nothing if there is none.
  ///
  /// `step`     1 or -1
  std::optional<scene::PointArray> displacements_to(const Particles& read, int frame, int step) {
    std::shared_ptr<data::DataFile> file = file_;
    if (points_.sequence.empty()) {
      frame += step;
      if (frame < 0 || !file->has_frame(frame)) return {};
    } else {
      LoadRequest other = request_;
      other.file = request_.folder / base::with_frame(points_.sequence, request_.frame + step);
      if (!std::filesystem::exists(other.file)) return {};
      file = open(other, points_);
    }
    const data::Roles roles = file->describe(frame).roles;
    std::vector<std::string> columns(roles.position.begin(), roles.position.end());
    if (!roles.id.empty()) columns.push_back(roles.id);
    return displacements(read.table, read.rows, read.centers, info_, file->read(frame, columns), roles, faults_);
  }

  /// Makes the images of all spheres in periodic boxes and assemblies, with their bonds and arrows, and clips them.
  void make_images(const Labels& chains, const BondSet& bonds, const Lattice& lattice) {
    if (is_replicated()) copies_ = replicated(copies_, *info_.box, points_.replicate);
    if (draws_bonds_ || !points_.are_traces.empty() || !points_.vectors.columns.empty()) {
      points_.bond_radius = points_.vectors.radius.value_or(bond_radius_) * points_.transform.scale;
      points_.trace_radius = trace_radius() * points_.transform.scale;
      copy_bonds(bonds, copies_, chains, lattice, points_);
    }
    std::vector<std::uint32_t>* const row_of_sphere = request_.source == nullptr ? nullptr : &request_.source->rows;
    make_copies(copies_, chains, points_, row_of_sphere);
    if (info_.is_unit_cell && draws_bonds_) complete_faces(*info_.box, points_, row_of_sphere);
    clip(points_, row_of_sphere);
    add_arrows(points_, row_of_sphere, faults_);
    advance(points_, request_.moves_from.value_or(0));
    if (!points_.objects.empty())
      for (const scene::BondStub& stub : points_.bond_stubs) points_.objects.push_back(points_.objects[stub.sphere]);
  }

  /// Returns the bonds between the spheres of the rows.
  BondSet bonds_of(const data::Table& table, const Rows& rows, const scene::PointArray& centers, const Lattice& lattice,
                   int frame) {
    BondSet out;
    if (bond_source_.is_file) {
      std::vector<std::string> warnings;
      out = bonds_of_rows(file_->bonds(frame, warnings), rows, table.rows, centers, lattice);
      for (const std::string& warning : warnings)
        faults_.warning(".bonds", warning + (bond_source_.is_distance ? "; close atoms are bonded" : ""));
    }
    if (!bond_source_.is_distance) return out;
    const Reach reach = reach_of(table, rows, bond_source_, points_.bonds, faults_);
    if (faults_.has_errors()) return out;
    std::optional<BondSet> near = find_bonds(centers, reach, lattice);
    if (!near) {
      faults_.error(points_.bonds.length ? ".bonds.length" : ".bonds.factor",
                    fmt::format("bonds of up to {} would join a particle to more than {} others; set a smaller {}, in "
                                "the unit of the file",
                                scene::number_text(2 * *std::max_element(reach.of_label.begin(), reach.of_label.end())),
                                kMaxNeighbors, points_.bonds.length ? "length" : "factor"));
      return out;
    }
    if (info_.is_unit_cell) remove_metal_bonds(reach, *near);
    if (!bond_source_.is_file) return std::move(*near);
    merge(out, std::move(*near));
    return out;
  }

  /// Returns the selected rows, ascending by particle id if there are ids: files list particles in any order.
  Rows chosen_rows(const data::Table& table) {
    std::vector<std::uint32_t> list;
    if (!points_.select.empty()) {
      const std::vector<std::uint8_t> mask = selection_.evaluate(table);
      for (std::uint32_t i = 0; i < mask.size(); ++i)
        if (mask[i] != 0) list.push_back(i);
      if (list.size() == mask.size())
        list.clear();
      else if (list.empty())
        return Rows(list);
    }
    const data::Column* const ids = table.find(info_.roles.id);
    if (ids == nullptr) return list.empty() ? Rows(table.rows) : Rows(std::move(list));
    std::size_t repeated = 0;
    Rows rows = rows_by_id(*ids, std::move(list), repeated);
    if (repeated > 0)
      faults_.warning(
          ".file",
          fmt::format("{}{} the id of another one in column `{}`; in other frames, particles may change places",
                      repeated, repeated == 1 ? " particle has" : " particles have", info_.roles.id));
    return rows;
  }

  /// Makes an object of each combination of values in the columns of `cryptomatte`.
  void divide_into_objects(const data::Table& table, const Rows& rows) {
    points_.objects.assign(rows.size(), 0);
    points_.object_names = {""};
    for (const std::string& column : points_.cryptomatte) {
      const Labels labels = labels_of(*table.find(column), rows, rows.size());
      std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> known;
      std::vector<std::string> names;
      for (std::size_t i = 0; i < rows.size(); ++i) {
        std::uint32_t& object = points_.objects[i];
        const std::pair key{object, labels.of_rows[i]};
        const auto [at, is_new] = known.try_emplace(key, static_cast<std::uint32_t>(names.size()));
        if (is_new) names.push_back(points_.object_names[object] + '.' + labels.names[key.second]);
        object = at->second;
      }
      points_.object_names = std::move(names);
    }
  }

  /// Sets the material of each sphere: that of the last rule that matches, else that in the file's column of indices
  /// into the scene's materials, else that of the table.
  void set_materials(const data::Table& table, const Rows& rows) {
    points_.materials.assign(rows.size(), points_.material);
    if (!material_.empty()) read_materials(table, rows);
    apply_rules(table, rows, materials_, points_.material_where, ".material_where", faults_,
                [&](std::size_t i, std::uint32_t material) { points_.materials[i] = material; });
  }

  void read_materials(const data::Table& table, const Rows& rows) {
    const std::size_t count = request_.materials == nullptr ? 0 : request_.materials->size();
    std::size_t bad = 0;
    for_each_number(*table.find(material_), rows, [&](std::size_t i, double v) {
      const bool exists = v >= 0 && v < static_cast<double>(count) && v == std::floor(v);
      points_.materials[i] = exists ? static_cast<std::uint32_t>(v) : 0;
      if (!exists && ++bad <= scene::kMaxReported)
        faults_.error(".file", fmt::format("{} has material {}; the scene has {}, counted from 0",
                                           row_name(points_, rows[i]), scene::number_text(v), count));
    });
    faults_.error_if_any(".file", scene::rest_text(bad));
  }

  const LoadRequest& request_;
  scene::Points& points_;
  KeyFaults faults_;
  std::shared_ptr<data::DataFile> file_;
  data::FrameInfo info_;
  std::vector<std::string> columns_;
  std::map<std::string, int> uses_;  ///< how often a column is needed
  RadiusSource radius_;
  ColorSource color_;
  OpacitySource opacity_;
  Selection selection_;
  std::vector<Rule<std::string>> labels_;
  std::vector<Rule<Representation>> representations_;
  std::vector<std::optional<Representation>> kinds_;  ///< of the rows; none: as the keys of radius and bonds say
  bool draws_bonds_ = false;
  bool joins_molecules_ = false;  ///< unwraps by bonds
  double bond_radius_ = 0;        ///< before the transform
  std::vector<Copy> copies_;
  BondSource bond_source_;
  std::vector<std::string> speed_sources_;  ///< columns that `speed` is computed from; empty: it is not needed
  std::vector<std::string> velocity_;       ///< columns; empty: spheres rest, or move to the next frame
  std::string material_;                    ///< column of material indices; empty: none
  std::vector<Rule<std::uint32_t>> materials_;
};

}  // namespace

std::vector<scene::SceneDiagnostic> load_points(const LoadRequest& request, scene::Points& points) {
  if (request.loaded) {
    LoadedPoints loaded = std::exchange(*request.loaded, {});
    const scene::PointsKeys &theirs = loaded.points, &ours = points;
    const bool has_motion = !ours.motion.is_set() || (request.moves_from.value_or(0) == 0 && !request.has_previous);
    if (loaded.frame == request.frame && theirs == ours && has_motion && request.source == nullptr &&
        !request.on_value) {
      points = std::move(loaded.points);
      return std::move(loaded.diagnostics);
    }
  }
  return Loader(request, points).run();
}

int chosen_frame(const LoadRequest& request, const scene::PointsKeys& points) {
  const int frame = requested_frame(request, points);
  return frame == 1 || points.frame ? frame : frame_in(*open(request, points), request, points);
}

}  // namespace orrery::points
