// SPDX-License-Identifier: Apache-2.0
#include "scene/number_array.h"

#include <algorithm>
#include <utility>

namespace orrery::scene {

void NumberArray::spread(double value) {
  const std::size_t capacity = std::max(reserved_, count_);
  if (storage_ == Storage::kOne && is_single(value_) && is_single(value)) {
    singles_.reserve(capacity);
    singles_.assign(count_, static_cast<float>(value_));
    storage_ = Storage::kSingles;
    return;
  }
  std::vector<double> doubles;
  doubles.reserve(capacity);
  for (std::size_t i = 0; i < count_; ++i) doubles.push_back((*this)[i]);
  doubles_ = std::move(doubles);
  std::vector<float>().swap(singles_);
  storage_ = Storage::kDoubles;
}

}  // namespace orrery::scene
