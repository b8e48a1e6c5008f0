// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <type_traits>

#include "data/data_file.h"

/// The formats that are read, each defined in a separate file. Used only by open().
namespace orrery::data {

/// The first bytes of a file and its extension, used to recognise formats.
struct Signature {
  std::string head;       ///< up to 64 KiB, decompressed
  std::string extension;  ///< lower case, without ".gz", ".zst": ".xyz"; may be empty
};

struct FormatReader {
  const char* name;
  bool (*recognises)(const Signature& signature);
  std::unique_ptr<DataFile> (*open)(const Bytes& bytes, const OpenOptions& options);
};

/// Opens a file with a reader, whose constructor takes the bytes, or the bytes and the options.
template <class File>
std::unique_ptr<DataFile> open_as(const Bytes& bytes, const OpenOptions& options) {
  if constexpr (std::is_constructible_v<File, const Bytes&, const OpenOptions&>)
    return std::make_unique<File>(bytes, options);
  else
    return std::make_unique<File>(bytes);
}

extern const FormatReader kLammpsDump, kLammpsData, kXyz, kVasp, kPly, kCsv;
extern const FormatReader kNpy, kNpz, kLas, kGsd, kHdf5, kVtk;
extern const FormatReader kGro, kXtc, kTrr, kDcd, kPsf;
extern const FormatReader kPdb, kMmcif;
/// Opens a CIF file with fractional coordinates, which kMmcif recognises.
std::unique_ptr<DataFile> open_small_cif(const Bytes& bytes, const OpenOptions& options);
/// CSV, as selected by the extension alone.
extern const FormatReader kNamedCsv;

}  // namespace orrery::data
