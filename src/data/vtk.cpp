// SPDX-License-Identifier: Apache-2.0
#include "data/readers.h"

namespace orrery::data {

bool is_vtk(const Signature&) { return false; }

std::unique_ptr<DataFile> open_vtk(const Bytes&, const OpenOptions&) { return nullptr; }

}  // namespace orrery::data
