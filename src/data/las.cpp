// SPDX-License-Identifier: Apache-2.0
#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include "base/stop_point.h"
#include "base/text.h"
#include "data/frames.h"
#include "data/readers.h"
#include "data/records.h"

// Reference  asprs2019, which includes the point formats of earlier versions
namespace orrery::data {

namespace {

using namespace std::string_view_literals;

constexpr std::string_view kLasSignature = "LASF"sv;
constexpr std::size_t kShortestHeader = 227;  ///< versions 1.0 to 1.2
constexpr std::size_t kHeader14 = 375;        ///< version 1.4, with a count of 64 bits
constexpr std::size_t kVariableRecord = 54;   ///< header of a variable-length record
constexpr int kCompressedBits = 0xC0;         ///< bits of the point format that indicate compression

/// A column that is a number of the record, some bits of it, or a number times a scale plus an offset.
struct LasColumn {
  RecordField field = {};
  std::uint8_t shift = 0, mask = 0xFF;  ///< bits of an 8-bit number
  double scale = 0, offset = 0;         ///< scale 0: the number itself

  ColumnType type() const { return scale != 0 ? ColumnType::kFloat64 : column_type(field.type); }
};

struct LasHeader {
  int point_format = 0;
  bool is_compressed = false;
  RecordLayout points;
  std::array<double, 3> scale{}, offset{};
};

/// Returns the size of the fields that a point format defines; records may be longer.
std::uint64_t defined_bytes(int point_format) {
  constexpr std::uint64_t kBytes[] = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
  return kBytes[point_format];
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
  const int format = header.point_format = at(std::uint8_t{}, 104) & ~kCompressedBits;
  header.is_compressed = at(std::uint8_t{}, 104) != format ||
                         has_laszip_record(bytes, header_bytes, at(std::uint32_t{}, 100), header.points.begin);
  if (format > 10) faults.fail(0, fmt::format("point format {}; supported: 0 to 10", format));
  header.points.stride = at(std::uint16_t{}, 105);
  if (header.points.stride < defined_bytes(format))
    faults.fail(0, fmt::format("point records of {} bytes; point format {} needs {}", header.points.stride, format,
                               defined_bytes(format)));
  header.points.rows = at(std::uint32_t{}, 107);
  if (minor == 4 && header_bytes >= kHeader14 && head.size() >= kHeader14)
    if (const auto count = at(std::uint64_t{}, 247); count > 0) header.points.rows = count;
  // LASzip 3.5 crashes if the file ends before the offset of its table of chunks.
  const RecordLayout offset{header.points.begin, sizeof(std::uint64_t), std::min<std::uint64_t>(header.points.rows, 1)};
  const bool is_contained = contains(bytes.size(), header.is_compressed ? offset : header.points);
  if (header.points.begin < header_bytes || !is_contained)
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

/// Offsets of optional fields in a record; 0 if a point format lacks them.
struct OptionalFields {
  std::uint64_t time = 0, color = 0, infrared = 0;

  explicit OptionalFields(int format) {
    const bool is_long = format >= 6;
    if (is_long || format == 1 || format >= 3) time = is_long ? 22 : 20;
    if (format == 2 || format == 3 || format == 5 || format == 7 || format == 8 || format == 10)
      color = is_long ? 30 : format == 2 ? 20 : 28;
    if (format == 8 || format == 10) infrared = 36;
  }
};

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
  const OptionalFields at(format);
  if (at.time > 0) add("gps_time", NumberType::kFloat64, at.time);
  constexpr const char* kColors[] = {"red", "green", "blue"};
  for (std::uint64_t i = 0; i < 3 && at.color > 0; ++i) add(kColors[i], NumberType::kUint16, at.color + 2 * i);
  if (at.infrared > 0) add("near_infrared", NumberType::kUint16, at.infrared);
  return columns;
}

/// The beginning of laszip_point, of version 3 of LASzip.
struct LaszipPoint {
  char record[20];  ///< that of point format 0
  std::int16_t scan_angle;
  std::uint8_t flags;
  char classification, returns;  ///< of formats 6 to 10
  char unused[7];
  double time;
  std::uint16_t colors[4];
};
static_assert(offsetof(LaszipPoint, time) == 32 && offsetof(LaszipPoint, colors) == 40);

/// Returns what a record of a format has for its columns.
std::string record_of(const LaszipPoint& point, int format) {
  std::string out(defined_bytes(format), '\0');
  const auto put = [&out](std::uint64_t at, const void* bytes, std::size_t count) {
    std::memcpy(out.data() + at, bytes, count);
  };
  put(0, point.record, sizeof point.record);
  if (format >= 6) {
    out[14] = point.returns;
    out[16] = point.classification;
    put(18, &point.scan_angle, sizeof point.scan_angle);
    put(20, point.record + 18, sizeof(std::uint16_t));  // point_source_id
  }
  const OptionalFields at(format);
  if (at.time > 0) put(at.time, &point.time, sizeof point.time);
  if (at.color > 0) put(at.color, point.colors, 3 * sizeof point.colors[0]);
  if (at.infrared > 0) put(at.infrared, point.colors + 3, sizeof point.colors[0]);
  return out;
}

/// Reads a compressed file with LASzip, which is loaded if it is installed: Debian 12 does not have it. Its functions
/// return 0 on success.
///
/// Reference  laszip
class Laszip {
 public:
  Laszip(const std::filesystem::path& file, Faults& faults) : faults_(faults) {
    const std::string name = base::shell_quoted(file.filename().string()),
                      las = base::shell_quoted(file.stem().string() + ".las");
    if (!library_)
      faults_.fail(0, fmt::format("the points are compressed (LAZ), and {} is not installed", kLibrary),
                   fmt::format("install the package liblaszip8 (Debian 13), or decompress the file on another machine: "
                               "`laszip -i {} -o {}`, or `pdal translate {} {}`",
                               name, las, name, las));
    void* reader = nullptr;
    call("laszip_create", &reader);
    reader_ = {reader, function<void*>("laszip_destroy")};
    int is_compressed = 0;
    call("laszip_open_reader", reader, file.c_str(), &is_compressed);
    call("laszip_get_point_pointer", reader, &point_);
  }
  ByteBlocks records(const LasHeader& header) {
    ByteBlocks out;
    const base::StopPoint stop;
    const auto read = function<void*>("laszip_read_point");
    for (std::uint64_t row = 0; row < header.points.rows; ++row) {
      if (row % 4096 == 0) stop.check();
      if (read(reader_.get()) != 0) fail(fmt::format("point {} of {}", row + 1, header.points.rows));
      out.append(record_of(*point_, header.point_format));
    }
    return out;
  }

 private:
  static constexpr const char* kLibrary = "liblaszip.so.8";

  template <class... Arguments>
  using Function = int (*)(Arguments...);

  template <class... Arguments>
  Function<Arguments...> function(const char* name) const {
    return reinterpret_cast<Function<Arguments...>>(dlsym(library_.get(), name));
  }

  template <class... Arguments>
  void call(const char* name, Arguments... arguments) {
    const auto called = function<Arguments...>(name);
    if (called == nullptr || called(arguments...) != 0) fail(name);
  }

  [[noreturn]] void fail(const std::string& what) {
    const char* why = nullptr;
    const auto error = function<void*, const char**>("laszip_get_error");
    if (reader_ && error != nullptr) error(reader_.get(), &why);
    faults_.fail(0, fmt::format("{}: {}: {}", kLibrary, what, base::printable(why != nullptr ? why : "failed")),
                 "the file is damaged or truncated");
  }

  Faults& faults_;
  std::unique_ptr<void, Function<void*>> library_{dlopen(kLibrary, RTLD_NOW), dlclose};
  std::unique_ptr<void, Function<void*>> reader_{nullptr, nullptr};
  const LaszipPoint* point_ = nullptr;
};

class LasFile final : public SingleFrame {
 public:
  LasFile(const Bytes& bytes, const OpenOptions& options) : SingleFrame(bytes) {
    Faults faults(bytes->file());
    header_ = parse_header(*bytes, faults);
    if (header_.is_compressed) decompress(options.decompressed_limit, faults);
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
  /// Replaces the bytes by the decompressed records.
  void decompress(std::uint64_t limit, Faults& faults) {
    format = "LAZ";
    RecordLayout& points = header_.points;
    points.stride = defined_bytes(header_.point_format);
    points.begin = 0;
    if (points.rows > limit / points.stride)
      faults.fail(0, fmt::format("{} points decompress to more than {}", points.rows, base::bytes_text(limit)),
                  "the header is wrong, or decompress the file first");
    bytes_ = ByteSource::of_memory(bytes_->file(), Laszip(bytes_->file(), faults).records(header_));
  }

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
