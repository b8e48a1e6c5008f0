// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <optional>
#include <type_traits>
#include <utility>

#include <fmt/core.h>

#include "arrays/readers.h"
#include "arrays/vtk_document.h"
#include "data/byte_source.h"

#include "data/customary.h"
#include "data/faults.h"
#include "data/quoted_word.h"
#include "data/records.h"
#include "data/single_frame.h"

// Reference  vtk-formats
namespace orrery::arrays {

using namespace data;  // NOLINT(google-build-using-namespace)

namespace {

/// An array of all pieces: the points, or data of them.
struct VtkArray {
  std::string name;
  NumberType type = NumberType::kFloat32;
  std::uint64_t components = 1;
  std::vector<pugi::xml_node> pieces;  ///< its DataArray in each piece
};

struct VtkColumn {
  std::string name;
  std::size_t array = 0;
  std::uint64_t component = 0;
};

std::optional<NumberType> vtk_number_type(std::string_view name) {
  struct Name {
    std::string_view name;
    NumberType type;
  };
  static constexpr Name kNames[] = {{"Int8", NumberType::kInt8},       {"UInt8", NumberType::kUint8},
                                    {"Int16", NumberType::kInt16},     {"UInt16", NumberType::kUint16},
                                    {"Int32", NumberType::kInt32},     {"UInt32", NumberType::kUint32},
                                    {"Int64", NumberType::kInt64},     {"UInt64", NumberType::kUint64},
                                    {"Float32", NumberType::kFloat32}, {"Float64", NumberType::kFloat64}};
  for (const Name& known : kNames)
    if (known.name == name) return known.type;
  return std::nullopt;
}

class VtkFile final : public SingleFrame {
 public:
  VtkFile(const Bytes& bytes, std::uint64_t limit) : SingleFrame(data::Format::kVtk, bytes), document_(bytes, limit) {
    for (const pugi::xml_node piece : document_.data().children("Piece")) add_piece(piece);
    if (pieces_.empty()) describe_no_points();
    for (std::size_t i = 0; i < arrays_.size(); ++i) add_columns(i);
    Faults faults(bytes->file());
    info_.roles = required_roles(info_.columns, faults);
  }

  /// One array is decoded at a time.
  std::uint64_t memory() const override {
    std::uint64_t largest = 0;
    for (const VtkArray& array : arrays_) largest = std::max(largest, array.components * size_of(array.type));
    return SingleFrame::memory() + document_.memory() + largest * info_.rows;
  }

  Table read(int, const std::vector<std::string>& names) override {
    Table table;
    table.rows = static_cast<std::size_t>(info_.rows);
    for (const std::string& name : names) {
      const auto info =
          std::find_if(info_.columns.begin(), info_.columns.end(), [&](const ColumnInfo& c) { return c.name == name; });
      table.columns.push_back({name, empty_values(info->type)});
    }
    Faults faults(bytes_->file());
    for (std::size_t a = 0; a < arrays_.size(); ++a) {
      std::vector<RecordField> fields;
      std::vector<std::size_t> targets;
      for (std::size_t i = 0; i < names.size(); ++i)
        for (const VtkColumn& column : columns_)
          if (column.array == a && column.name == names[i]) {
            fields.push_back({column.name, arrays_[a].type, column.component * size_of(arrays_[a].type)});
            targets.push_back(i);
          }
      for (std::size_t piece = 0; piece < pieces_.size() && !fields.empty(); ++piece)
        append(arrays_[a], piece, fields, targets, table, faults);
    }
    faults.raise_if_any();
    return table;
  }

 private:
  /// A file of particles may be empty.
  void describe_no_points() {
    if (!document_.data().child("Piece")) document_.fail("there is no <Piece>");
    for (const char* name : {"x", "y", "z"}) info_.columns.push_back({name, ColumnType::kFloat32});
  }

  void add_piece(pugi::xml_node piece) {
    const std::uint64_t rows = document_.integer(piece, "NumberOfPoints");
    if (rows == 0) return;
    // Compressed or not, a byte holds no more points than that.
    constexpr std::uint64_t kMaxPerByte = 1000;
    if (rows / kMaxPerByte > bytes_->size() || info_.rows / kMaxPerByte > bytes_->size())
      document_.fail(fmt::format("a piece declares {} points, more than the file can contain", rows));
    info_.rows += rows;
    pieces_.push_back(rows);
    add_array(piece.child("Points").child("DataArray"), "Points");
    for (const pugi::xml_node node : piece.child("PointData").children("DataArray"))
      add_array(node, vtk_attribute(node, "Name", "unnamed"));
    for (const VtkArray& array : arrays_)
      if (array.pieces.size() != pieces_.size())
        document_.fail("not all pieces have one array " + quoted_word(array.name));
  }

  void add_array(pugi::xml_node node, const std::string& name) {
    const std::string type = vtk_attribute(node, "type");
    const std::uint64_t components = document_.integer(node, "NumberOfComponents", "1");
    if (!node) document_.fail("a piece has no <Points>");
    if (type == "String" || components == 0) return;
    if (!vtk_number_type(type))
      document_.fail(fmt::format("array {} has the unknown type {}", quoted_word(name), quoted_word(type)));
    auto array = std::find_if(arrays_.begin(), arrays_.end(), [&](const VtkArray& a) { return a.name == name; });
    if (array == arrays_.end()) {
      if (arrays_.size() == kMaxColumns) document_.fail(fmt::format("there are more than {} arrays", kMaxColumns));
      arrays_.push_back({name, *vtk_number_type(type), components, {}});
      array = arrays_.end() - 1;
    }
    if (array->type != *vtk_number_type(type) || array->components != components)
      document_.fail(fmt::format("the pieces have arrays {} of different types or sizes", quoted_word(name)));
    array->pieces.push_back(node);
  }

  void add_columns(std::size_t index) {
    const VtkArray& array = arrays_[index];
    if (info_.columns.size() + array.components > kMaxColumns || array.components > kMaxColumns)
      document_.fail(fmt::format("there are more than {} columns", kMaxColumns));
    const auto names = component_names(array.name, static_cast<std::size_t>(array.components), info_.columns);
    for (std::size_t i = 0; i < names.size(); ++i) {
      const std::string name = names_.add(names[i]);
      columns_.push_back({name, index, i});
      info_.columns.push_back({name, column_type(array.type)});
    }
  }

  /// Appends a piece of an array to columns of a table.
  void append(const VtkArray& array, std::size_t piece, const std::vector<RecordField>& fields,
              const std::vector<std::size_t>& targets, Table& table, Faults& faults) const {
    const VtkBytes found = document_.array(array.pieces[piece], array.name, array.type);
    RecordLayout layout{found.begin, array.components * size_of(array.type), pieces_[piece]};
    if (found.size % layout.stride != 0 || found.size / layout.stride != layout.rows)
      faults.fail(0, fmt::format("array {} has {} bytes; {} points need {} each", quoted_word(array.name), found.size,
                                 layout.rows, layout.stride));
    std::vector<RecordField> in_order = fields;
    for (RecordField& field : in_order) field.is_big_endian = found.is_big_endian;
    std::vector<Values> values = read_records(*found.source, layout, in_order, faults);
    for (std::size_t i = 0; i < targets.size(); ++i)
      std::visit(
          [&](auto& column) {
            if constexpr (requires { column.resize(1); }) {
              auto& read = std::get<std::decay_t<decltype(column)>>(values[i]);
              if (column.empty()) {
                column = std::move(read);
              } else {
                const std::size_t before = column.size();
                column.resize(before + read.size());
                std::copy(read.begin(), read.end(), column.begin() + static_cast<std::ptrdiff_t>(before));
              }
            }
          },
          table.columns[targets[i]].values);
  }

  VtkDocument document_;
  std::vector<std::uint64_t> pieces_;  ///< number of points of each
  std::vector<VtkArray> arrays_;
  UniqueNames names_;
  std::vector<VtkColumn> columns_;
};

constexpr std::string_view kLegacy = "# vtk DataFile";

}  // namespace

bool is_vtk(const Signature& signature) {
  const std::string& head = signature.head;
  return head.starts_with(kLegacy) || (head.find_first_not_of(" \t\r\n\xEF\xBB\xBF") == head.find('<') &&
                                       head.find("<VTKFile") != std::string::npos);
}

std::unique_ptr<DataFile> open_vtk(const Bytes& bytes, const OpenOptions& options) {
  if (bytes->text(0, kLegacy.size()) == kLegacy)
    Faults(bytes->file())
        .fail(0, "the legacy format of VTK is not supported", "save the points as a .vtp file with ParaView");
  return std::make_unique<VtkFile>(bytes, options.decompressed_limit);
}

}  // namespace orrery::arrays
