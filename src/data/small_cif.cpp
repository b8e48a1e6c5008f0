// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <gemmi/numb.hpp>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "base/stop_point.h"
#include "base/text.h"
#include "data/atom_table.h"
#include "data/cif_rows.h"
#include "data/columns.h"
#include "data/crystal.h"
#include "data/dictionary.h"
#include "data/elements.h"
#include "data/readers.h"

// CIF files of small molecules and minerals: the asymmetric unit of a crystal.
//
// Reference  core-cif
namespace orrery::data {
namespace {

using Row = std::vector<std::string>;

/// The first value of a row from a column on that is not empty.
std::string first_value(const Row& row, std::size_t column) {
  for (; column < row.size(); ++column)
    if (!row[column].empty()) return row[column];
  return {};
}

/// An atom of the asymmetric unit.
struct CrystalSite {
  Vec3d at{0, 0, 0};  ///< fractions of the edges
  double occupancy = 1;
  std::string element, name;
  std::string alternative;  ///< disorder assembly and group; empty: none
  std::string assembly;
};

/// A data block that has atoms.
struct Crystal {
  std::string title;
  std::array<double, 6> cell{};
  std::uint64_t cell_line = 0;
  Row group_names;  ///< two Hall symbols, four Hermann-Mauguin symbols, two numbers; empty where the file has none
  std::uint64_t group_line = 0;
  Operators operators;
  std::vector<CrystalSite> sites;
  std::uint64_t dummies = 0;  ///< sites that are no atoms, or have no coordinates
  Box box;
  std::vector<std::string> warnings;
};

constexpr const char* kCoordinates[] = {"x", "y", "z", "fract_x", "fract_y", "fract_z"};

/// The element that begins an atom's type or label: "Fe3+", "O1W", "Ca2"; "X" if there is none.
std::string element_in(std::string_view text) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto letters = static_cast<std::size_t>(std::find_if_not(text.begin(), text.end(), is_letter) - text.begin());
  for (std::size_t length = std::min<std::size_t>(letters, 2); length > 0; --length)
    if (const Element* const element = find_element(text.substr(0, length))) return std::string(element->symbol);
  return "X";
}

class SmallCif final : public DataFile {
 public:
  SmallCif(const Bytes& bytes, const OpenOptions& options)
      : file_(bytes->file()), faults_(file_), limit_(options.memory_limit) {
    format = "CIF";
    constexpr double kMemoryPerByte = 2.25;  // as in mmCIF files
    require_parse_memory(bytes->file(), bytes->size(), kMemoryPerByte, bytes->memory(), limit_);
    const std::string text = bytes->text(0, static_cast<std::size_t>(bytes->size()));
    std::uint64_t last = 1;
    require_text(text, last, faults_);
    const auto take_operator = [this](const Row& row, std::uint64_t line) {
      if (!row[0].empty()) add_operator(row[0], line);
    };
    // The names that begin with _symmetry are those of before 1998.
    read_cif(text,
             {{"_atom_site_",
               {"label", "type_symbol", "fract_x", "fract_y", "fract_z", "occupancy", "calc_flag", "disorder_assembly",
                "disorder_group"},
               [this](const Row& row, std::uint64_t line) { add_site(row, line); }},
              {"_cell_",
               {"length_a", "length_b", "length_c", "angle_alpha", "angle_beta", "angle_gamma"},
               [this](const Row& row, std::uint64_t line) { set_cell(row, line); }},
              {"_space_group_symop_", {"operation_xyz"}, take_operator},
              {"_symmetry_equiv_pos_", {"as_xyz"}, take_operator},
              {"_",
               {"space_group_name_hall", "symmetry_space_group_name_hall", "space_group_name_h-m_alt",
                "symmetry_space_group_name_h-m", "space_group_name_h-m_ref", "space_group_name_h-m_full",
                "space_group_it_number", "symmetry_int_tables_number"},
               [this](const Row& row, std::uint64_t line) {
                 block_.group_names = row;
                 block_.group_line = line;
               }},
              {"_chemical_name_",
               {"mineral", "common", "systematic"},
               [this](const Row& row, std::uint64_t) { block_.title = first_value(row, 0); }}},
             faults_, [this] { finish_block(); });
    finish_block();
    faults_.raise_if_any();
    if (blocks_.empty()) faults_.fail(0, "no atoms: the table _atom_site_ is missing, or has no coordinates");
  }

  int frame_count() override { return static_cast<int>(blocks_.size()); }

  FrameInfo describe(int frame) override {
    load(frame);
    const Crystal& block = blocks_[static_cast<std::size_t>(frame)];
    FrameInfo info;
    info.rows = atoms_.rows;
    for (const Column& column : atoms_.columns) info.columns.push_back({column.name, column.type()});
    info.roles.position = {"x", "y", "z"};
    info.roles.element = "element";
    info.box = block.box;
    info.is_unit_cell = true;
    info.title = block.title;
    info.warnings = block.warnings;
    return info;
  }

  Table read(int frame, const std::vector<std::string>& columns) override {
    load(frame);
    return copied_columns(atoms_, columns);
  }

  std::uint64_t memory() const override { return atoms_.rows * kBytesPerAtom; }

 private:
  static constexpr std::uint64_t kBytesPerAtom = 6 * sizeof(double) + 4 * sizeof(std::uint32_t);

  void set_cell(const Row& row, std::uint64_t line) {
    for (std::size_t i = 0; i < 6; ++i) {
      constexpr double kRightAngle = 90;  // the default in the dictionary
      block_.cell[i] = row[i].empty() && i >= 3 ? kRightAngle : gemmi::cif::as_number(row[i]);
    }
    block_.cell_line = line;
  }

  void add_operator(const std::string& text, std::uint64_t line) {
    constexpr std::size_t kMaxOperators = 192;  // of Fm-3m
    const std::optional<Transform> op = operator_of(text);
    if (!op) faults_.fail(line, fmt::format("`{}` is not a symmetry operator such as x, y+1/2, -z", text));
    if (block_.operators.size() == kMaxOperators)
      faults_.fail(line, fmt::format("more than {} symmetry operators", kMaxOperators));
    block_.operators.push_back(*op);
  }

  void add_site(const Row& row, std::uint64_t line) {
    double at[3];
    bool is_atom = row[6] != "dum";
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string& text = row[2 + i];
      at[i] = gemmi::cif::as_number(text);
      is_atom = is_atom && !text.empty();
      if (!text.empty() && !std::isfinite(at[i]))
        faults_.add_of_many(line, quoted_word(text) + " is not a fractional coordinate");
    }
    if (!is_atom) return void(++block_.dummies);
    CrystalSite site{{at[0], at[1], at[2]}, gemmi::cif::as_number(row[5], 1), {}, row[0], {}, row[7]};
    site.element = element_in(row[1].empty() ? row[0] : row[1]);
    if (!row[8].empty()) site.alternative = row[7] + ' ' + row[8];
    block_.sites.push_back(std::move(site));
  }

  void finish_block() {
    Crystal block = std::exchange(block_, {});
    if (block.sites.empty()) return;
    const std::optional<Box> box = cell_box(block.cell);
    if (!box)
      faults_.fail(block.cell_line, "the unit cell has no volume: its lengths and angles are missing or wrong",
                   "_cell_length_a, _b, _c and _cell_angle_alpha, _beta, _gamma define it");
    block.box = *box;
    if (block.operators.empty()) find_group(block);
    keep_largest_parts(block);
    if (block.dummies > 0)
      block.warnings.push_back(base::counted(block.dummies, "site") + " left out: dummy atoms, or without coordinates");
    blocks_.push_back(std::move(block));
  }

  void find_group(Crystal& block) {
    constexpr std::size_t kGroup = 2;
    std::optional<Operators> found;
    for (std::size_t i = 0; i < block.group_names.size() && !found; ++i)
      if (const std::string& name = block.group_names[i]; !name.empty())
        found = i < kGroup ? operators_of_hall(name) : operators_of_group(name, block.cell);
    const std::string name = first_value(block.group_names, 0);
    if (!found && !name.empty())
      faults_.fail(block.group_line, fmt::format("the space group {} is unknown", quoted_word(name)),
                   "list its operators: loop_ _space_group_symop_operation_xyz 'x,y,z' ...");
    if (!found)
      block.warnings.emplace_back("the file has no symmetry; its atoms are taken for those of the whole cell");
    block.operators = found.value_or(Operators{{}});
  }

  /// Leaves out what would overlap: of the alternatives of disordered atoms, and of elements that share a site, those
  /// with the highest occupancy are kept, of equal ones the first.
  static void keep_largest_parts(Crystal& block) {
    std::map<std::string, const CrystalSite*> largest;  // by assembly
    std::map<std::array<long, 3>, const CrystalSite*> at;
    const auto key = [](Vec3d p) {
      constexpr double kUnit = 1e-3;  // sites that elements share have the same coordinates in the file
      const auto rounded = [](double x) { return std::lround((x - std::floor(x)) / kUnit); };
      return std::array{rounded(p.x), rounded(p.y), rounded(p.z)};
    };
    const auto keep = [](const CrystalSite*& kept, const CrystalSite& site) {
      if (kept == nullptr || site.occupancy > kept->occupancy) kept = &site;
    };
    for (const CrystalSite& site : block.sites) {
      if (!site.alternative.empty()) keep(largest[site.assembly], site);
      if (site.occupancy < 1) keep(at[key(site.at)], site);
    }
    std::vector<CrystalSite> kept;
    for (const CrystalSite& site : block.sites)
      if ((site.alternative.empty() || largest[site.assembly]->alternative == site.alternative) &&
          (site.occupancy >= 1 || at[key(site.at)] == &site || !site.alternative.empty()))
        kept.push_back(site);
    if (const std::size_t out = block.sites.size() - kept.size(); out > 0)
      block.warnings.push_back(fmt::format("disorder: {} of lower occupancy left out", base::counted(out, "site")));
    block.sites = std::move(kept);
  }

  /// Expands the asymmetric unit of a block.
  void load(int frame) {
    if (frame == loaded_) return;
    loaded_ = -1;
    atoms_ = {};
    const Crystal& block = blocks_[static_cast<std::size_t>(frame)];
    require_parse_memory(file_, block.sites.size() * block.operators.size(), kBytesPerAtom, 0, limit_);
    std::array<std::vector<double>, std::size(kCoordinates)> positions;
    std::vector<float> occupancies;
    std::vector<std::int32_t> sites;
    WordColumn elements, names;
    const base::StopPoint stop;
    for (std::size_t i = 0; i < block.sites.size(); ++i) {
      stop.check();
      const CrystalSite& site = block.sites[i];
      for (const Vec3d image : images_in_cell(site.at, block.operators, block.box)) {
        const Vec3d p = point_in(block.box, image);
        const double values[] = {p.x, p.y, p.z, image.x, image.y, image.z};
        for (std::size_t k = 0; k < std::size(values); ++k) positions[k].push_back(values[k]);
        elements.add(site.element);
        names.add(site.name);
        occupancies.push_back(static_cast<float>(site.occupancy));
        sites.push_back(static_cast<std::int32_t>(i) + 1);
      }
    }
    atoms_.rows = sites.size();
    for (std::size_t k = 0; k < positions.size(); ++k)
      atoms_.columns.push_back({kCoordinates[k], std::move(positions[k])});
    atoms_.columns.push_back({"element", elements.take()});
    atoms_.columns.push_back({"name", names.take()});
    atoms_.columns.push_back({"occupancy", std::move(occupancies)});
    atoms_.columns.push_back({"site", std::move(sites)});
    loaded_ = frame;
  }

  std::filesystem::path file_;
  Faults faults_;
  std::uint64_t limit_;  ///< see OpenOptions
  Crystal block_;        ///< that is being read
  std::vector<Crystal> blocks_;
  int loaded_ = -1;  ///< block in `atoms_`
  Table atoms_;
};

}  // namespace

std::unique_ptr<DataFile> open_small_cif(const Bytes& bytes, const OpenOptions& options) {
  return std::make_unique<SmallCif>(bytes, options);
}

}  // namespace orrery::data
