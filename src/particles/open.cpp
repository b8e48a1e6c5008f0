// SPDX-License-Identifier: Apache-2.0
#include "particles/open.h"

#include <algorithm>
#include <iterator>
#include <string_view>

#include <fmt/core.h>

#include "arrays/readers.h"
#include "base/text.h"
#include "data/byte_source.h"
#include "data/data_file.h"
#include "data/faults.h"
#include "molecules/readers.h"
#include "rows/readers.h"

namespace orrery::particles {

using namespace data;  // NOLINT(google-build-using-namespace)

namespace {

constexpr std::size_t kHeadBytes = std::size_t{64} << 10;

std::string extension_of(const std::filesystem::path& file) {
  const std::string last = base::lower(file.extension().string());
  const bool is_compressed = last == ".gz" || last == ".zst" || last == ".bz2" || last == ".xz";
  return is_compressed ? base::lower(file.stem().extension().string()) : last;
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

/// ADIOS2 data are folders, which cannot be read as files.
void refuse_folder(const std::filesystem::path& file) {
  std::error_code ignored;
  if (is_adios(extension_of(file)) && std::filesystem::is_directory(file, ignored)) refuse_adios(file);
}

/// Common formats without a reader, and what to do about each.
[[noreturn]] void refuse(const ByteSource& bytes, const Signature& signature) {
  std::string text = "unknown file format";
  std::string remedy =
      "supported: LAMMPS dump and data, XYZ, PDB, mmCIF, PLY, CSV, NPY, NPZ, LAS, GSD, HDF5 (Gadget, SWIFT), VTP, VTU";
  if (signature.head.empty()) {
    text = "the file is empty";
    remedy.clear();
  } else if (is_image(signature.head)) {
    text = "an image, not a scene or data file";
    remedy = "`oiiotool --info -v` shows its layers and attributes";
  } else if (signature.extension == ".pqr") {
    text = "PQR files are not supported";
    remedy = fmt::format(
        "convert it to a table: (echo x y z radius; awk '/^(ATOM|HETATM)/ {{print $(NF-4), $(NF-3), $(NF-2), $NF}}' "
        "{}) > atoms.txt",
        bytes.file().filename().string());
  } else if (is_adios(signature.extension)) {
    refuse_adios(bytes.file());
  }
  Faults(bytes.file()).fail(0, text, remedy);
}

}  // namespace

std::unique_ptr<DataFile> open(const std::filesystem::path& file, const OpenOptions& options) {
  refuse_folder(file);
  const Bytes bytes = ByteSource::open(file, options.decompressed_limit);
  const Signature signature{bytes->text(0, kHeadBytes), extension_of(file)};
  if (rows::is_ply(signature)) return rows::open_ply(bytes);
  if (arrays::is_hdf5(signature)) return arrays::open_hdf5(bytes, options);
  if (arrays::is_gsd(signature)) return arrays::open_gsd(bytes);
  if (arrays::is_las(signature)) return arrays::open_las(bytes);
  if (arrays::is_npy(signature)) return arrays::open_npy(bytes);
  if (arrays::is_npz(signature)) return arrays::open_npz(bytes, options);
  if (arrays::is_vtk(signature)) return arrays::open_vtk(bytes, options);
  if (rows::is_lammps_dump(signature)) return rows::open_lammps_dump(bytes);
  if (molecules::is_mmcif(signature)) return molecules::open_mmcif(bytes, options);
  if (molecules::is_pdb(signature)) return molecules::open_pdb(bytes, options);
  if (rows::is_xyz(signature)) return rows::open_xyz(bytes);
  if (rows::is_lammps_data(signature)) return rows::open_lammps_data(bytes);
  if (rows::is_csv(signature)) return rows::open_csv(bytes);
  refuse(*bytes, signature);
}

}  // namespace orrery::particles
