// SPDX-License-Identifier: Apache-2.0
#include "data/readers.h"

namespace orrery::data {

bool is_pdb(const Signature&) { return false; }

std::unique_ptr<DataFile> open_pdb(const Bytes&) { return nullptr; }

}  // namespace orrery::data
