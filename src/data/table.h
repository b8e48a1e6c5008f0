// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "math/vec3.h"

/// Particle data files as tables of named columns. Readers leave all choices to the scene: they guess no radii, and
/// filter and colour nothing.
namespace orrery::data {

using math::Vec3d;

/// Returns the first of some items with a name; null if there is none.
template <class Item>
const Item* find_named(const std::vector<Item>& items, std::string_view name) {
  for (const Item& item : items)
    if (item.name == name) return &item;
  return nullptr;
}

/// A text column. Each distinct string is stored once.
struct Words {
  std::vector<std::string> words;    ///< distinct, in order of first appearance
  std::vector<std::uint32_t> index;  ///< one per row, into `words`
};

/// Returns a text column whose rows have the strings with these indices. Other strings are dropped, and the order of
/// first appearance is restored.
inline Words words_at(const std::vector<std::string>& words, const std::vector<std::uint32_t>& index) {
  constexpr auto kUnused = static_cast<std::uint32_t>(-1);
  std::vector<std::uint32_t> renumbered(words.size(), kUnused);
  Words out;
  out.index.reserve(index.size());
  for (const std::uint32_t old : index) {
    if (renumbered[old] == kUnused) {
      renumbered[old] = static_cast<std::uint32_t>(out.words.size());
      out.words.push_back(words[old]);
    }
    out.index.push_back(renumbered[old]);
  }
  return out;
}

/// A column that views an array in memory. The caller owns the array and keeps it alive.
template <class T>
class ArrayView {
 public:
  /// A view of `size` values of a numeric array.
  ///
  /// `first`    address of the first value; need not be aligned
  /// `stride`   bytes from one value to the next; may be negative or 0
  ArrayView(const void* first, std::ptrdiff_t stride, std::size_t size)
      : first_(static_cast<const char*>(first)), stride_(stride), size_(size) {}

  std::size_t size() const { return size_; }
  T operator[](std::size_t row) const {
    T value;
    std::memcpy(&value, first_ + static_cast<std::ptrdiff_t>(row) * stride_, sizeof(T));
    return value;
  }

 private:
  const char* first_;
  std::ptrdiff_t stride_;
  std::size_t size_;
};

/// The values of a column, one per row, in the type in which the file stores them. Numbers of text files are float64,
/// or int64 if the format declares the column an integer. Tables in memory and kept ones have views.
using Values = std::variant<std::vector<double>, std::vector<float>, std::vector<std::int64_t>,
                            std::vector<std::int32_t>, std::vector<std::uint16_t>, std::vector<std::uint8_t>, Words,
                            ArrayView<double>, ArrayView<float>, ArrayView<std::int64_t>>;

/// The alternatives of Values, in order up to Words.
enum class ColumnType { kFloat64, kFloat32, kInt64, kInt32, kUint16, kUint8, kText };

/// "float64", "int32", "text"
constexpr const char* type_name(ColumnType type) {
  constexpr const char* kNames[] = {"float64", "float32", "int64", "int32", "uint16", "uint8", "text"};
  return kNames[static_cast<std::size_t>(type)];
}

/// Size of a value in a table, bytes; for a string, that of its index.
constexpr std::uint64_t bytes_per_value(ColumnType type) {
  constexpr std::uint64_t kBytes[] = {8, 4, 8, 4, 2, 1, 4};
  return kBytes[static_cast<std::size_t>(type)];
}

struct ColumnInfo {
  std::string name;
  ColumnType type = ColumnType::kFloat64;
  bool is_derived = false;  ///< not in the file, but computed from other columns by the room `points`
};

struct Column {
  std::string name;
  Values values;

  ColumnType type() const {
    if (std::holds_alternative<ArrayView<double>>(values)) return ColumnType::kFloat64;
    if (std::holds_alternative<ArrayView<float>>(values)) return ColumnType::kFloat32;
    if (std::holds_alternative<ArrayView<std::int64_t>>(values)) return ColumnType::kInt64;
    return static_cast<ColumnType>(values.index());
  }
  std::size_t size() const {
    return std::visit(
        [](const auto& v) {
          if constexpr (requires { v.index; })
            return v.index.size();
          else
            return v.size();
        },
        values);
  }
  /// The value of a row as a number; NaN in a text column.
  double number(std::size_t row) const {
    return std::visit(
        [row](const auto& v) {
          if constexpr (requires { v.index; })
            return std::numeric_limits<double>::quiet_NaN();
          else
            return static_cast<double>(v[row]);
        },
        values);
  }
};

/// Names of the columns whose meaning is known from the format or from customary names; empty: no such column.
struct Roles {
  std::array<std::string, 3> position;  ///< x, y, z, in the file's unit of length; always set
  std::string radius;                   ///< radius, or diameter
  double radius_scale = 1;              ///< 0.5 if `radius` is a diameter
  std::string element;                  ///< text: chemical symbol
  std::string type;                     ///< particle type or class, a number or a string
  std::string id;                       ///< identifies a particle in all frames
  std::string chain;                    ///< text: chain name, for assemblies
  std::array<std::string, 3> rgb;       ///< red, green, blue, display-referred sRGB
  double rgb_maximum = 255;             ///< value that means full intensity
  std::array<std::string, 3> image;     ///< periodic image flags, for unwrapping
};

/// A simulation box: a parallelepiped.
struct Box {
  Vec3d origin{0, 0, 0};
  std::array<Vec3d, 3> edges = {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}};  ///< a, b, c
  std::array<bool, 3> periodic = {true, true, true};
};

/// Copies of some chains: p -> rotation p + translation.
struct Transform {
  std::array<Vec3d, 3> rows = {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}};
  Vec3d translation{0, 0, 0};
};
struct AssemblyPart {
  std::vector<std::string> chains;  ///< empty: all
  std::vector<Transform> transforms;
};

/// A biological assembly: the file's atoms, copied.
struct Assembly {
  std::string name;  ///< "1"
  std::vector<AssemblyPart> parts;
};

/// A bond between two rows of a table: a < b.
struct Bond {
  std::uint32_t a = 0, b = 0;

  auto operator<=>(const Bond&) const = default;
};

/// What a frame contains, known without reading its rows.
struct FrameInfo {
  std::uint64_t rows = 0;
  std::vector<ColumnInfo> columns;
  Roles roles;
  std::optional<Box> box;
  std::vector<Assembly> assemblies;
  std::optional<double> step;                          ///< time step, or the frame number in the file
  std::vector<std::pair<std::string, double>> header;  ///< other numbers of the frame, such as `energy`
  std::string title;                                   ///< comment or title of the file; may be empty
  bool z_up = true;                                    ///< convention of the format
  bool has_components = false;   ///< OpenOptions::component selects one of several sets of particles
  bool is_unit_cell = false;     ///< the atoms are those of a crystal's unit cell, and the box is this cell
  bool may_be_of_scene = false;  ///< the file may have been made for a scene: a column may number its materials
  bool may_be_hollow = false;    ///< a radius below 0 is a hollow sphere, as in a scene
  std::uint64_t bonds = 0;       ///< estimated number of bonds in the frame
  bool has_bonds = false;        ///< a frame of the file has bonds; those of this one may all have broken
  /// False if the format leaves out bonds that its readers know, such as those within the residues of a protein.
  bool lists_all_bonds = true;
  std::vector<std::string> warnings;  ///< about what the reader had to assume
  /// Name that the column `roles.element` has if its words turn out to be types, see settled(); empty: the format says
  /// that they are elements.
  std::string names_as_types;
};

/// Columns of a frame. Rows are in file order.
struct Table {
  std::size_t rows = 0;
  std::vector<Column> columns;

  /// Returns a column; null if there is none.
  const Column* find(std::string_view name) const { return find_named(columns, name); }
  Column* find(std::string_view name) { return const_cast<Column*>(std::as_const(*this).find(name)); }
};

}  // namespace orrery::data
