// SPDX-License-Identifier: Apache-2.0
#include "scene/number_array.h"

#include <algorithm>
#include <memory>
#include <span>
#include <utility>

namespace orrery::scene {

bool NumberArray::fits_single() const noexcept {
  switch (storage_) {
    case Storage::kOne: return is_single(value_);
    case Storage::kPalette: return std::all_of(palette_.begin(), palette_.end(), is_single);
    case Storage::kSingles: return true;
    case Storage::kDoubles: break;
  }
  return false;
}

void NumberArray::release(std::size_t begin, std::size_t end) {
  if (storage_ == Storage::kDoubles) base::release_memory(std::span(doubles_).subspan(begin, end - begin));
  if (storage_ == Storage::kSingles && singles_.use_count() == 1)
    base::release_memory(std::span(*singles_).subspan(begin, end - begin));
}

void NumberArray::spread(double value) {
  const std::size_t capacity = std::max(reserved_, count_);
  if (storage_ == Storage::kOne) {
    indices_.reserve(capacity);
    indices_.assign(count_, 0);
    palette_ = {value_};
    last_found_ = 0;
    storage_ = Storage::kPalette;
    return;
  }
  const auto copy_to = [&](auto& numbers) {
    numbers.reserve(capacity);
    for (std::size_t i = 0; i < count_; ++i)
      numbers.push_back(static_cast<typename std::remove_reference_t<decltype(numbers)>::value_type>((*this)[i]));
  };
  if (storage_ == Storage::kPalette && fits_single() && is_single(value)) {
    base::HugeVector<float> singles;
    copy_to(singles);
    singles_ = std::make_shared<base::HugeVector<float>>(std::move(singles));
    storage_ = Storage::kSingles;
  } else {
    base::HugeVector<double> doubles;
    copy_to(doubles);
    doubles_ = std::move(doubles);
    singles_ = nullptr;
    storage_ = Storage::kDoubles;
  }
  std::vector<std::uint8_t>().swap(indices_);
  std::vector<double>().swap(palette_);
}

}  // namespace orrery::scene
