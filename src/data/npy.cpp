// SPDX-License-Identifier: Apache-2.0
#include "data/readers.h"

namespace orrery::data {

bool is_npy(const Signature&) { return false; }

std::unique_ptr<DataFile> open_npy(const Bytes&) { return nullptr; }

}  // namespace orrery::data
