// SPDX-License-Identifier: Apache-2.0
#include "fuzz/readers.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <fstream>
#include <functional>
#include <memory>
#include <set>
#include <sstream>
#include <vector>

#include "base/error.h"
#include "data/data_file.h"
#include "load/load_scene.h"
#include "load/read_scene.h"
#include "load/write_scene.h"
#include "points/color_map.h"
#include "points/load_points.h"
#include "points/selection.h"
#include "scene/diagnostic.h"
#include "scene/validate.h"
#include "view/wish.h"

namespace orrery::fuzz {
namespace {

/// Replaces a file. Some file systems wait for the disk if an existing file is overwritten.
void write(const std::filesystem::path& file, const std::string& bytes) {
  std::filesystem::remove(file);
  std::ofstream(file, std::ios::binary) << bytes;
}

/// Checks that an error has actionable, printable diagnostics.
///
/// `has_file` false: the caller locates the error
std::string fault_with_error(const base::Error& error, bool has_file) {
  if (error.kind() != base::ErrorKind::kBadData) return "not bad data: " + std::string(error.what());
  if (error.diagnostics().empty()) return "bad data without a diagnostic";
  for (const base::Diagnostic& diagnostic : error.diagnostics()) {
    const std::string text = base::formatted(diagnostic);
    if (has_file && diagnostic.file.empty()) return "a diagnostic without a file: " + text;
    if (diagnostic.text.empty()) return "a diagnostic without a text: " + text;
    const auto is_control = [](char c) { return c >= 0 && c < ' ' && c != '\n' && c != '\t'; };
    if (std::any_of(text.begin(), text.end(), is_control)) return "a diagnostic with control characters";
  }
  return {};
}

std::string fault_with_result(const load::ReadResult& read) {
  for (const scene::SceneDiagnostic& diagnostic : scene::validate(read.scene))
    if (diagnostic.severity == base::Severity::kError)
      return "accepted despite " + diagnostic.key + ": " + diagnostic.text;
  if (read.settings.empty()) return "no settings";
  return {};
}

/// Checks that a written scene reads back and writes the same text again.
std::string fault_with_round_trip(const std::filesystem::path& folder, scene::Scene scene) {
  const std::string text = load::scene_text(scene, "");
  write(folder / "again.toml", text);
  const load::SceneSource again{.file = folder / "again.toml"};
  load::SceneReader reader(again);
  reader.add(scene::validate(reader.scene()));
  if (load::scene_text(reader.finish().scene, "") != text) return "changes when it is read back";
  return {};
}

std::string fault_with(const std::filesystem::path& folder, const std::filesystem::path& file,
                       const load::Overrides& overrides) {
  load::ReadResult read;
  try {
    load::SceneRequest request;
    request.source.file = file;
    request.source.overrides = overrides;
    read = load::read_with_data(request);
  } catch (const base::Error& error) {
    if (error.kind() == base::ErrorKind::kMissingInput && !error.diagnostics().empty()) return {};  // a data file
    return fault_with_error(error, true);
  } catch (const std::exception& error) {
    return "not an Error: " + std::string(error.what());
  }
  if (std::string fault = fault_with_result(read); !fault.empty()) return fault;
  try {
    return fault_with_round_trip(folder, read.scene);
  } catch (const base::Error& error) {
    return "the written scene is rejected: " +
           (error.diagnostics().empty() ? std::string(error.what()) : base::formatted(error.diagnostics()[0]));
  }
}

/// Copies of coordinates near the largest double overflow; scene::validate() reports them.
bool fits(const scene::Points& points, std::size_t material_count) {
  const std::size_t count = points.centers.size();
  const auto is_count = [=](std::size_t size) { return size == 0 || size == count; };
  return points.radii.size() == count && is_count(points.materials.size()) && is_count(points.colors.size()) &&
         points.palette_rec709 <= points.palette.size() &&
         std::none_of(points.radii.begin(), points.radii.end(), [](double r) { return std::isnan(r); }) &&
         std::all_of(points.palette.begin(), points.palette.end(), math::is_finite) &&
         std::all_of(points.colors.begin(), points.colors.end(), [&](auto c) { return c < points.palette.size(); }) &&
         std::all_of(points.materials.begin(), points.materials.end(), [=](auto m) { return m < material_count; }) &&
         std::all_of(points.bond_pairs.begin(), points.bond_pairs.end(),
                     [=](const auto& bond) { return bond.a < bond.b && bond.b < count; }) &&
         std::all_of(points.bond_stubs.begin(), points.bond_stubs.end(),
                     [=](const auto& stub) { return stub.sphere < count && stub.partner < count; });
}

/// Runs a reader and checks what it throws.
///
/// `accepts`  returns the violation in what it reads
std::string fault_with_reader(const std::function<std::string()>& accepts, bool has_file = true) {
  try {
    return accepts();
  } catch (const base::Error& error) {
    return fault_with_error(error, has_file);
  } catch (const std::exception& error) {
    return "not an Error: " + std::string(error.what());
  }
}

/// Loads the spheres of a file and checks them.
std::string fault_with_spheres(const points::LoadRequest& request, scene::Points& points) {
  bool is_loaded = false;
  std::string fault = fault_with_reader([&]() -> std::string {
    const auto diagnostics = points::load_points(request, points);
    const auto is_error = [](const auto& d) { return d.severity == base::Severity::kError; };
    is_loaded = std::none_of(diagnostics.begin(), diagnostics.end(), is_error);
    return !is_loaded || fits(points, request.materials->size()) ? "" : "accepted, but not renderable";
  });
  const bool has_points = !points.centers.empty() || !points.radii.empty() || !points.materials.empty();
  return fault.empty() && !is_loaded && has_points ? "points remain after an error" : fault;
}

/// Checks that the names and roles of a frame are consistent.
std::string fault_with_description(const data::FrameInfo& info) {
  std::set<std::string> numbers, texts;
  for (const data::ColumnInfo& column : info.columns) {
    auto& names = column.type == data::ColumnType::kText ? texts : numbers;
    if (!names.insert(column.name).second) return "two columns are named " + column.name;
  }
  const auto exists = [&](const std::string& name) { return numbers.count(name) + texts.count(name) > 0; };
  const data::Roles& roles = info.roles;
  for (const std::string& name : roles.position)
    if (numbers.count(name) == 0) return "position " + name + " is not a column of numbers";
  for (const auto& three : {roles.rgb, roles.image})
    for (const std::string& name : three)
      if (three[0].empty() != name.empty() || (!name.empty() && numbers.count(name) == 0))
        return "part of rgb or image, " + name + ", is not a column of numbers";
  for (const std::string& name : {roles.radius, roles.id})
    if (!name.empty() && numbers.count(name) == 0) return "radius or id " + name + " is not a column of numbers";
  for (const std::string& name : {roles.element, roles.chain})
    if (!name.empty() && texts.count(name) == 0) return "element or chain " + name + " is not a text column";
  if (!roles.type.empty() && !exists(roles.type)) return "type " + roles.type + " is not a column";
  return roles.radius_scale > 0 && roles.rgb_maximum > 0 ? "" : "a scale is not positive";
}

/// Checks that a table has the described columns and rows.
std::string fault_with_table(const data::FrameInfo& info, const data::Table& table) {
  if (table.rows != info.rows) return "the number of rows is not the described one";
  for (const data::ColumnInfo& described : info.columns) {
    const data::Column* const column = table.find(described.name);
    if (column == nullptr) return "column " + described.name + " is missing";
    if (column->type() != described.type) return "column " + described.name + " has another type";
    if (column->size() != table.rows) return "column " + described.name + " has another number of rows";
    if (const auto* words = std::get_if<data::Words>(&column->values))
      if (std::any_of(words->index.begin(), words->index.end(), [&](auto i) { return i >= words->words.size(); }))
        return "an index in column " + described.name + " is out of range";
  }
  return {};
}

/// Checks that the bonds of a frame are pairs of its rows, in order.
std::string fault_with_bonds(const data::FrameInfo& info, const std::vector<data::Bond>& bonds) {
  if (info.bonds == 0 && !bonds.empty()) return "bonds that are not described";
  for (const data::Bond& bond : bonds)
    if (bond.a >= bond.b || bond.b >= info.rows) return "a bond of rows that do not exist, or of a row with itself";
  for (std::size_t i = 1; i < bonds.size(); ++i)
    if (!(bonds[i - 1] < bonds[i])) return "the bonds do not ascend";
  return {};
}

/// Opens a data file; without success under the names of formats that are recognised by their names. A PSF file is the
/// topology of four particles.
std::unique_ptr<data::DataFile> open_data(const std::filesystem::path& folder, const std::string& bytes,
                                          std::filesystem::path& file) {
  data::OpenOptions options;
  options.decompressed_limit = std::uint64_t{1} << 24;
  if (bytes.starts_with("PSF")) {
    file = folder / "data.csv";
    options.topology = folder / "data.psf";
    write(file, "x,y,z\n0,0,0\n1,0,0\n0,1,0\n2,2,2\n");
    write(options.topology, bytes);
    return data::open(file, options);
  }
  for (const char* name : {"data", "data.xyz", "data.csv"}) {
    file = folder / name;
    write(file, bytes);
    try {
      return data::open(file, options);
    } catch (const base::Error& error) {
      const bool is_unknown = !error.diagnostics().empty() && error.diagnostics()[0].text == "unknown file format";
      if (!is_unknown || file.extension() == ".csv") throw;
    }
  }
  return {};
}

/// Loads the spheres of a frame by as many keys as the file has data for.
std::string fault_with_all_keys(const std::filesystem::path& file, const data::FrameInfo& info, int frame) {
  scene::Points points;
  points.file = file.filename();
  points.frame = frame + 1;
  points.radius.value = 1;
  points.color.column = info.columns.back().name;
  points.skip_bad = frame == 0;
  points.unwrap = info.box && (frame == 0 || !info.roles.image[0].empty());
  if (info.box) points.replicate = {2, 1, 1};
  if (frame == 0) {
    points.bonds.are_drawn = true;
    points.bonds.from = info.bonds > 0 ? "both" : "distance";
    points.bonds.length = 1.5;
  }
  if (!info.assemblies.empty()) points.assembly = info.assemblies.back().name;
  points::LoadRequest request;
  request.file = file;
  request.key = "points[0]";
  const std::vector<scene::Material> materials(3);
  request.materials = &materials;
  return fault_with_spheres(request, points);
}

}  // namespace

std::string fault_with_scene(const std::filesystem::path& folder, const std::string& bytes) {
  write(folder / "scene.toml", bytes);
  return fault_with(folder, folder / "scene.toml", {});
}

std::string fault_with_overrides(const std::filesystem::path& folder, const std::string& bytes) {
  write(folder / "base.toml",
        "[material.a]\ntype = \"metal\"\nalbedo = [1, 1, 1]\n[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = "
        "\"a\"\n");
  load::Overrides overrides;
  std::istringstream lines(bytes);
  for (std::string line; std::getline(lines, line);) overrides.add(line);
  return fault_with(folder, folder / "base.toml", overrides);
}

std::string fault_with_ply(const std::filesystem::path& folder, const std::string& bytes) {
  write(folder / "points.ply", bytes);
  scene::Points points;
  points.file = "points.ply";
  if (bytes.size() % 2 == 1) points.radius.value = 0.5;  // covers both ways to set the radius
  points::LoadRequest request;
  request.file = folder / points.file;
  request.key = "points[0]";
  const std::vector<scene::Material> materials(3);
  request.materials = &materials;
  std::string fault = fault_with_spheres(request, points);
  if (!std::all_of(points.centers.begin(), points.centers.end(), math::is_finite)) return "a centre is not finite";
  return fault;
}

std::string fault_with_data(const std::filesystem::path& folder, const std::string& bytes) {
  return fault_with_reader([&]() -> std::string {
    constexpr int kMaxFrames = 3;
    std::filesystem::path name;
    const auto file = open_data(folder, bytes, name);
    const int count = file->frame_count();
    if (count < 1) return "no frames";
    for (int frame = 0; frame < std::min(count, kMaxFrames); ++frame) {
      const data::FrameInfo info = file->describe(frame);
      if (std::string fault = fault_with_description(info); !fault.empty()) return fault;
      std::vector<std::string> columns;
      for (const data::ColumnInfo& column : info.columns) columns.push_back(column.name);
      if (std::string fault = fault_with_table(info, file->read(frame, columns)); !fault.empty()) return fault;
      if (std::string fault = fault_with_all_keys(name, info, frame); !fault.empty()) return fault;
      // Last, because damaged bonds are an error even if the rows are not.
      std::vector<std::string> warnings;
      if (std::string fault = fault_with_bonds(info, file->bonds(frame, warnings)); !fault.empty()) return fault;
    }
    return {};
  });
}

std::string fault_with_selection(const std::filesystem::path&, const std::string& bytes) {
  data::Table table;
  table.rows = 4;
  table.columns = {
      {"x", std::vector<double>{0, -1, 1e300, NAN}},   {"z", std::vector<float>{1, 2, 3, INFINITY}},
      {"type", std::vector<std::int32_t>{1, 2, 2, 3}}, {"c_stress[1]", std::vector<std::uint8_t>{0, 1, 2, 255}},
      {"name", data::Words{{"C", "N"}, {0, 1, 0, 0}}}, {"odd name", data::Words{{"N", ""}, {1, 0, 1, 1}}}};
  std::vector<data::ColumnInfo> columns;
  for (const data::Column& column : table.columns) columns.push_back({column.name, column.type()});
  return fault_with_reader(
      [&]() -> std::string {
        const points::Selection selection = points::parse_selection(bytes, columns);
        for (const std::string& name : selection.columns)
          if (name.empty()) return "a column without a name";
        const std::vector<std::uint8_t> mask = selection.evaluate(table);
        if (mask.size() != table.rows) return "a mask of another size";
        return std::all_of(mask.begin(), mask.end(), [](auto m) { return m <= 1; }) ? "" : "a mask other than 0 and 1";
      },
      false);
}

std::string fault_with_wish(const std::filesystem::path&, const std::string& bytes) {
  view::Wish wish;
  try {
    wish = view::read_wish(bytes, [](const std::string& option) { return option == "--select" || option == "--set"; });
  } catch (const base::Error& error) {
    return error.kind() == base::ErrorKind::kUsage ? "" : "refused as another kind: " + std::string(error.what());
  }
  std::size_t words = 0;
  for (const auto& [option, values] : wish.options) {
    if (option != "--select" && option != "--set") return "an option that is no control";
    words += values.empty() ? 1 : 2 * values.size();
  }
  if (view::words_of({}, {wish.options}).size() != words) return "a value without an option";
  const auto is_of_camera = [](const std::string& setting) { return setting.starts_with("camera."); };
  return std::all_of(wish.camera.begin(), wish.camera.end(), is_of_camera) ? "" : "a camera of other keys";
}

std::string fault_with_color_map(const std::filesystem::path& folder, const std::string& bytes) {
  write(folder / "map.txt", bytes);
  return fault_with_reader([&]() -> std::string {
    const points::ColorMap map = points::read_color_map(folder / "map.txt");
    if (map.knots.size() < 2 || map.knots.front().t != 0 || map.knots.back().t != 1) return "knots are missing";
    for (std::size_t i = 1; i < map.knots.size(); ++i)
      if (!(map.knots[i].t > map.knots[i - 1].t)) return "knots do not ascend";
    for (const math::Vec3d& c : points::palette(map, 100))
      if (!(c.x >= 0 && c.y >= 0 && c.z >= 0 && c.x <= 1 && c.y <= 1 && c.z <= 1)) return "a colour is out of range";
    return {};
  });
}

}  // namespace orrery::fuzz
