// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <optional>
#include <pugixml.hpp>
#include <utility>

#include "data/customary.h"
#include "data/quoted_word.h"
#include "data/readers.h"
#include "data/records.h"
#include "data/single_frame.h"
#include "data/vtk_bytes.h"

// Reference  vtk-formats
namespace orrery::data {
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

std::optional<NumberType> type_of(std::string_view name) {
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

std::string attribute(pugi::xml_node node, const char* name, const char* standard = "") {
  return node.attribute(name).as_string(standard);
}

/// Returns the offset of a text in a file, from an offset; the size of the file if it does not occur.
std::uint64_t find(const ByteSource& bytes, std::string_view text, std::uint64_t from) {
  constexpr std::size_t kBlockBytes = std::size_t{1} << 20;
  for (std::uint64_t at = from; at < bytes.size(); at += kBlockBytes) {
    const std::size_t found = bytes.text(at, kBlockBytes + text.size() - 1).find(text);
    if (found != std::string::npos) return at + found;
  }
  return bytes.size();
}

class VtkFile final : public SingleFrame {
 public:
  VtkFile(const Bytes& bytes, std::uint64_t limit) : SingleFrame(data::Format::kVtk, bytes), faults_(bytes->file()) {
    storage_.limit = limit;
    parse();
    check_root();
    const std::string type = attribute(root_, "type");
    for (const pugi::xml_node piece : root_.child(type.c_str()).children("Piece")) add_piece(piece);
    if (pieces_.empty()) describe_no_points();
    for (std::size_t i = 0; i < arrays_.size(); ++i) add_columns(i);
    info_.roles = required_roles(info_.columns, faults_);
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
  /// Parses the XML. Appended raw data are cut off: they are not XML.
  void parse() {
    constexpr std::string_view kTag = "<AppendedData";
    constexpr std::size_t kLongestTag = 1000;
    const std::uint64_t tag = find(*bytes_, kTag, 0);
    const std::string head = bytes_->text(tag, kLongestTag);
    const std::size_t tag_end = head.find('>');
    const bool is_raw = head.substr(0, tag_end).find("raw") != std::string::npos;
    if (is_raw) {
      const std::size_t underscore = head.find('_', tag_end);
      if (tag_end == std::string::npos || underscore == std::string::npos)
        faults_.fail(0, "<AppendedData> has no data that begin with an underscore");
      raw_begin_ = tag + underscore + 1;
      text_ = bytes_->text(0, static_cast<std::size_t>(tag)) + "</VTKFile>";
    } else {
      text_ = bytes_->text(0, static_cast<std::size_t>(bytes_->size()));
    }
    const pugi::xml_parse_result result =
        document_.load_buffer_inplace(text_.data(), text_.size(), pugi::parse_minimal | pugi::parse_escapes);
    if (!result) {
      const std::string before = bytes_->text(0, static_cast<std::size_t>(result.offset));
      faults_.fail(static_cast<std::uint64_t>(std::count(before.begin(), before.end(), '\n')) + 1,
                   std::string("malformed XML: ") + result.description());
    }
    root_ = document_.child("VTKFile");
    base64_ = root_.child("AppendedData").child_value();
    base64_.remove_prefix(std::min(base64_.find('_') + 1, base64_.size()));
  }

  void check_root() {
    const std::string type = attribute(root_, "type"), order = attribute(root_, "byte_order", "LittleEndian"),
                      header = attribute(root_, "header_type", "UInt32"), compressor = attribute(root_, "compressor");
    if (type == "PPolyData" || type == "PUnstructuredGrid")
      faults_.fail(0, "the file only names the files of its pieces", "use these, or save one .vtp file with ParaView");
    if (type != "PolyData" && type != "UnstructuredGrid")
      faults_.fail(0, "VTK data of the type " + quoted_word(type) + "; supported are PolyData and UnstructuredGrid",
                   "save the points as a .vtp file with ParaView");
    if (order != "LittleEndian" && order != "BigEndian") faults_.fail(0, "unknown byte order " + quoted_word(order));
    if (header != "UInt32" && header != "UInt64") faults_.fail(0, "unknown header type " + quoted_word(header));
    if (!compressor.empty() && compressor != "vtkZLibDataCompressor")
      faults_.fail(0, "the compression " + quoted_word(compressor) + " is not supported",
                   "save the file with zlib compression, or without");
    storage_.is_big_endian = order == "BigEndian";
    storage_.has_long_headers = header == "UInt64";
    storage_.is_compressed = !compressor.empty();
  }

  /// A file of particles may be empty.
  void describe_no_points() {
    if (!root_.child(attribute(root_, "type").c_str()).child("Piece")) faults_.fail(0, "there is no <Piece>");
    for (const char* name : {"x", "y", "z"}) info_.columns.push_back({name, ColumnType::kFloat32});
  }

  std::uint64_t integer(pugi::xml_node node, const char* name, const char* standard) {
    const std::string text = attribute(node, name, standard);
    std::uint64_t out = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
    if (error != std::errc() || end != text.data() + text.size())
      faults_.fail(0, std::string(name) + " is " + quoted_word(text) + ", not a non-negative integer");
    return out;
  }

  void add_piece(pugi::xml_node piece) {
    const std::uint64_t rows = integer(piece, "NumberOfPoints", "");
    if (rows == 0) return;
    // Compressed or not, a byte holds no more points than that.
    constexpr std::uint64_t kMostPerByte = 1000;
    if (rows / kMostPerByte > bytes_->size() || info_.rows / kMostPerByte > bytes_->size())
      faults_.fail(0, "a piece declares " + std::to_string(rows) + " points, more than the file can contain");
    info_.rows += rows;
    pieces_.push_back(rows);
    add_array(piece.child("Points").child("DataArray"), "Points");
    for (const pugi::xml_node node : piece.child("PointData").children("DataArray"))
      add_array(node, attribute(node, "Name", "unnamed"));
    for (const VtkArray& array : arrays_)
      if (array.pieces.size() != pieces_.size())
        faults_.fail(0, "not all pieces have one array " + quoted_word(array.name));
  }

  void add_array(pugi::xml_node node, const std::string& name) {
    const std::string type = attribute(node, "type");
    const std::uint64_t components = integer(node, "NumberOfComponents", "1");
    if (!node) faults_.fail(0, "a piece has no <Points>");
    if (type == "String" || components == 0) return;
    if (!type_of(type)) faults_.fail(0, "array " + quoted_word(name) + " has the unknown type " + quoted_word(type));
    auto array = std::find_if(arrays_.begin(), arrays_.end(), [&](const VtkArray& a) { return a.name == name; });
    if (array == arrays_.end()) {
      arrays_.push_back({name, *type_of(type), components, {}});
      array = arrays_.end() - 1;
    }
    if (array->type != *type_of(type) || array->components != components)
      faults_.fail(0, "the pieces have arrays " + quoted_word(name) + " of different types or sizes");
    array->pieces.push_back(node);
  }

  void add_columns(std::size_t index) {
    const VtkArray& array = arrays_[index];
    if (info_.columns.size() + array.components > kMostColumns || array.components > kMostColumns)
      faults_.fail(0, "there are more than " + std::to_string(kMostColumns) + " columns");
    const auto names = component_names(array.name, static_cast<std::size_t>(array.components), info_.columns);
    for (std::size_t i = 0; i < names.size(); ++i) {
      const std::string name = unique_name(names[i], info_.columns);
      columns_.push_back({name, index, i});
      info_.columns.push_back({name, column_type(array.type)});
    }
  }

  /// Appends a piece of an array to columns of a table.
  void append(const VtkArray& array, std::size_t piece, const std::vector<RecordField>& fields,
              const std::vector<std::size_t>& targets, Table& table, Faults& faults) {
    const VtkBytes found = array_bytes(array, array.pieces[piece], faults);
    RecordLayout layout{found.begin, array.components * size_of(array.type), pieces_[piece]};
    if (found.size % layout.stride != 0 || found.size / layout.stride != layout.rows)
      faults.fail(0, "array " + quoted_word(array.name) + " has " + std::to_string(found.size) + " bytes; " +
                         std::to_string(layout.rows) + " points need " + std::to_string(layout.stride) + " each");
    std::vector<RecordField> in_order = fields;
    for (RecordField& field : in_order) field.is_big_endian = found.is_big_endian;
    std::vector<Values> values = read_records(*found.source, layout, in_order, faults);
    for (std::size_t i = 0; i < targets.size(); ++i)
      std::visit(
          [&](auto& column) {
            if constexpr (requires { column.insert(column.end(), column.begin(), column.end()); }) {
              auto& read = std::get<std::decay_t<decltype(column)>>(values[i]);
              if (column.empty()) {
                column = std::move(read);
              } else {
                column.insert(column.end(), read.begin(), read.end());
              }
            }
          },
          table.columns[targets[i]].values);
  }

  VtkBytes array_bytes(const VtkArray& array, pugi::xml_node node, Faults& faults) {
    const std::string format = attribute(node, "format", "ascii");
    VtkBytes out;
    std::string fault;
    if (format == "ascii") {
      fault = parse_vtk_ascii(bytes_->file(), node.child_value(), array.type, out);
    } else if (format == "binary") {
      fault = decode_vtk_base64(bytes_->file(), node.child_value(), storage_, out);
    } else if (format == "appended") {
      const std::uint64_t offset = integer(node, "offset", "");
      if (raw_begin_ > 0) {
        fault =
            offset > bytes_->size() ? "its offset is wrong" : find_vtk_raw(bytes_, raw_begin_ + offset, storage_, out);
      } else {
        fault = offset > base64_.size() ? "its offset is wrong"
                                        : decode_vtk_base64(bytes_->file(), base64_.substr(offset), storage_, out);
      }
    } else {
      fault = "unknown format " + quoted_word(format);
    }
    if (!fault.empty()) faults.fail(0, "array " + quoted_word(array.name) + ": " + fault);
    return out;
  }

  Faults faults_;
  std::string text_;  ///< the XML, which document_ refers to
  pugi::xml_document document_;
  pugi::xml_node root_;
  std::uint64_t raw_begin_ = 0;  ///< offset of appended raw data; 0: there are none
  std::string_view base64_;      ///< appended data in base64
  VtkStorage storage_;
  std::vector<std::uint64_t> pieces_;  ///< number of points of each
  std::vector<VtkArray> arrays_;
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

}  // namespace orrery::data
