// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "data/byte_source.h"
#include "data/data_file.h"

/// One function per format, which recognises a file by its signature and opens it. Used only by particles::open().
namespace orrery::rows {

bool is_lammps_dump(const data::Signature& signature);
std::unique_ptr<data::DataFile> open_lammps_dump(const data::Bytes& bytes, const data::OpenOptions& options);

bool is_lammps_data(const data::Signature& signature);
std::unique_ptr<data::DataFile> open_lammps_data(const data::Bytes& bytes, const data::OpenOptions& options);

bool is_xyz(const data::Signature& signature);
std::unique_ptr<data::DataFile> open_xyz(const data::Bytes& bytes, const data::OpenOptions& options);

bool is_ply(const data::Signature& signature);
std::unique_ptr<data::DataFile> open_ply(const data::Bytes& bytes, const data::OpenOptions& options);

/// Whether the extension alone selects the format.
bool has_csv_extension(const data::Signature& signature);
bool is_csv(const data::Signature& signature);
std::unique_ptr<data::DataFile> open_csv(const data::Bytes& bytes, const data::OpenOptions& options);

}  // namespace orrery::rows
