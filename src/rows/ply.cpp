// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "data/byte_source.h"

#include "data/customary.h"
#include "data/faults.h"
#include "data/records.h"
#include "data/single_frame.h"
#include "data/text_rows.h"
#include "rows/ply_rows.h"
#include "rows/readers.h"

// Reference  turk1994
namespace orrery::rows {

using namespace data;  // NOLINT(google-build-using-namespace)

namespace {

bool is_float(NumberType type) { return type == NumberType::kFloat32 || type == NumberType::kFloat64; }

/// The columns of a `vertex` element: all properties but lists.
class PlyFile final : public SingleFrame {
 public:
  explicit PlyFile(const Bytes& bytes) : SingleFrame(data::Format::kPly, bytes) {
    Faults faults(bytes->file());
    int line = 0;
    if (const std::string fault = parse_ply_header(bytes->text(0, kLongestHeader + 1), header_, line); !fault.empty())
      faults.fail(static_cast<std::uint64_t>(line), fault);
    const auto vertex = std::find_if(header_.elements.begin(), header_.elements.end(),
                                     [](const PlyElement& e) { return e.name == "vertex"; });
    if (vertex == header_.elements.end()) faults.fail(0, "there is no element `vertex`");
    vertex_ = static_cast<std::size_t>(vertex - header_.elements.begin());
    std::uint64_t left = bytes->size() - header_.bytes;
    for (const PlyElement& element : header_.elements) {
      check_count(faults, element, header_, left);
      left -= std::min(left, element.count * min_bytes(element, header_.encoding));
    }
    describe_columns(faults);
  }

  Table read(int, const std::vector<std::string>& names) override {
    Faults faults(bytes_->file());
    std::vector<std::size_t> wanted;  // indices of properties
    for (const std::string& name : names) {
      const auto& all = vertex().properties;
      wanted.push_back(static_cast<std::size_t>(
          std::find_if(all.begin(), all.end(), [&](const PlyProperty& p) { return p.name == name; }) - all.begin()));
    }
    std::vector<Values> values = !has_plain_rows() ? read_rows(wanted, faults)
                                 : is_ascii()      ? read_lines(wanted, faults)
                                                   : read_binary(wanted, faults);
    faults.raise_if_any();
    Table table;
    table.rows = static_cast<std::size_t>(info_.rows);
    for (std::size_t i = 0; i < names.size(); ++i) table.columns.push_back({names[i], std::move(values[i])});
    return table;
  }

 private:
  const PlyElement& vertex() const { return header_.elements[vertex_]; }
  bool is_ascii() const { return header_.encoding == PlyEncoding::kAscii; }
  /// Numbers of an ASCII file are read as float64 or int64.
  ColumnType type_of(const PlyProperty& property) const {
    if (!is_ascii()) return column_type(property.type);
    return is_float(property.type) ? ColumnType::kFloat64 : ColumnType::kInt64;
  }

  void describe_columns(Faults& faults) {
    std::vector<ColumnInfo> declared;  // full intensity depends on the declared type
    for (const PlyProperty& property : vertex().properties)
      if (!property.is_list) {
        declared.push_back({property.name, column_type(property.type)});
        info_.columns.push_back({property.name, type_of(property)});
      }
    info_.rows = vertex().count;
    info_.roles = required_roles(declared, faults);
  }

  /// Returns whether the vertices can be read without following lists or lines of other elements.
  bool has_plain_rows() const {
    if (vertex().has_list()) return false;
    for (std::size_t e = 0; e < header_.elements.size(); ++e) {
      const PlyElement& element = header_.elements[e];
      if (e != vertex_ && element.count > 0 && (is_ascii() || (e < vertex_ && element.has_list()))) return false;
    }
    return true;
  }

  std::vector<Values> read_binary(const std::vector<std::size_t>& wanted, Faults& faults) const {
    RecordLayout layout;
    layout.begin = header_.bytes;
    for (std::size_t e = 0; e < vertex_; ++e)
      layout.begin += header_.elements[e].count * min_bytes(header_.elements[e], header_.encoding);
    layout.stride = min_bytes(vertex(), header_.encoding);
    layout.rows = vertex().count;
    check_rest(layout.begin + layout.rows * layout.stride, faults);
    std::vector<std::uint64_t> offsets;
    std::uint64_t offset = 0;
    for (const PlyProperty& property : vertex().properties) {
      offsets.push_back(offset);
      offset += size_of(property.type);
    }
    std::vector<RecordField> fields;
    for (const std::size_t p : wanted)
      fields.push_back({vertex().properties[p].name, vertex().properties[p].type, offsets[p],
                        header_.encoding == PlyEncoding::kBigEndian});
    return read_records(*bytes_, layout, fields, faults);
  }

  /// Checks that the elements after the vertices are complete.
  void check_rest(std::uint64_t at, Faults& faults) const {
    std::size_t e = vertex_ + 1;
    for (; e < header_.elements.size() && !header_.elements[e].has_list(); ++e)
      at += header_.elements[e].count * min_bytes(header_.elements[e], header_.encoding);
    PlyCursor cursor(*bytes_, at, header_.encoding, 0);
    for (; e < header_.elements.size(); ++e) {
      check_count(faults, header_.elements[e], header_, cursor.bytes_left());
      skip_element(faults, header_.elements[e], header_, cursor);
    }
    check_end(faults, header_, cursor);
  }

  /// Reads an ASCII file that contains only vertices.
  std::vector<Values> read_lines(const std::vector<std::size_t>& wanted, Faults& faults) const {
    TextLayout layout;
    layout.begin = header_.bytes;
    layout.first_line = static_cast<std::uint64_t>(header_.lines) + 1;
    for (const PlyProperty& property : vertex().properties) layout.columns.push_back({type_of(property), false});
    for (const std::size_t p : wanted) layout.columns[p].is_wanted = true;
    TextTable text = read_text_rows(*bytes_, layout, faults);
    if (text.rows != vertex().count)
      faults.fail(
          static_cast<std::uint64_t>(vertex().line),
          fmt::format(
              "the header declares {} rows of `vertex`, but there are {}; the file is truncated, or the count is wrong",
              vertex().count, text.rows));
    std::vector<Values> out;
    for (const std::size_t p : wanted) out.push_back(std::move(text.values[p]));
    return out;
  }

  /// Reads all rows one by one, with lists and with other elements between them.
  std::vector<Values> read_rows(const std::vector<std::size_t>& wanted, Faults& faults) const {
    PlyCursor cursor(*bytes_, header_.bytes, header_.encoding, header_.lines + 1);
    std::vector<Values> out;
    for (const std::size_t p : wanted) out.push_back(empty_values(type_of(vertex().properties[p])));
    for (const PlyElement& element : header_.elements) {
      check_count(faults, element, header_, cursor.bytes_left());
      if (&element != &vertex()) {
        skip_element(faults, element, header_, cursor);
        continue;
      }
      std::vector<double> row(element.properties.size());
      for (Values& values : out)
        std::visit(
            [&](auto& column) {
              if constexpr (requires { column.reserve(0); }) column.reserve(static_cast<std::size_t>(element.count));
            },
            values);
      for (std::uint64_t i = 0; i < element.count; ++i) {
        const auto name = [&] { return fmt::format("vertex {} of {}", i + 1, element.count); };
        read_row(faults, element, cursor, name, [&](const PlyProperty& property, std::size_t k) {
          return property.is_list ? cursor.skip(property) : cursor.take(property.type, row[k]);
        });
        for (std::size_t w = 0; w < wanted.size(); ++w)
          if (!append(out[w], row[wanted[w]]))
            faults.fail(static_cast<std::uint64_t>(cursor.line()),
                        fmt::format("{}, `{}`: not a 64-bit integer", name(), element.properties[wanted[w]].name));
      }
    }
    check_end(faults, header_, cursor);
    return out;
  }

  /// Appends a number to a column; false if the column has integers and the number is not one.
  static bool append(Values& values, double number) {
    return std::visit(
        [number](auto& column) {
          if constexpr (requires { column.push_back({}); }) {
            using T = typename std::decay_t<decltype(column)>::value_type;
            if constexpr (std::is_same_v<T, std::int64_t>) {
              constexpr double kBound = 9223372036854775808.0;  // 2^63
              if (!(number >= -kBound && number < kBound) || number != std::floor(number)) return false;
            }
            column.push_back(static_cast<T>(number));
          }
          return true;
        },
        values);
  }

  PlyHeader header_;
  std::size_t vertex_ = 0;  ///< index of the element
};

}  // namespace

bool is_ply(const Signature& signature) {
  return signature.head.starts_with("ply\n") || signature.head.starts_with("ply\r\n");
}

std::unique_ptr<DataFile> open_ply(const Bytes& bytes, const OpenOptions&) { return std::make_unique<PlyFile>(bytes); }

}  // namespace orrery::rows
