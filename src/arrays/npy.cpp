// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include <fmt/core.h>

#include "arrays/npy_columns.h"
#include "arrays/npy_header.h"
#include "arrays/readers.h"
#include "data/byte_source.h"

#include "data/customary.h"
#include "data/faults.h"
#include "data/quoted_word.h"
#include "data/single_frame.h"

namespace orrery::arrays {

using namespace data;  // NOLINT(google-build-using-namespace)

namespace {

/// Checks that the items of an array are rows of named columns.
void check_shape(const NpyHeader& header, Faults& faults) {
  const bool is_table = header.is_structured
                            ? header.shape.size() == 1
                            : header.shape.size() == 2 && (header.shape[1] == 3 || header.shape[1] == 4);
  if (is_table) return;
  faults.fail(0,
              fmt::format("the array has the shape {}{}", shape_text(header),
                          header.is_structured ? "; a structured array must have one dimension"
                                               : "; a plain array must be (N, 3), or (N, 4) with the radius last"),
              header.is_structured
                  ? "flatten it, e.g. with `reshape(-1)`"
                  : "transpose it, or save a structured array or an NPZ file, whose columns have names");
}

class NpyFile final : public SingleFrame {
 public:
  explicit NpyFile(const Bytes& bytes) : SingleFrame(data::Format::kNpy, bytes) {
    Faults faults(bytes->file());
    NpyHeader header;
    if (const std::string fault = parse_npy_header(bytes->text(0, kLongestNpyHeader), header); !fault.empty())
      faults.fail(0, fault);
    check_shape(header, faults);
    if (const std::uint64_t declared = npy_data_bytes(header); declared != bytes->size() - header.begin)
      faults.fail(0, fmt::format("the header declares an array with shape {} with items of {} bytes, but {} bytes "
                                 "follow; the file is truncated, or the header is wrong",
                                 shape_text(header), header.item_size, bytes->size() - header.begin));
    columns_ = npy_columns(header, "xyz", info_.columns);
    if (!header.is_structured) {
      constexpr const char* kNames[] = {"x", "y", "z", "radius"};
      for (std::size_t i = 0; i < columns_.size(); ++i) columns_[i].name = info_.columns[i].name = kNames[i];
    }
    check_unique(faults);
    info_.rows = header.rows();
    info_.roles = required_roles(info_.columns, faults);
    settle_names();
  }

  Table read(int, const std::vector<std::string>& names) override {
    Faults faults(bytes_->file());
    std::vector<NpyColumn> columns;
    for (const std::string& name : names)
      columns.push_back(
          *std::find_if(columns_.begin(), columns_.end(), [&](const NpyColumn& c) { return c.name == name; }));
    Table table;
    table.rows = static_cast<std::size_t>(info_.rows);
    table.columns = read_npy_columns(*bytes_, info_.rows, columns, faults);
    faults.raise_if_any();
    return table;
  }

 private:
  void check_unique(Faults& faults) const {
    for (std::size_t i = 0; i < columns_.size(); ++i)
      for (std::size_t k = 0; k < i; ++k)
        if (columns_[i].name == columns_[k].name) faults.fail(0, "duplicate column " + quoted_word(columns_[i].name));
  }

  std::vector<NpyColumn> columns_;
};

}  // namespace

bool is_npy(const Signature& signature) { return has_npy_signature(signature.head); }

std::unique_ptr<DataFile> open_npy(const Bytes& bytes, const OpenOptions&) { return std::make_unique<NpyFile>(bytes); }

}  // namespace orrery::arrays
