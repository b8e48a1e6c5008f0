// SPDX-License-Identifier: Apache-2.0
#include "arrays/vtk_document.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include <fmt/core.h>

#include "data/byte_source.h"
#include "data/faults.h"

#include "data/quoted_word.h"

// Reference  vtk-formats
namespace orrery::arrays {

using namespace data;  // NOLINT(google-build-using-namespace)

namespace {

/// Returns the offset of a string in a file; the size of the file if it does not occur.
std::uint64_t find(const ByteSource& bytes, std::string_view text) {
  constexpr std::size_t kBlockBytes = std::size_t{1} << 20;
  for (std::uint64_t at = 0; at < bytes.size(); at += kBlockBytes) {
    const std::size_t found = bytes.text(at, kBlockBytes + text.size() - 1).find(text);
    if (found != std::string::npos) return at + found;
  }
  return bytes.size();
}

}  // namespace

VtkDocument::VtkDocument(std::shared_ptr<const ByteSource> bytes, std::uint64_t limit) : bytes_(std::move(bytes)) {
  storage_.limit = limit;
  parse();
  check_root();
}

void VtkDocument::parse() {
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

void VtkDocument::check_root() {
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

pugi::xml_node VtkDocument::data() const { return root_.child(vtk_attribute(root_, "type").c_str()); }

VtkBytes VtkDocument::array(pugi::xml_node node, const std::string& name, NumberType type) const {
  const std::string format = vtk_attribute(node, "format", "ascii");
  VtkBytes out;
  std::string fault;
  if (format == "ascii") {
    fault = parse_vtk_ascii(bytes_->file(), node.child_value(), type, out);
  } else if (format == "binary") {
    fault = decode_vtk_base64(bytes_->file(), node.child_value(), storage_, out);
  } else if (format == "appended") {
    const std::uint64_t offset = integer(node, "offset");
    if (offset > (raw_begin_ > 0 ? bytes_->size() : base64_.size())) {
      fault = "its offset is wrong";
    } else if (raw_begin_ > 0) {
      fault = find_vtk_raw(bytes_, raw_begin_ + offset, storage_, out);
    } else {
      fault = decode_vtk_base64(bytes_->file(), base64_.substr(static_cast<std::size_t>(offset)), storage_, out);
    }
  } else {
    fault = "unknown format " + quoted_word(format);
  }
  if (!fault.empty()) fail(fmt::format("array {}: {}", quoted_word(name), fault));
  return out;
}

std::uint64_t VtkDocument::integer(pugi::xml_node node, const char* name, const char* standard) const {
  const std::string text = vtk_attribute(node, name, standard);
  std::uint64_t out = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  if (error != std::errc() || end != text.data() + text.size())
    fail(fmt::format("{} is {}, not a non-negative integer", name, quoted_word(text)));
  return out;
}

void VtkDocument::fail(const std::string& text, const std::string& remedy) const {
  Faults(bytes_->file()).fail(0, text, remedy);
}

std::string vtk_attribute(pugi::xml_node node, const char* name, const char* standard) {
  return node.attribute(name).as_string(standard);
}

}  // namespace orrery::arrays
