// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include "base/text.h"
#include "data/frames.h"
#include "data/readers.h"
#include "data/records.h"

// Reference  asprs2019, which includes the point formats of earlier versions
namespace orrery::data {

namespace {

using namespace std::string_view_literals;

constexpr std::string_view kLasSignature = "LASF"sv;
constexpr std::size_t kShortestHeader = 227;    ///< versions 1.0 to 1.2
constexpr std::size_t kHeader14 = 375;          ///< version 1.4, with a count of 64 bits
constexpr std::size_t kVariableRecord = 54;     ///< header of a variable-length record
constexpr std::uint8_t kCompressedBits = 0xC0;  ///< bits of the point format that indicate compression

/// A column that is a number of the record, some bits of it, or a number times a scale plus an offset.
struct LasColumn {
  RecordField field = {};
  std::uint8_t shift = 0, mask = 0xFF;  ///< bits of an 8-bit number
  double scale = 0, offset = 0;         ///< scale 0: the number itself

  ColumnType type() const { return scale != 0 ? ColumnType::kFloat64 : column_type(field.type); }
};

struct LasHeader {
  int point_format = 0;
  RecordLayout points;
  std::array<double, 3> scale{}, offset{};
};

/// Returns the size of the fields that a point format defines; records may be longer.
std::uint64_t defined_bytes(int point_format) {
  constexpr std::uint64_t kBytes[] = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
  return kBytes[point_format];
}

[[noreturn]] void refuse_laz(Faults& faults, const std::filesystem::path& file) {
  const std::string name = base::shell_quoted(file.filename().string()),
                    las = base::shell_quoted(file.stem().string() + ".las");
  faults.fail(0, "the points are compressed (LAZ), which is not supported",
              fmt::format("decompress it: `laszip -i {} -o {}`, or `pdal translate {} {}`", name, las, name, las));
}

/// Returns whether a variable-length record describes compression.
bool has_laszip_record(const ByteSource& bytes, std::uint64_t at, std::uint32_t count, std::uint64_t end) {
  for (; count > 0 && at + kVariableRecord <= end; --count) {
    const std::string record = bytes.text(at, kVariableRecord);
    if (record.size() < kVariableRecord) return false;
    if (record.compare(2, 14, "laszip encoded") == 0) return true;
    at += kVariableRecord + load<std::uint16_t>(record.data() + 20, false);
  }
  return false;
}

LasHeader parse_header(const ByteSource& bytes, Faults& faults) {
  const std::string head = bytes.text(0, kHeader14);
  if (head.size() < kShortestHeader)
    faults.fail(0, fmt::format("the file ends within the header, after {} bytes", head.size()));
  const auto at = [&]<class T>(T, std::size_t offset) { return load<T>(head.data() + offset, false); };
  const int major = at(std::uint8_t{}, 24), minor = at(std::uint8_t{}, 25);
  if (major != 1 || minor > 4) faults.fail(0, fmt::format("version {}.{} of LAS; supported: 1.0 to 1.4", major, minor));
  const auto header_bytes = at(std::uint16_t{}, 94);
  if (header_bytes < kShortestHeader || header_bytes > bytes.size())
    faults.fail(0, fmt::format("the length of the header is {} bytes; must be from {} to the file size", header_bytes,
                               kShortestHeader));
  LasHeader header;
  header.points.begin = at(std::uint32_t{}, 96);
  const auto format = at(std::uint8_t{}, 104);
  if ((format & kCompressedBits) != 0 ||
      has_laszip_record(bytes, header_bytes, at(std::uint32_t{}, 100), header.points.begin))
    refuse_laz(faults, bytes.file());
  header.point_format = format;
  if (format > 10) faults.fail(0, fmt::format("point format {}; supported: 0 to 10", format));
  header.points.stride = at(std::uint16_t{}, 105);
  if (header.points.stride < defined_bytes(format))
    faults.fail(0, fmt::format("point records of {} bytes; point format {} needs {}", header.points.stride, format,
                               defined_bytes(format)));
  header.points.rows = at(std::uint32_t{}, 107);
  if (minor == 4 && header_bytes >= kHeader14 && head.size() >= kHeader14)
    if (const auto count = at(std::uint64_t{}, 247); count > 0) header.points.rows = count;
  if (header.points.begin < header_bytes || !contains(bytes.size(), header.points))
    faults.fail(0, fmt::format("the header declares {} points of {} bytes from byte {}, but the file has {} bytes; the "
                               "file is truncated, or the header is wrong",
                               header.points.rows, header.points.stride, header.points.begin, bytes.size()));
  for (std::size_t i = 0; i < 3; ++i) {
    header.scale[i] = at(double{}, 131 + 8 * i);
    header.offset[i] = at(double{}, 155 + 8 * i);
    if (!std::isfinite(header.scale[i]) || header.scale[i] == 0 || !std::isfinite(header.offset[i]))
      faults.fail(0, "the header's scale or offset of the coordinates is zero or not finite");
  }
  return header;
}

std::vector<LasColumn> columns_of(const LasHeader& header) {
  const int format = header.point_format;
  const bool is_long = format >= 6;
  std::vector<LasColumn> columns;
  const auto add = [&](const char* name, NumberType type, std::uint64_t at, LasColumn column = {}) {
    column.field = {name, type, at, false};
    columns.push_back(column);
  };
  constexpr const char* kCoordinates[] = {"x", "y", "z"};
  for (std::size_t i = 0; i < 3; ++i)
    add(kCoordinates[i], NumberType::kInt32, 4 * i, {.scale = header.scale[i], .offset = header.offset[i]});
  add("intensity", NumberType::kUint16, 12);
  if (is_long) {
    constexpr double kScanAngleUnit_deg = 0.006;
    add("return_number", NumberType::kUint8, 14, {.mask = 0x0F});
    add("number_of_returns", NumberType::kUint8, 14, {.shift = 4, .mask = 0x0F});
    add("classification", NumberType::kUint8, 16);
    add("scan_angle", NumberType::kInt16, 18, {.scale = kScanAngleUnit_deg});
    add("user_data", NumberType::kUint8, 17);
    add("point_source_id", NumberType::kUint16, 20);
  } else {
    add("return_number", NumberType::kUint8, 14, {.mask = 0x07});
    add("number_of_returns", NumberType::kUint8, 14, {.shift = 3, .mask = 0x07});
    add("classification", NumberType::kUint8, 15, {.mask = 0x1F});  // the other bits are flags
    add("scan_angle", NumberType::kInt8, 16, {.scale = 1});
    add("user_data", NumberType::kUint8, 17);
    add("point_source_id", NumberType::kUint16, 18);
  }
  if (is_long || format == 1 || format >= 3) add("gps_time", NumberType::kFloat64, is_long ? 22 : 20);
  const bool has_color = format == 2 || format == 3 || format == 5 || format == 7 || format == 8 || format == 10;
  const std::uint64_t color = is_long ? 30 : format == 2 ? 20 : 28;
  constexpr const char* kColors[] = {"red", "green", "blue"};
  for (std::uint64_t i = 0; i < 3 && has_color; ++i) add(kColors[i], NumberType::kUint16, color + 2 * i);
  if (format == 8 || format == 10) add("near_infrared", NumberType::kUint16, 36);
  return columns;
}

class LasFile final : public SingleFrame {
 public:
  explicit LasFile(const Bytes& bytes) : SingleFrame(bytes) {
    Faults faults(bytes->file());
    header_ = parse_header(*bytes, faults);
    columns_ = columns_of(header_);
    info_.rows = header_.points.rows;
    for (const LasColumn& column : columns_) info_.columns.push_back({column.field.name, column.type()});
    info_.roles.position = {"x", "y", "z"};
    info_.roles.type = "classification";
  }

  FrameInfo describe(int) override {
    // The specification demands 16 bits, but many files have colours of 8 bits.
    if (!colors_are_described_ && find("red") != nullptr) {
      info_.roles.rgb = {"red", "green", "blue"};
      info_.roles.rgb_maximum = has_16_bit_colors() ? 65535 : 255;
    }
    colors_are_described_ = true;
    return info_;
  }

  Table read(int, const std::vector<std::string>& names) override {
    Table table{static_cast<std::size_t>(header_.points.rows), read(header_.points, names)};
    for (Column& column : table.columns) column.values = finished(*find(column.name), std::move(column.values));
    return table;
  }

 private:
  const LasColumn* find(std::string_view name) const {
    const auto found =
        std::find_if(columns_.begin(), columns_.end(), [&](const LasColumn& c) { return c.field.name == name; });
    return found != columns_.end() ? &*found : nullptr;
  }

  /// Reads the numbers in the records.
  std::vector<Column> read(const RecordLayout& layout, const std::vector<std::string>& names) const {
    std::vector<RecordField> fields;
    for (const std::string& name : names) fields.push_back(find(name)->field);
    Faults none(bytes_->file());  // no field of LAS can have a wrong value
    return read_records(*bytes_, layout, fields, none);
  }

  /// Applies the bit mask or the scale.
  static Values finished(const LasColumn& column, Values raw) {
    if (column.scale != 0) {
      const auto& numbers = std::get<std::vector<std::int32_t>>(raw);
      std::vector<double> out(numbers.size());
      for (std::size_t i = 0; i < out.size(); ++i) out[i] = numbers[i] * column.scale + column.offset;
      return out;
    }
    if (column.mask != 0xFF)
      for (std::uint8_t& value : std::get<std::vector<std::uint8_t>>(raw))
        value = static_cast<std::uint8_t>(value >> column.shift & column.mask);
    return raw;
  }

  /// Reads colours until one needs more than 8 bits.
  bool has_16_bit_colors() const {
    constexpr std::uint64_t kRowsAtATime = 1 << 18;
    for (std::uint64_t first = 0; first < header_.points.rows; first += kRowsAtATime) {
      RecordLayout some = header_.points;
      some.begin += first * some.stride;
      some.rows = std::min(kRowsAtATime, header_.points.rows - first);
      for (const Column& column : read(some, {"red", "green", "blue"})) {
        const auto& values = std::get<std::vector<std::uint16_t>>(column.values);
        if (std::any_of(values.begin(), values.end(), [](std::uint16_t v) { return v > 255; })) return true;
      }
    }
    return false;
  }

  LasHeader header_;
  std::vector<LasColumn> columns_;
  bool colors_are_described_ = false;
};

bool is_las(const Signature& signature) { return signature.head.starts_with(kLasSignature); }

}  // namespace

const FormatReader kLas = {"LAS", is_las, open_as<LasFile>};

}  // namespace orrery::data
