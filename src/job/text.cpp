// SPDX-License-Identifier: Apache-2.0
#include "job/text.h"

#include <nlohmann/json.hpp>

namespace orrery::job {

std::string json_text(const nlohmann::json& value) {
  return value.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace orrery::job
