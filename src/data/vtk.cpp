// SPDX-License-Identifier: Apache-2.0
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <new>
#include <optional>
#include <pugixml.hpp>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "base/text.h"
#include "data/frames.h"
#include "data/readers.h"
#include "data/records.h"

// Reference  vtk-formats
namespace orrery::data {

namespace {

/// How the binary arrays of a VTK file are stored.
struct VtkStorage {
  bool is_big_endian = false;
  bool has_long_headers = false;  ///< header_type is UInt64
  bool is_compressed = false;     ///< with zlib, in blocks
  std::uint64_t limit = 0;        ///< maximum size of the decompressed data of an array, bytes
};

/// The numbers of an array: a range of a file or of memory.
struct VtkBytes {
  Bytes source;
  std::uint64_t begin = 0;
  std::uint64_t size = 0;
  bool is_big_endian = false;
};

/// What is wrong with an array; VtkDocument::array() adds its name.
struct VtkFault {
  std::string text;
};

[[noreturn]] void fail_as_truncated() { throw VtkFault{"the data end too early"}; }

/// Bytes that are read from the front.
class Stream {
 public:
  virtual ~Stream() = default;
  /// Appends exactly `count` bytes.
  ///
  /// Errors     VtkFault if there are fewer
  virtual void take(std::uint64_t count, std::vector<char>& out) = 0;
};

class RawStream final : public Stream {
 public:
  RawStream(const ByteSource& source, std::uint64_t at) : source_(source), at_(std::min(at, source.size())) {}

  void take(std::uint64_t count, std::vector<char>& out) override {
    if (count > source_.size() - at_) fail_as_truncated();
    const std::size_t begin = out.size();
    out.resize(begin + static_cast<std::size_t>(count));
    source_.read(at_, static_cast<std::size_t>(count), out.data() + begin);
    at_ += count;
  }
  std::uint64_t at() const { return at_; }

 private:
  const ByteSource& source_;
  std::uint64_t at_;
};

/// Value of a base64 digit; -1: none.
constexpr int base64_value(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

/// Decodes base64 in groups of four digits. A group may be padded anywhere: VTK encodes header and data separately.
class Base64Stream final : public Stream {
 public:
  explicit Base64Stream(std::string_view text) : text_(text) {}

  void take(std::uint64_t count, std::vector<char>& out) override {
    for (;;) {
      const auto some = static_cast<std::size_t>(std::min<std::uint64_t>(count, decoded_ - used_));
      out.insert(out.end(), group_ + used_, group_ + used_ + some);
      used_ += some;
      count -= some;
      if (count == 0) return;
      decode_group();
    }
  }

 private:
  void decode_group() {
    std::uint32_t bits = 0;
    std::size_t digits = 0, padding = 0;
    while (digits + padding < 4) {
      at_ = std::min(text_.find_first_not_of(" \n\r\t", at_), text_.size());
      if (at_ == text_.size()) fail_as_truncated();
      const char c = text_[at_++];
      const int value = base64_value(c);
      if (c == '=' && digits >= 2) {
        ++padding;
        bits <<= 6;
      } else if (value >= 0 && padding == 0) {
        ++digits;
        bits = bits << 6 | static_cast<std::uint32_t>(value);
      } else {
        fail_as_truncated();
      }
    }
    for (std::size_t i = 0; i < 3; ++i) group_[i] = static_cast<char>(bits >> (16 - 8 * i));
    decoded_ = digits - 1;
    used_ = 0;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  char group_[3] = {};
  std::size_t decoded_ = 0, used_ = 0;  ///< bytes of the group
};

/// Takes an integer of the array's header.
std::uint64_t take_length(Stream& stream, const VtkStorage& storage) {
  std::vector<char> bytes;
  stream.take(storage.has_long_headers ? 8 : 4, bytes);
  return storage.has_long_headers ? load<std::uint64_t>(bytes.data(), storage.is_big_endian)
                                  : load<std::uint32_t>(bytes.data(), storage.is_big_endian);
}

/// Appends a zlib stream of `bytes` decompressed bytes; false if it is damaged.
bool append_inflated(const std::vector<char>& compressed, std::uint64_t bytes, ByteBlocks& out) {
  if (compressed.size() > std::numeric_limits<uInt>::max()) return false;
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) throw std::bad_alloc();
  stream.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(compressed.data()));
  stream.avail_in = static_cast<uInt>(compressed.size());
  int status = Z_OK;
  for (std::uint64_t left = bytes; status == Z_OK;) {
    // One byte more than there should be shows that there are too many.
    const std::span<char> room = out.room(left + 1);
    stream.next_out = reinterpret_cast<Bytef*>(room.data());
    stream.avail_out = static_cast<uInt>(room.size());
    status = inflate(&stream, Z_NO_FLUSH);
    const std::size_t got = room.size() - stream.avail_out;
    if (got > left) break;
    out.append(got);
    left -= got;
    if (status == Z_STREAM_END && left > 0) status = Z_DATA_ERROR;
  }
  inflateEnd(&stream);
  return status == Z_STREAM_END;
}

/// Decompresses an array: number of blocks, size of a block, size of the last one if it is smaller, compressed sizes,
/// blocks.
ByteBlocks decompressed_array(Stream& stream, const VtkStorage& storage) {
  /// Maximum expansion of a zlib stream.
  constexpr std::uint64_t kMaxExpansion = 1040;
  const VtkFault bad_header{"the header of the compressed data is wrong"};
  const std::uint64_t blocks = take_length(stream, storage), block_bytes = take_length(stream, storage);
  std::uint64_t last_bytes = take_length(stream, storage);
  if (last_bytes == 0) last_bytes = block_bytes;
  if (last_bytes > block_bytes) throw bad_header;
  std::vector<std::uint64_t> sizes;
  for (std::uint64_t i = 0; i < blocks; ++i) sizes.push_back(take_length(stream, storage));
  ByteBlocks out;
  std::vector<char> compressed;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const std::uint64_t bytes = i + 1 < sizes.size() ? block_bytes : last_bytes;
    compressed.clear();
    stream.take(sizes[i], compressed);
    if (bytes > kMaxExpansion * (sizes[i] + 1)) throw bad_header;
    if (bytes > storage.limit - std::min<std::uint64_t>(storage.limit, out.size()))
      throw VtkFault{
          fmt::format("the array exceeds the limit of {} of decompressed data", base::bytes_text(storage.limit))};
    if (!append_inflated(compressed, bytes, out)) throw VtkFault{"the compressed data are damaged"};
  }
  return out;
}

VtkBytes in_memory(const std::filesystem::path& file, ByteBlocks bytes, bool is_big_endian) {
  const std::uint64_t size = bytes.size();
  return {ByteSource::of_memory(file, std::move(bytes)), 0, size, is_big_endian};
}

template <class T>
bool append_number(std::string_view word, ByteBlocks& out) {
  T value{};
  if constexpr (std::is_floating_point_v<T>) {
    double number = 0;
    if (!parse_number(word, number)) return false;
    value = static_cast<T>(number);
  } else {
    if (!base::from_text(word, value)) return false;
  }
  out.append(std::string_view(reinterpret_cast<const char*>(&value), sizeof(T)));
  return true;
}

/// Finds the raw array at an offset of a file, and decompresses it.
///
/// Errors     VtkFault
/// Cost       memory for the bytes that exist, regardless of the size that the array's header declares; none if it is
///            not compressed
VtkBytes raw_array(const Bytes& file, std::uint64_t offset, const VtkStorage& storage) {
  RawStream stream(*file, offset);
  if (storage.is_compressed) return in_memory(file->file(), decompressed_array(stream, storage), storage.is_big_endian);
  const std::uint64_t size = take_length(stream, storage);
  if (size > file->size() - stream.at()) fail_as_truncated();
  return {file, stream.at(), size, storage.is_big_endian};
}

/// Decodes an array in base64, and decompresses it. `file` is for messages.
///
/// Errors     VtkFault
VtkBytes base64_array(const std::filesystem::path& file, std::string_view text, const VtkStorage& storage) {
  Base64Stream stream(text);
  if (storage.is_compressed) return in_memory(file, decompressed_array(stream, storage), storage.is_big_endian);
  constexpr std::uint64_t kStep = std::uint64_t{1} << 20;
  ByteBlocks bytes;
  std::vector<char> some;
  for (std::uint64_t size = take_length(stream, storage); size > 0; size -= some.size()) {
    some.clear();
    stream.take(std::min(size, kStep), some);
    bytes.append({some.data(), some.size()});
  }
  return in_memory(file, std::move(bytes), storage.is_big_endian);
}

/// Parses numbers of a type, separated by white space.
///
/// Errors     VtkFault
VtkBytes ascii_array(const std::filesystem::path& file, std::string_view text, NumberType type) {
  constexpr std::string_view kBlanks = " \t\r\n";
  ByteBlocks bytes;
  for (std::size_t at = text.find_first_not_of(kBlanks); at != std::string_view::npos;
       at = text.find_first_not_of(kBlanks, at)) {
    const std::size_t end = std::min(text.find_first_of(kBlanks, at), text.size());
    const std::string_view word = text.substr(at, end - at);
    const bool is_number = with_type(type, [&](auto number) { return append_number<decltype(number)>(word, bytes); });
    if (!is_number) throw VtkFault{quoted_word(word) + " is not a number of its type"};
    at = end;
  }
  return in_memory(file, std::move(bytes), std::endian::native == std::endian::big);
}

/// Returns an attribute, or `standard` if it is missing.
std::string vtk_attribute(pugi::xml_node node, const char* name, const char* standard = "") {
  return node.attribute(name).as_string(standard);
}

/// Returns the offset of a string in a file; the size of the file if it does not occur.
std::uint64_t find(const ByteSource& bytes, std::string_view text) {
  constexpr std::size_t kBlockBytes = std::size_t{1} << 20;
  for (std::uint64_t at = 0; at < bytes.size(); at += kBlockBytes) {
    const std::size_t found = bytes.text(at, kBlockBytes + text.size() - 1).find(text);
    if (found != std::string::npos) return at + found;
  }
  return bytes.size();
}

/// The XML of a VTP or VTU file, and access to its arrays.
class VtkDocument {
 public:
  /// Parses the XML.
  ///
  /// `limit`    maximum size of the decompressed data of an array, bytes
  /// Errors     base::Error(kBadData) for malformed XML, and with a remedy for other types and compressions
  /// Cost       memory for the file, excluding appended raw data
  VtkDocument(Bytes bytes, std::uint64_t limit) : bytes_(std::move(bytes)) {
    storage_.limit = limit;
    parse();
    check_root();
  }

  /// Memory of the text.
  std::uint64_t memory() const { return text_.size(); }

  /// Returns <PolyData> or <UnstructuredGrid>.
  pugi::xml_node data() const { return root_.child(vtk_attribute(root_, "type").c_str()); }

  /// Locates the numbers of a <DataArray>, and decodes them if necessary. `name` is for messages.
  ///
  /// Errors     base::Error(kBadData)
  VtkBytes array(pugi::xml_node node, const std::string& name, NumberType type) const {
    const std::string format = vtk_attribute(node, "format", "ascii");
    try {
      if (format == "ascii") return ascii_array(bytes_->file(), node.child_value(), type);
      if (format == "binary") return base64_array(bytes_->file(), node.child_value(), storage_);
      if (format != "appended") throw VtkFault{"unknown format " + quoted_word(format)};
      const std::uint64_t offset = integer(node, "offset");
      if (offset > (raw_begin_ > 0 ? bytes_->size() : base64_.size())) throw VtkFault{"its offset is wrong"};
      return raw_begin_ > 0 ? raw_array(bytes_, raw_begin_ + offset, storage_)
                            : base64_array(bytes_->file(), base64_.substr(static_cast<std::size_t>(offset)), storage_);
    } catch (const VtkFault& fault) {
      fail(fmt::format("array {}: {}", quoted_word(name), fault.text));
    }
  }

  /// Returns an attribute that is a non-negative integer.
  ///
  /// `standard` text to use if the attribute is missing
  /// Errors     base::Error(kBadData)
  std::uint64_t integer(pugi::xml_node node, const char* name, const char* standard = "") const {
    const std::string text = vtk_attribute(node, name, standard);
    std::uint64_t out = 0;
    if (!base::from_text(text, out)) fail(fmt::format("{} is {}, not a non-negative integer", name, quoted_word(text)));
    return out;
  }

  [[noreturn]] void fail(const std::string& text, const std::string& remedy = {}) const {
    Faults(bytes_->file()).fail(0, text, remedy);
  }

 private:
  void parse() {
    constexpr std::string_view kTag = "<AppendedData";
    constexpr std::size_t kLongestTag = 1000;
    const std::uint64_t tag = find(*bytes_, kTag);
    const std::string head = bytes_->text(tag, kLongestTag);
    const std::size_t tag_end = head.find('>');
    // Raw data are cut off: they are not XML.
    if (head.substr(0, tag_end).find("raw") != std::string::npos) {
      const std::size_t underscore = head.find('_', tag_end);
      if (tag_end == std::string::npos || underscore == std::string::npos)
        fail("<AppendedData> has no data that begin with an underscore");
      raw_begin_ = tag + underscore + 1;
      text_ = bytes_->text(0, static_cast<std::size_t>(tag)) + "</VTKFile>";
    } else {
      text_ = bytes_->text(0, static_cast<std::size_t>(bytes_->size()));
    }
    const pugi::xml_parse_result result =
        document_.load_buffer_inplace(text_.data(), text_.size(), pugi::parse_minimal | pugi::parse_escapes);
    if (!result) {
      const std::string before = bytes_->text(0, static_cast<std::size_t>(result.offset));
      Faults(bytes_->file())
          .fail(static_cast<std::uint64_t>(std::count(before.begin(), before.end(), '\n')) + 1,
                std::string("malformed XML: ") + result.description());
    }
    root_ = document_.child("VTKFile");
    base64_ = root_.child("AppendedData").child_value();
    base64_.remove_prefix(std::min(base64_.find('_') + 1, base64_.size()));
  }

  void check_root() {
    const std::string type = vtk_attribute(root_, "type"), order = vtk_attribute(root_, "byte_order", "LittleEndian"),
                      header = vtk_attribute(root_, "header_type", "UInt32"),
                      compressor = vtk_attribute(root_, "compressor");
    if (type == "PPolyData" || type == "PUnstructuredGrid")
      fail("the file only names the files of its pieces", "use these, or save one .vtp file with ParaView");
    if (type != "PolyData" && type != "UnstructuredGrid")
      fail(fmt::format("VTK type {} is not supported; supported: PolyData and UnstructuredGrid", quoted_word(type)),
           "save the points as a .vtp file with ParaView");
    if (order != "LittleEndian" && order != "BigEndian") fail("unknown byte order " + quoted_word(order));
    if (header != "UInt32" && header != "UInt64") fail("unknown header type " + quoted_word(header));
    if (!compressor.empty() && compressor != "vtkZLibDataCompressor")
      fail(fmt::format("the compression {} is not supported", quoted_word(compressor)),
           "save the file with zlib compression, or without");
    storage_.is_big_endian = order == "BigEndian";
    storage_.has_long_headers = header == "UInt64";
    storage_.is_compressed = !compressor.empty();
  }

  Bytes bytes_;
  std::string text_;  ///< referenced by document_
  pugi::xml_document document_;
  pugi::xml_node root_;
  std::uint64_t raw_begin_ = 0;  ///< offset of appended raw data; 0: there are none
  std::string_view base64_;      ///< appended data in base64
  VtkStorage storage_;
};

/// An array of all pieces: the points, or data of them.
struct VtkArray {
  std::string name;
  NumberType type = NumberType::kFloat32;
  std::uint64_t components = 1;
  std::vector<pugi::xml_node> pieces;  ///< its DataArray in each piece
  std::vector<std::string> columns;    ///< of its components
};

constexpr NumberTypeName kVtkTypeNames[] = {{"Int8", NumberType::kInt8},       {"UInt8", NumberType::kUint8},
                                            {"Int16", NumberType::kInt16},     {"UInt16", NumberType::kUint16},
                                            {"Int32", NumberType::kInt32},     {"UInt32", NumberType::kUint32},
                                            {"Int64", NumberType::kInt64},     {"UInt64", NumberType::kUint64},
                                            {"Float32", NumberType::kFloat32}, {"Float64", NumberType::kFloat64}};

class VtkFile final : public SingleFrame {
 public:
  VtkFile(const Bytes& bytes, std::uint64_t limit) : SingleFrame(bytes), document_(bytes, limit) {
    for (const pugi::xml_node piece : document_.data().children("Piece")) add_piece(piece);
    if (pieces_.empty()) describe_no_points();
    for (VtkArray& array : arrays_) add_columns(array);
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
    Table table = empty_table(names);
    Faults faults(bytes_->file());
    for (const VtkArray& array : arrays_) {
      std::vector<RecordField> fields;
      for (std::size_t i = 0; i < array.columns.size(); ++i)
        if (base::contains(names, array.columns[i]))
          fields.push_back({array.columns[i], array.type, i * size_of(array.type)});
      for (std::size_t piece = 0; piece < pieces_.size() && !fields.empty(); ++piece)
        for (Column& part : read_piece(array, piece, fields, faults))
          append(std::move(part.values), table.find(part.name)->values);
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
    const std::optional<NumberType> number = number_type(kVtkTypeNames, type);
    const std::uint64_t components = document_.integer(node, "NumberOfComponents", "1");
    if (!node) document_.fail("a piece has no <Points>");
    if (type == "String" || type == "Bit" || components == 0) return;
    if (!number) document_.fail(fmt::format("array {} has the unknown type {}", quoted_word(name), quoted_word(type)));
    auto array = std::find_if(arrays_.begin(), arrays_.end(), [&](const VtkArray& a) { return a.name == name; });
    if (array == arrays_.end()) {
      if (arrays_.size() == kMaxColumns) document_.fail(fmt::format("there are more than {} arrays", kMaxColumns));
      arrays_.push_back({name, *number, components, {}, {}});
      array = arrays_.end() - 1;
    }
    if (array->type != *number || array->components != components)
      document_.fail(fmt::format("the pieces have arrays {} of different types or sizes", quoted_word(name)));
    array->pieces.push_back(node);
  }

  void add_columns(VtkArray& array) {
    if (info_.columns.size() + array.components > kMaxColumns || array.components > kMaxColumns)
      document_.fail(fmt::format("there are more than {} columns", kMaxColumns));
    for (const std::string& name :
         component_names(array.name, static_cast<std::size_t>(array.components), info_.columns)) {
      array.columns.push_back(names_.add(name));
      info_.columns.push_back({array.columns.back(), column_type(array.type)});
    }
  }

  std::vector<Column> read_piece(const VtkArray& array, std::size_t piece, std::vector<RecordField> fields,
                                 Faults& faults) const {
    const VtkBytes found = document_.array(array.pieces[piece], array.name, array.type);
    RecordLayout layout{found.begin, array.components * size_of(array.type), pieces_[piece]};
    if (found.size % layout.stride != 0 || found.size / layout.stride != layout.rows)
      faults.fail(0, fmt::format("array {} has {} bytes; {} points need {} each", quoted_word(array.name), found.size,
                                 layout.rows, layout.stride));
    for (RecordField& field : fields) field.is_big_endian = found.is_big_endian;
    return read_records(*found.source, layout, fields, faults);
  }

  /// Appends numbers to a column of the same type.
  static void append(Values piece, Values& to) {
    std::visit(
        [&](auto& column) {
          if constexpr (requires { column.resize(1); }) {
            auto& more = std::get<std::decay_t<decltype(column)>>(piece);
            if (column.empty())
              column = std::move(more);
            else
              column.insert(column.end(), more.begin(), more.end());
          }
        },
        to);
  }

  VtkDocument document_;
  std::vector<std::uint64_t> pieces_;  ///< number of points of each
  std::vector<VtkArray> arrays_;
  UniqueNames names_;
};

constexpr std::string_view kLegacy = "# vtk DataFile";

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

}  // namespace

const FormatReader kVtk = {"VTK", is_vtk, open_vtk};

}  // namespace orrery::data
