// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <pugixml.hpp>
#include <string>
#include <string_view>

#include "arrays/vtk_bytes.h"
#include "data/byte_source.h"

namespace orrery::arrays {

/// The XML of a VTP or VTU file, and access to its arrays.
class VtkDocument {
 public:
  /// Parses the XML.
  ///
  /// `limit`    maximum size of the decompressed data of an array, bytes
  /// Errors     base::Error(kBadData) for malformed XML, and with a remedy for other types and compressions
  /// Cost       memory for the file, excluding appended raw data
  VtkDocument(std::shared_ptr<const data::ByteSource> bytes, std::uint64_t limit);

  /// Memory of the text.
  std::uint64_t memory() const { return text_.size(); }

  /// Returns <PolyData> or <UnstructuredGrid>.
  pugi::xml_node data() const;

  /// Locates the numbers of a <DataArray>, and decodes them if necessary. `name` is for messages.
  ///
  /// Errors     base::Error(kBadData)
  VtkBytes array(pugi::xml_node node, const std::string& name, data::NumberType type) const;

  /// Returns an attribute that is a non-negative integer.
  ///
  /// `standard` text to use if the attribute is missing
  /// Errors     base::Error(kBadData)
  std::uint64_t integer(pugi::xml_node node, const char* name, const char* standard = "") const;

  [[noreturn]] void fail(const std::string& text, const std::string& remedy = {}) const;

 private:
  void parse();
  void check_root();

  std::shared_ptr<const data::ByteSource> bytes_;
  std::string text_;  ///< referenced by document_
  pugi::xml_document document_;
  pugi::xml_node root_;
  std::uint64_t raw_begin_ = 0;  ///< offset of appended raw data; 0: there are none
  std::string_view base64_;      ///< appended data in base64
  VtkStorage storage_;
};

/// Returns an attribute, or `standard` if it is missing.
std::string vtk_attribute(pugi::xml_node node, const char* name, const char* standard = "");

}  // namespace orrery::arrays
