// SPDX-License-Identifier: Apache-2.0
#include "data/readers.h"

namespace orrery::data {

bool is_hdf5(const Signature&) { return false; }

std::unique_ptr<DataFile> open_hdf5(const Bytes&, const OpenOptions&) { return nullptr; }

}  // namespace orrery::data
