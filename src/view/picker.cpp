// SPDX-License-Identifier: Apache-2.0
#include "view/picker.h"

#include <cstdint>
#include <variant>

#include <fmt/core.h>

#include "base/error.h"
#include "compile/compiled_scene.h"
#include "data/table.h"
#include "render/object_at.h"
#include "scene/value_text.h"

namespace orrery::view {
namespace {

constexpr std::uint64_t kKeptData = std::uint64_t{256} << 20;  ///< columns of picked particles, bytes

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

/// Finds the table that holds an item, and replaces the index of the item by its number in that table.
///
/// Result     the number of tables if none holds it; the index is then that after all tables
std::size_t table_of(const std::vector<std::size_t>& sizes, std::size_t& index) {
  std::size_t table = 0;
  while (table < sizes.size() && index >= sizes[table]) index -= sizes[table++];
  return table;
}

template <class Authored>
void add_names(const Authored& authored, Picked& out) {
  if (!authored.name.empty()) out.values.emplace_back("name", authored.name);
  if (!authored.group.empty()) out.values.emplace_back("group", authored.group);
}

std::string row_of(std::size_t row, const std::filesystem::path& file) {
  return fmt::format("row {} of {}", row + 1, file.filename().string());
}

}  // namespace

/// The data of a points table from which particles were picked last.
struct Picker::Data {
  std::size_t table = 0;
  points::SourceRows rows;
};

std::optional<Picked> Picker::pick(double x, double y) {
  const std::shared_lock lock(looks_);
  if (!is_open_) return {};
  const compile::CompiledScene& compiled = prepared_.compiled();
  const std::optional<std::uint32_t> id =
      render::object_at(compiled, prepared_.built(), x * compiled.width, y * compiled.height);
  if (!id) return {};
  const kernel::RodArray rods = compiled.view().rods;
  return rods.contains(*id) ? describe_rod(rods.index(*id)) : describe_sphere(*id);
}

std::optional<std::array<math::Vec3d, 2>> Picker::bounds() const {
  const compile::SphereStore& spheres = prepared_.compiled().spheres;
  std::optional<std::array<math::Vec3d, 2>> out;
  // Lamps and grounds are not data.
  for (std::size_t i = scene().points.empty() ? 0 : scene().spheres.size(); i < spheres.size(); ++i) {
    const kernel::Sphere sphere = spheres[i];
    const math::Vec3d center{sphere.x, sphere.y, sphere.z};
    out = out ? std::array{math::least((*out)[0], center), math::greatest((*out)[1], center)}
              : std::array{center, center};
  }
  return out;
}

void Picker::close(load::SceneSource source, bool is_new) {
  is_open_ = false;  // calls of pick() from now on do not keep this waiting
  const std::unique_lock lock(looks_);
  source_ = std::move(source);
  if (is_new) read_ = nullptr;
}

Picked Picker::describe_sphere(std::size_t index) {
  const compile::CompiledScene& compiled = prepared_.compiled();
  const kernel::Sphere sphere = compiled.spheres[index];
  Picked out;
  out.center = {sphere.x, sphere.y, sphere.z};
  out.radius = sphere.radius;
  if (index < scene().spheres.size()) {
    const scene::Sphere& authored = scene().spheres[index];
    out.title = fmt::format("sphere[{}]", index);
    add_names(authored, out);
    out.values.emplace_back("material", scene().materials[authored.material].name);
    return out;
  }
  index -= scene().spheres.size();
  const std::size_t table = table_of(compiled.points_sizes, index);
  const std::filesystem::path& file = scene().points[table].file;
  const std::shared_ptr<const Data> kept = data_of(table);
  if (index >= kept->rows.rows.size()) throw base::Error(base::ErrorKind::kBadData, file.string() + " has changed");
  const std::uint32_t row = kept->rows.rows[index];
  out.title = row_of(row, file);
  for (const data::Column& column : kept->rows.table.columns)
    out.values.emplace_back(column.name, text_of(column, row));
  return out;
}

Picked Picker::describe_rod(std::size_t index) {
  const compile::CompiledScene& compiled = prepared_.compiled();
  const kernel::Rod rod = compiled.view().rods[index];
  const math::Vec3d a{rod.a[0], rod.a[1], rod.a[2]}, b{rod.b[0], rod.b[1], rod.b[2]};
  Picked out;
  out.center = (a + b) * 0.5;
  out.radius = rod.radius;
  if (index < scene().rods.size()) {
    out.title = fmt::format("rod[{}]", index);
    add_names(scene().rods[index], out);
  } else {
    index -= scene().rods.size();
    if (const std::size_t file = table_of(compiled.rod_file_sizes, index); file < scene().rod_files.size()) {
      out.title = row_of(index, scene().rod_files[file].file);
      add_names(scene().rod_files[file], out);
    } else if (const std::size_t of_stub = table_of(compiled.stub_counts, index); of_stub < scene().points.size()) {
      add_bond(of_stub, true, index, out);
    } else {
      const std::size_t of_bond = table_of(compiled.bond_counts, index);
      add_bond(of_bond, false, index, out);
    }
  }
  out.values.emplace_back("ends", scene::vector_text(a) + ", " + scene::vector_text(b));
  return out;
}

void Picker::add_bond(std::size_t table, bool is_stub, std::size_t index, Picked& out) {
  const std::shared_ptr<const Data> kept = data_of(table);
  const points::SourceRows& read = kept->rows;
  const std::string file = scene().points[table].file.filename().string();
  if (index >= (is_stub ? read.bond_stubs.size() : read.bond_pairs.size()))
    throw base::Error(base::ErrorKind::kBadData, file + " has changed");
  const scene::SphereBond ends = is_stub
                                     ? scene::SphereBond{read.bond_stubs[index].sphere, read.bond_stubs[index].partner}
                                     : read.bond_pairs[index];
  const std::uint32_t a = read.rows.at(ends.a), b = read.rows.at(ends.b);
  const bool is_arrow = !is_stub && index + scene().points[table].arrow_count >= read.bond_pairs.size();
  out.title = is_arrow ? fmt::format("arrow of row {} of {}", std::size_t{a} + 1, file)
                       : fmt::format("bond of rows {} and {} of {}", std::size_t{a} + 1, std::size_t{b} + 1, file);
  for (const data::Column& column : read.table.columns)
    out.values.emplace_back(column.name,
                            is_arrow ? text_of(column, a) : text_of(column, a) + ", " + text_of(column, b));
}

std::shared_ptr<const Picker::Data> Picker::data_of(std::size_t table) {
  const std::lock_guard lock(reading_);
  if (read_ && read_->table == table) return read_;
  read_ = nullptr;
  const auto kept = std::make_shared<Data>();
  kept->table = table;
  kept->rows = load::read_source_rows(source_, scene(), table);
  std::uint64_t bytes = kept->rows.bond_pairs.size() * sizeof(scene::SphereBond);
  for (const data::Column& column : kept->rows.table.columns)
    bytes += kept->rows.table.rows * data::bytes_per_value(column.type());
  if (bytes <= kKeptData) read_ = kept;
  return kept;
}

}  // namespace orrery::view
