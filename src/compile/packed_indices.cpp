// SPDX-License-Identifier: Apache-2.0
#include "compile/packed_indices.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

namespace orrery::compile {

static_assert(std::endian::native == std::endian::little, "elements are read from their lowest byte on");

namespace {

std::uint32_t width_of(std::uint32_t index) { return index < 1u << 8 ? 1 : index < 1u << 16 ? 2 : 4; }

}  // namespace

void PackedIndices::push_back(std::uint32_t index) {
  if (size_ == 0) std::memcpy(bytes_.data(), &index, sizeof(index));
  if (width_ > 0 ? width_of(index) > width_ : index != (*this)[0]) widen(width_of(std::max(index, (*this)[0])));
  if (width_ > 0) {
    bytes_.resize(size_ * width_ + width_ + kPadding);
    set(size_, index);
  }
  ++size_;
}

void PackedIndices::widen(std::uint32_t width) {
  PackedIndices wide;
  wide.width_ = width;
  wide.bytes_.reserve(std::max(reserved_, size_) * wide.width_ + kPadding);
  wide.bytes_.resize(size_ * wide.width_ + kPadding);
  for (std::size_t i = 0; i < size_; ++i) wide.set(i, (*this)[i]);
  bytes_ = std::move(wide.bytes_);
  width_ = wide.width_;
}

void PackedIndices::set(std::size_t i, std::uint32_t index) { std::memcpy(&bytes_[i * width_], &index, width_); }

}  // namespace orrery::compile
