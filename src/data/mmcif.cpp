// SPDX-License-Identifier: Apache-2.0
#include "data/readers.h"

namespace orrery::data {

bool is_mmcif(const Signature&) { return false; }

std::unique_ptr<DataFile> open_mmcif(const Bytes&) { return nullptr; }

}  // namespace orrery::data
