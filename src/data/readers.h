// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "data/byte_source.h"
#include "data/data_file.h"
#include "data/faults.h"

/// One function per format: recognises it by its signature, and opens it. Used only by open().
namespace orrery::data {

using Bytes = std::shared_ptr<const ByteSource>;

bool is_lammps_dump(const Signature& signature);
std::unique_ptr<DataFile> open_lammps_dump(const Bytes& bytes);

bool is_lammps_data(const Signature& signature);
std::unique_ptr<DataFile> open_lammps_data(const Bytes& bytes);

bool is_xyz(const Signature& signature);
std::unique_ptr<DataFile> open_xyz(const Bytes& bytes);

bool is_pdb(const Signature& signature);
std::unique_ptr<DataFile> open_pdb(const Bytes& bytes, const OpenOptions& options);

bool is_mmcif(const Signature& signature);
std::unique_ptr<DataFile> open_mmcif(const Bytes& bytes, const OpenOptions& options);

bool is_ply(const Signature& signature);
std::unique_ptr<DataFile> open_ply(const Bytes& bytes);

bool is_csv(const Signature& signature);
std::unique_ptr<DataFile> open_csv(const Bytes& bytes);

bool is_npy(const Signature& signature);
std::unique_ptr<DataFile> open_npy(const Bytes& bytes);

bool is_npz(const Signature& signature);
std::unique_ptr<DataFile> open_npz(const Bytes& bytes, const OpenOptions& options);

bool is_las(const Signature& signature);
std::unique_ptr<DataFile> open_las(const Bytes& bytes);

bool is_gsd(const Signature& signature);
std::unique_ptr<DataFile> open_gsd(const Bytes& bytes);

bool is_hdf5(const Signature& signature);
std::unique_ptr<DataFile> open_hdf5(const Bytes& bytes, const OpenOptions& options);

bool is_vtk(const Signature& signature);
std::unique_ptr<DataFile> open_vtk(const Bytes& bytes, const OpenOptions& options);

}  // namespace orrery::data
