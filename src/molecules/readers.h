// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "data/byte_source.h"
#include "data/data_file.h"

/// One function per format, which recognises a file by its signature and opens it. Used only by particles::open().
namespace orrery::molecules {

bool is_pdb(const data::Signature& signature);
std::unique_ptr<data::DataFile> open_pdb(const data::Bytes& bytes, const data::OpenOptions& options);

bool is_mmcif(const data::Signature& signature);
std::unique_ptr<data::DataFile> open_mmcif(const data::Bytes& bytes, const data::OpenOptions& options);

}  // namespace orrery::molecules
