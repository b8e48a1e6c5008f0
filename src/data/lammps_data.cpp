// SPDX-License-Identifier: Apache-2.0
#include "data/readers.h"

namespace orrery::data {

bool is_lammps_data(const Signature&) { return false; }

std::unique_ptr<DataFile> open_lammps_data(const Bytes&) { return nullptr; }

}  // namespace orrery::data
