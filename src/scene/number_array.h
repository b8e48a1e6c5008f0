// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <memory>
#include <utility>
#include <vector>

#include "base/huge_pages.h"
#include "math/scalar.h"
#include "math/vec3.h"

namespace orrery::scene {

using math::Vec3d;

/// Read access to an array whose elements are returned by value.
template <class Array, class Value>
class ValueIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = Value;
  using difference_type = std::ptrdiff_t;
  using pointer = const Value*;
  using reference = Value;

  ValueIterator(const Array& array, std::size_t at) : array_(&array), at_(at) {}
  Value operator*() const { return (*array_)[at_]; }
  ValueIterator& operator++() { return ++at_, *this; }
  ValueIterator operator++(int) { return {*array_, at_++}; }
  bool operator==(const ValueIterator& other) const { return at_ == other.at_; }

 private:
  const Array* array_;
  std::size_t at_;
};

/// Numbers of double precision, stored compactly as long as that is lossless: as a single number if all are equal, as
/// one-byte indices if there are few distinct values, or as floats. Copies share the floats until they are changed.
///
/// Not thread-safe, even for writes to different elements.
class NumberArray {
 public:
  using value_type = double;
  using const_iterator = ValueIterator<NumberArray, double>;

  NumberArray() = default;
  NumberArray(std::size_t count, double value) : count_(count), value_(value) {}
  NumberArray(std::initializer_list<double> numbers) { append(numbers); }
  NumberArray(const std::vector<double>& numbers) { append(numbers); }  // NOLINT(google-explicit-constructor)
  explicit NumberArray(base::HugeVector<float> singles)
      : storage_(Storage::kSingles),
        count_(singles.size()),
        singles_(std::make_shared<base::HugeVector<float>>(std::move(singles))) {}
  explicit NumberArray(base::HugeVector<double> doubles)
      : storage_(Storage::kDoubles), count_(doubles.size()), doubles_(std::move(doubles)) {}

  std::size_t size() const noexcept { return count_; }
  bool empty() const noexcept { return count_ == 0; }
  std::size_t bytes() const noexcept {
    const std::size_t singles = singles_ ? singles_->size() : 0;
    return indices_.size() + singles * sizeof(float) + (palette_.size() + doubles_.size()) * sizeof(double);
  }

  double operator[](std::size_t i) const noexcept {
    switch (storage_) {
      case Storage::kPalette: return palette_[indices_[i]];
      case Storage::kSingles: return static_cast<double>((*singles_)[i]);
      case Storage::kDoubles: return doubles_[i];
      case Storage::kOne: break;
    }
    return value_;
  }
  const_iterator begin() const { return {*this, 0}; }
  const_iterator end() const { return {*this, count_}; }

  /// Returns whether a number does not need double precision.
  static bool is_single(double x) { return math::in_single_precision(x) == x || std::isnan(x); }
  /// Returns whether all numbers are equal.
  bool is_uniform() const noexcept { return storage_ == Storage::kOne; }
  /// Returns whether no number needs double precision.
  bool fits_single() const noexcept;
  /// The numbers, if they are stored as floats; otherwise null.
  std::shared_ptr<const base::HugeVector<float>> singles() const noexcept { return singles_; }
  /// The distinct numbers, if numbers are stored as indices; otherwise empty. May contain unused numbers.
  const std::vector<double>& palette() const noexcept { return palette_; }
  /// The index into the palette of each number.
  const std::vector<std::uint8_t>& palette_indices() const noexcept { return indices_; }

  void set(std::size_t i, double value) {
    if (storage_ == Storage::kPalette && find(value)) {
      indices_[i] = last_found_;
    } else if (storage_ == Storage::kSingles && is_single(value)) {
      own_singles()[i] = static_cast<float>(value);
    } else if (storage_ == Storage::kDoubles) {
      doubles_[i] = value;
    } else if (storage_ != Storage::kOne || !is_same(value, value_)) {
      spread(value);
      set(i, value);
    }
  }
  void push_back(double value) {
    if (count_ == 0 && storage_ == Storage::kOne) value_ = value;
    if (storage_ == Storage::kPalette && find(value)) {
      indices_.push_back(last_found_);
    } else if (storage_ == Storage::kSingles && is_single(value)) {
      own_singles().push_back(static_cast<float>(value));
    } else if (storage_ == Storage::kDoubles) {
      doubles_.push_back(value);
    } else if (storage_ != Storage::kOne || !is_same(value, value_)) {
      spread(value);
      push_back(value);
      return;
    }
    ++count_;
  }
  void assign(std::size_t count, double value) { *this = NumberArray(count, value); }
  void clear() { *this = NumberArray(); }
  /// Returns the memory of the numbers begin .. end - 1, which are indeterminate from then on, unless copies share it.
  void release(std::size_t begin, std::size_t end);
  void reserve(std::size_t count) { reserved_ = count; }
  void resize(std::size_t count) {
    if (storage_ == Storage::kPalette) {
      if (count > count_ && !find(0)) {
        spread(0);
        return resize(count);
      }
      indices_.resize(count, last_found_);
    }
    if (storage_ == Storage::kSingles) own_singles().resize(count, 0);
    if (storage_ == Storage::kDoubles) doubles_.resize(count, 0);
    if (is_uniform() && count > count_ && !is_same(value_, 0)) {
      if (count_ == 0) {
        value_ = 0;
      } else {
        spread(0);
        return resize(count);
      }
    }
    count_ = count;
  }

  friend bool operator==(const NumberArray& a, const NumberArray& b) {
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < a.size(); ++i)
      if (!(a[i] == b[i])) return false;
    return true;
  }

 private:
  enum class Storage : std::uint8_t { kOne, kPalette, kSingles, kDoubles };

  /// Maximum palette size; searching a larger one would cost too much time.
  static constexpr std::size_t kMaxPalette = 16;

  /// Distinguishes 0 from -0.
  static bool is_same(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

  /// Sets last_found_ to the value's index in the palette; adds the value if there is room, else returns false.
  bool find(double value) {
    if (is_same(palette_[last_found_], value)) return true;
    for (std::size_t i = 0; i < palette_.size(); ++i)
      if (is_same(palette_[i], value)) {
        last_found_ = static_cast<std::uint8_t>(i);
        return true;
      }
    if (palette_.size() == kMaxPalette) return false;
    last_found_ = static_cast<std::uint8_t>(palette_.size());
    palette_.push_back(value);
    return true;
  }

  template <class Numbers>
  void append(const Numbers& numbers) {
    reserve(numbers.size());
    for (const double x : numbers) push_back(x);
  }
  /// Changes the storage so that it can hold `value`.
  void spread(double value);

  /// The floats, of this array alone.
  base::HugeVector<float>& own_singles() {
    if (singles_.use_count() > 1) singles_ = std::make_shared<base::HugeVector<float>>(*singles_);
    return *singles_;
  }

  Storage storage_ = Storage::kOne;
  std::size_t count_ = 0, reserved_ = 0;
  double value_ = 0;
  std::vector<double> palette_;
  std::uint8_t last_found_ = 0;
  std::vector<std::uint8_t> indices_;
  std::shared_ptr<base::HugeVector<float>> singles_;  ///< null unless they are the storage
  base::HugeVector<double> doubles_;
};

/// Points, stored as NumberArray stores their coordinates.
class PointArray {
 public:
  using value_type = Vec3d;
  using const_iterator = ValueIterator<PointArray, Vec3d>;

  PointArray() = default;
  explicit PointArray(std::size_t count) : numbers_(3 * count, 0) {}
  PointArray(std::initializer_list<Vec3d> points) { append(points); }
  PointArray(const std::vector<Vec3d>& points) { append(points); }  // NOLINT(google-explicit-constructor)
  /// `numbers`  x, y, z of each point
  explicit PointArray(NumberArray numbers) : numbers_(std::move(numbers)) {}

  std::size_t size() const noexcept { return numbers_.size() / 3; }
  bool empty() const noexcept { return numbers_.empty(); }
  Vec3d operator[](std::size_t i) const noexcept { return {numbers_[3 * i], numbers_[3 * i + 1], numbers_[3 * i + 2]}; }
  const_iterator begin() const { return {*this, 0}; }
  const_iterator end() const { return {*this, size()}; }
  std::size_t bytes() const noexcept { return numbers_.bytes(); }
  /// x, y, z of each point.
  const NumberArray& numbers() const noexcept { return numbers_; }

  void set(std::size_t i, Vec3d p) {
    numbers_.set(3 * i, p.x);
    numbers_.set(3 * i + 1, p.y);
    numbers_.set(3 * i + 2, p.z);
  }
  /// Sets one coordinate of a point.
  ///
  /// `axis`     0, 1 or 2
  void set(std::size_t i, std::size_t axis, double value) { numbers_.set(3 * i + axis, value); }
  void push_back(Vec3d p) {
    numbers_.push_back(p.x);
    numbers_.push_back(p.y);
    numbers_.push_back(p.z);
  }
  void clear() { numbers_.clear(); }
  /// See NumberArray.
  void release(std::size_t begin, std::size_t end) { numbers_.release(3 * begin, 3 * end); }
  void reserve(std::size_t count) { numbers_.reserve(3 * count); }
  void resize(std::size_t count) { numbers_.resize(3 * count); }

  friend bool operator==(const PointArray& a, const PointArray& b) { return a.numbers_ == b.numbers_; }

 private:
  template <class Points>
  void append(const Points& points) {
    reserve(points.size());
    for (const Vec3d& p : points) push_back(p);
  }

  NumberArray numbers_;
};

}  // namespace orrery::scene
