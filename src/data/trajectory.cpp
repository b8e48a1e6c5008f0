// SPDX-License-Identifier: Apache-2.0
#include "data/trajectory.h"

#include <algorithm>
#include <limits>

#include <fmt/core.h>

#include "base/stop_point.h"
#include "base/text.h"
#include "data/columns.h"

namespace orrery::data {

int TrajectoryFile::frame_count() {
  while (has_frame(static_cast<int>(begins_.size()))) {
  }
  return static_cast<int>(begins_.size());
}

bool TrajectoryFile::has_frame(int number) {
  const base::StopPoint stop;
  while (begins_.size() <= static_cast<std::size_t>(number)) {
    stop.check();
    if (next_ >= bytes_->size() && !begins_.empty()) return false;
    const auto found = static_cast<int>(begins_.size());
    if (found == std::numeric_limits<int>::max()) fail(found, "too many frames");
    const TrajectoryFrame frame = header(next_, found);
    begins_.push_back(next_);
    // An incomplete frame is reported when it is read: those before it are usable.
    next_ = std::min(frame.end, bytes_->size());
  }
  return true;
}

TrajectoryFrame TrajectoryFile::frame(int number) {
  has_frame(number);
  TrajectoryFrame out = header(begins_.at(static_cast<std::size_t>(number)), number);
  if (out.end > bytes_->size())
    fail(number, fmt::format("truncated: the frame ends at byte {}, the file at {}", out.end, bytes_->size()),
         number == 0 ? "" : fmt::format("use the frames before it, 1-{}", number));
  return out;
}

void TrajectoryFile::fail(int number, const std::string& text, const std::string& remedy) const {
  Faults(bytes_->file()).fail(0, fmt::format("frame {}: {}", number + 1, text), remedy);
}

std::string TrajectoryFile::header_bytes(std::uint64_t& at, std::size_t count, int number) const {
  std::string out = bytes_->text(at, count);
  if (out.size() < count) fail(number, "truncated: the file ends within the header of the frame");
  at += count;
  return out;
}

std::optional<Box> TrajectoryFile::box_of(const std::vector<double>& edges, int number) const {
  if (std::all_of(edges.begin(), edges.end(), [](double x) { return x == 0; })) return std::nullopt;
  Box box;
  for (std::size_t i = 0; i < 3; ++i) {
    box.edges[i] = {edges[3 * i], edges[3 * i + 1], edges[3 * i + 2]};
    if (!math::is_finite(box.edges[i])) fail(number, "the box has numbers that are not finite");
    box.periodic[i] = !(box.edges[i] == Vec3d{0, 0, 0});
  }
  return box;
}

FrameInfo TrajectoryFile::describe(int number) {
  const TrajectoryFrame found = frame(number);
  FrameInfo info;
  info.rows = found.rows;
  for (const TrajectoryArray& array : found.arrays)
    for (const RecordField& field : array.fields) info.columns.push_back({field.name, column_type(field.type)});
  info.roles.position = {"x", "y", "z"};
  info.step = found.step;
  if (found.time_ps) info.header.emplace_back("time", *found.time_ps);
  info.box = found.box;
  info.warnings.push_back("the file does not name its atoms; --topology FILE names a file that does");
  return info;
}

Table TrajectoryFile::read(int number, const std::vector<std::string>& columns) {
  const TrajectoryFrame found = frame(number);
  Table out;
  out.rows = static_cast<std::size_t>(found.rows);
  Faults faults(bytes_->file());
  for (const TrajectoryArray& array : found.arrays) {
    std::vector<RecordField> wanted = array.fields;
    std::erase_if(wanted, [&](const RecordField& field) { return !base::contains(columns, field.name); });
    for (Column& column : read_records(*bytes_, array.layout, wanted, faults)) {
      if (auto* const floats = std::get_if<std::vector<float>>(&column.values); floats && array.factor != 1)
        for (float& value : *floats) value *= array.factor;
      if (auto* const doubles = std::get_if<std::vector<double>>(&column.values); doubles && array.factor != 1)
        for (double& value : *doubles) value *= static_cast<double>(array.factor);
      out.columns.push_back(std::move(column));
    }
  }
  return in_order(std::move(out), columns);
}

namespace {

class NamedTrajectory final : public DataFile {
 public:
  NamedTrajectory(std::unique_ptr<DataFile> trajectory, std::unique_ptr<DataFile> topology,
                  const std::filesystem::path& trajectory_name, const std::filesystem::path& topology_name)
      : trajectory_(std::move(trajectory)),
        topology_(std::move(topology)),
        trajectory_name_(trajectory_name),
        topology_name_(topology_name.string()),
        names_(topology_->describe(0)) {
    format = trajectory_->format;
    const Roles& roles = names_.roles;
    // What moves is that of another time.
    std::vector<std::string> moving(roles.position.begin(), roles.position.end());
    moving.insert(moving.end(), roles.image.begin(), roles.image.end());
    std::erase_if(names_.columns, [&](const ColumnInfo& column) {
      return base::contains(moving, column.name) || column.name.starts_with("velocity") ||
             column.name.starts_with("force") || column.name.starts_with("fract_");
    });
    std::vector<std::string> all;
    for (const ColumnInfo& column : names_.columns) all.push_back(column.name);
    topology_->keep(0, [all](const FrameInfo&) { return all; });
  }

  int frame_count() override { return trajectory_->frame_count(); }
  bool has_frame(int frame) override { return trajectory_->has_frame(frame); }

  FrameInfo describe(int frame) override {
    FrameInfo out = trajectory_->describe(frame);
    if (!out.roles.element.empty() || !out.roles.id.empty())
      Faults(trajectory_name_)
          .fail(0, "the file names its particles, so that it needs no topology", "omit the topology");
    if (out.rows != names_.rows)
      Faults(trajectory_name_)
          .fail(0,
                fmt::format("frame {} has {}, but the topology {} has {}", frame + 1, base::counted(out.rows, "atom"),
                            topology_name_, names_.rows),
                "use the topology of the same atoms, for example without those that the trajectory leaves out");
    std::erase_if(names_.columns, [&](const ColumnInfo& c) { return has_column(out.columns, c.name); });
    out.columns.insert(out.columns.end(), names_.columns.begin(), names_.columns.end());
    const std::array<std::string, 3> position = out.roles.position;
    out.roles = names_.roles;
    out.roles.position = position;
    out.roles.image = {};
    if (!out.box) out.box = names_.box;
    out.title = names_.title;
    out.z_up = names_.z_up;
    out.bonds = names_.bonds;
    out.has_bonds = names_.has_bonds;
    out.lists_all_bonds = names_.lists_all_bonds;
    out.warnings = names_.warnings;
    return out;
  }

  Table read(int frame, const std::vector<std::string>& columns) override {
    std::vector<std::string> ours, theirs;
    for (const std::string& name : columns) (has_column(names_.columns, name) ? theirs : ours).push_back(name);
    Table out = trajectory_->read(frame, ours);
    Table names = topology_->read(0, theirs);
    std::move(names.columns.begin(), names.columns.end(), std::back_inserter(out.columns));
    return in_order(std::move(out), columns);
  }

  std::vector<Bond> bonds(int, std::vector<std::string>& warnings) override { return topology_->bonds(0, warnings); }

  std::uint64_t memory() const override { return trajectory_->memory() + topology_->memory(); }

 private:
  std::unique_ptr<DataFile> trajectory_, topology_;
  std::filesystem::path trajectory_name_;
  std::string topology_name_;
  FrameInfo names_;  ///< of the topology, with the columns that are used
};

}  // namespace

std::unique_ptr<DataFile> with_topology(std::unique_ptr<DataFile> trajectory, std::unique_ptr<DataFile> topology,
                                        const std::filesystem::path& trajectory_name,
                                        const std::filesystem::path& topology_name) {
  return std::make_unique<NamedTrajectory>(std::move(trajectory), std::move(topology), trajectory_name, topology_name);
}

}  // namespace orrery::data
