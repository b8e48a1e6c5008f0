// SPDX-License-Identifier: Apache-2.0
#include "data/data_file.h"

#include <algorithm>
#include <iterator>
#include <span>

#include <fmt/core.h>

#include "base/file_name.h"
#include "base/text.h"
#include "data/faults.h"
#include "data/readers.h"
#include "data/trajectory.h"

namespace orrery::data {

namespace {

constexpr std::size_t kHeadBytes = std::size_t{64} << 10;

std::string extension_of(const std::filesystem::path& file) {
  const std::string last = base::extension(file);
  const bool is_compressed = last == ".gz" || last == ".zst" || last == ".bz2" || last == ".xz";
  return is_compressed ? base::extension(file.stem()) : last;
}

/// Returns whether a file begins like an EXR, PNG, JPEG, TIFF or Radiance image.
bool is_image(std::string_view head) {
  using namespace std::string_view_literals;
  constexpr std::string_view kBegins[] = {"\x76\x2f\x31\x01"sv, "\x89PNG"sv, "\xff\xd8\xff"sv, "II*\0"sv, "MM\0*"sv,
                                          "#?RADIANCE"sv,       "#?RGBE"sv};
  return std::any_of(std::begin(kBegins), std::end(kBegins), [&](auto begin) { return head.starts_with(begin); });
}

[[noreturn]] void refuse_adios(const std::filesystem::path& file) {
  Faults(file).fail(0, "ADIOS2 files are not supported",
                    "convert it, e.g. with `bpls -d` to CSV, or write HDF5 from the simulation");
}

bool is_adios(const std::string& extension) { return extension == ".bp" || extension == ".bp4" || extension == ".bp5"; }

/// Common formats without a reader, and what to do about each.
[[noreturn]] void refuse(const ByteSource& bytes, const Signature& signature) {
  std::string text = "unknown file format";
  std::string remedy =
      "supported: LAMMPS dump and data, XYZ, PDB, mmCIF, CIF, VASP, GRO, XTC, TRR, DCD, PSF, PLY, CSV (columns x, y, "
      "z), NPY, NPZ, LAS, LAZ, GSD, HDF5 (Gadget, SWIFT), VTP, VTU";
  if (signature.head.empty()) {
    text = "the file is empty";
    remedy.clear();
  } else if (is_image(signature.head)) {
    text = "an image, not a scene or data file";
    remedy = "`oiiotool --info -v` shows its layers and attributes";
  } else if (signature.extension == ".xyz") {
    text = "not an XYZ file: the first line is not the number of atoms";
    remedy = "begin with this number and a comment line";
  } else if (signature.extension == ".pqr") {
    text = "PQR files are not supported";
    remedy = fmt::format(
        "convert it to a table: (echo x y z radius; awk '/^(ATOM|HETATM)/ {{print $(NF-4), $(NF-3), $(NF-2), $NF}}' "
        "{}) > atoms.txt",
        base::shell_quoted(bytes.file().filename().string()));
  } else if (is_adios(signature.extension)) {
    refuse_adios(bytes.file());
  }
  Faults(bytes.file()).fail(0, text, remedy);
}

/// Refuses text that no reader of text can read.
void refuse_encoding(const ByteSource& bytes, std::string_view head) {
  using namespace std::string_view_literals;
  const std::string name = base::shell_quoted(bytes.file().filename().string());
  const auto is_ascii = [&](std::size_t i) { return head[i] > 0; };
  const bool has_pairs = head.size() >= 4 && ((is_ascii(0) && head[1] == 0 && is_ascii(2) && head[3] == 0) ||
                                              (head[0] == 0 && is_ascii(1) && head[2] == 0 && is_ascii(3)));
  if (has_pairs || head.starts_with("\xFF\xFE"sv) || head.starts_with("\xFE\xFF"sv))
    Faults(bytes.file())
        .fail(0, "the text is encoded in UTF-16", fmt::format("convert it: iconv -f UTF-16 -t UTF-8 {} > NEW", name));
  const std::size_t end = head.find_first_of("\r\n\0"sv);
  if (end != std::string_view::npos && end + 1 < head.size() && head[end] == '\r' && head[end + 1] != '\n')
    Faults(bytes.file())
        .fail(0, "the lines end in CR only, as on the classic Mac OS",
              fmt::format("convert it: tr '\\r' '\\n' < {} > NEW", name));
}

constexpr const FormatReader* kBinary[] = {&kPly, &kHdf5, &kGsd, &kLas, &kNpy, &kNpz, &kVtk, &kXtc, &kTrr, &kDcd};
/// The extension of CSV comes before signatures that are words, which may also be in a table.
constexpr const FormatReader* kText[] = {
    &kLammpsDump, &kNamedCsv, &kMmcif, &kPdb, &kXyz, &kVasp, &kGro, &kPsf, &kLammpsData, &kCsv,
};

/// Returns the first reader that recognises a file; null if there is none.
const FormatReader* find(std::span<const FormatReader* const> readers, const Signature& signature) {
  const auto at =
      std::find_if(readers.begin(), readers.end(), [&](const FormatReader* r) { return r->recognises(signature); });
  return at == readers.end() ? nullptr : *at;
}

/// Opens a file with the reader of its format.
std::unique_ptr<DataFile> opened(const std::filesystem::path& file, const OpenOptions& options) {
  std::error_code ignored;
  // These are folders, which cannot be read as files.
  if (is_adios(extension_of(file)) && std::filesystem::is_directory(file, ignored)) refuse_adios(file);
  const Bytes bytes = ByteSource::open(file, options.decompressed_limit);
  const Signature signature{bytes->text(0, kHeadBytes), extension_of(file)};
  const FormatReader* reader = find(kBinary, signature);
  if (reader == nullptr) {
    refuse_encoding(*bytes, signature.head);
    reader = find(kText, signature);
  }
  if (reader == nullptr) refuse(*bytes, signature);
  std::unique_ptr<DataFile> out = reader->open(bytes, options);
  if (*out->format == '\0') out->format = reader->name;  // a reader may know better
  return out;
}

}  // namespace

std::unique_ptr<DataFile> open(const std::filesystem::path& file, const OpenOptions& options) {
  std::unique_ptr<DataFile> out = opened(file, options);
  if (out->format == kPsf.name)
    Faults(file).fail(
        0, "a PSF file names atoms, but has no positions",
        fmt::format("open a trajectory of them with --topology {}", base::shell_quoted(file.filename().string())));
  if (!options.topology.empty())
    out = with_topology(std::move(out), settled(opened(options.topology, options)), file, options.topology);
  return settled(std::move(out));
}

bool is_data_file(const std::filesystem::path& file, std::string_view head) {
  const Signature signature{std::string(head.substr(0, kHeadBytes)), extension_of(file)};
  return is_compressed(head) || find(kBinary, signature) != nullptr || find(kText, signature) != nullptr;
}

}  // namespace orrery::data
