// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "data/byte_source.h"
#include "data/data_file.h"

/// One function per format, which recognises a file by its signature and opens it. Used only by particles::open().
namespace orrery::arrays {

bool is_npy(const data::Signature& signature);
std::unique_ptr<data::DataFile> open_npy(const data::Bytes& bytes, const data::OpenOptions& options);

bool is_npz(const data::Signature& signature);
std::unique_ptr<data::DataFile> open_npz(const data::Bytes& bytes, const data::OpenOptions& options);

bool is_las(const data::Signature& signature);
std::unique_ptr<data::DataFile> open_las(const data::Bytes& bytes, const data::OpenOptions& options);

bool is_gsd(const data::Signature& signature);
std::unique_ptr<data::DataFile> open_gsd(const data::Bytes& bytes, const data::OpenOptions& options);

bool is_hdf5(const data::Signature& signature);
std::unique_ptr<data::DataFile> open_hdf5(const data::Bytes& bytes, const data::OpenOptions& options);

bool is_vtk(const data::Signature& signature);
std::unique_ptr<data::DataFile> open_vtk(const data::Bytes& bytes, const data::OpenOptions& options);

}  // namespace orrery::arrays
