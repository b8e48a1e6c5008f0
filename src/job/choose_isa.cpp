// SPDX-License-Identifier: Apache-2.0
#include "job/choose_isa.h"

#include "base/error.h"
#include "base/text.h"
#include "kernel/isa.h"

namespace orrery::job {

void choose_isa(const std::string& name) {
  if (kernel::limit_isa(name)) return;
  throw base::Error(base::ErrorKind::kUsage, "instruction set " + name +
                                                 " is not available; this processor and program have " +
                                                 base::joined(kernel::available_isas()));
}

}  // namespace orrery::job
