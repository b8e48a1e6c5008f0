// SPDX-License-Identifier: Apache-2.0
#include "film/partial.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <functional>
#include <string>
#include <type_traits>

#include "base/error.h"
#include "base/image_limits.h"
#include "math/pixels.h"

namespace orrery::film {
namespace {

constexpr std::uint32_t kFormat = 8;

/// Number of words of a number.
template <class T>
constexpr std::size_t kWords = sizeof(T) / sizeof(std::uint32_t);

/// Word `w` of a number, least significant first.
template <class T>
std::uint32_t word(const T& v, std::size_t w) {
  if constexpr (kWords<T> == 1) {
    return std::bit_cast<std::uint32_t>(v);
  } else if constexpr (kWords<T> == 2) {
    return static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(v) >> 32 * w);
  } else {
    return static_cast<std::uint32_t>(v >> 32 * w);
  }
}

/// The number of these words.
template <class T>
T joined(const std::uint32_t* words) {
  if constexpr (kWords<T> == 1) {
    return std::bit_cast<T>(words[0]);
  } else if constexpr (kWords<T> == 2) {
    return std::bit_cast<T>(std::uint64_t{words[1]} << 32 | words[0]);
  } else {
    __extension__ using Unsigned = unsigned __int128;
    Unsigned v = 0;
    for (std::size_t w = kWords<T>; w-- > 0;) v = v << 32 | words[w];
    return static_cast<T>(v);
  }
}

/// Header word of a plane: kConstant is followed by one word for all pixels, kPlane by one word per pixel.
constexpr std::uint32_t kConstant = 0, kPlane = 1;

constexpr const char* kInconsistent = "its sample data are inconsistent";

/// Appends numbers as 32-bit words, least significant first.
class Writer {
 public:
  explicit Writer(std::vector<std::uint32_t>& out) : out_(out) {}

  template <class T>
  void number(const T& v) {
    for (std::size_t w = 0; w < kWords<T>; ++w) out_.push_back(word(v, w));
  }
  /// Appends one number of each of `count` things, as one plane per word of the number.
  template <class At>
  void numbers(std::size_t count, At at) {
    using T = std::remove_cvref_t<decltype(at(0))>;
    for (std::size_t w = 0; w < kWords<T> && count > 0; ++w) {
      const std::uint32_t first = word(at(0), w);
      bool is_constant = true;
      for (std::size_t i = 0; i < count; ++i) is_constant = is_constant && word(at(i), w) == first;
      out_.push_back(is_constant ? kConstant : kPlane);
      if (is_constant) {
        out_.push_back(first);
      } else {
        for (std::size_t i = 0; i < count; ++i) out_.push_back(word(at(i), w));
      }
    }
  }
  /// Appends how many elements of an array a pixel has.
  template <class Array>
  void extent(const Array& array, std::size_t pixels, std::size_t) {
    number(static_cast<std::uint32_t>(array.size() / pixels));
  }

 private:
  std::vector<std::uint32_t>& out_;
};

/// Reads numbers that Writer appended.
class Reader {
 public:
  explicit Reader(const std::vector<std::uint32_t>& in) : in_(in) {}

  template <class T>
  void number(T& v) {
    need(kWords<T>);
    v = joined<T>(&in_[at_]);
    at_ += kWords<T>;
  }
  template <class At>
  void numbers(std::size_t count, At at) {
    using T = std::remove_cvref_t<decltype(at(0))>;
    if (count == 0) return;
    const std::uint32_t* planes[kWords<T>];
    std::size_t steps[kWords<T>];
    for (std::size_t w = 0; w < kWords<T>; ++w) {
      std::uint32_t kind = 0;
      number(kind);
      if (kind > kPlane) throw base::Error(base::ErrorKind::kBadData, kInconsistent);
      steps[w] = kind == kPlane ? 1 : 0;
      const std::size_t size = kind == kPlane ? count : 1;
      need(size);
      planes[w] = &in_[at_];
      at_ += size;
    }
    for (std::size_t i = 0; i < count; ++i) {
      std::uint32_t words[kWords<T>];
      for (std::size_t w = 0; w < kWords<T>; ++w) {
        words[w] = *planes[w];
        planes[w] += steps[w];
      }
      at(i) = joined<T>(words);
    }
  }
  /// Resizes an array to as many elements of a pixel as were written, at most `most`.
  template <class Array>
  void extent(Array& array, std::size_t pixels, std::size_t most) {
    std::uint32_t of_pixel = 0;
    number(of_pixel);
    if (of_pixel > most) throw base::Error(base::ErrorKind::kBadData, kInconsistent);
    need(std::size_t{of_pixel} * 2);  // each of their planes has two words at least: fails before allocation
    array.resize(of_pixel * pixels);
  }

  void need(std::size_t words) const {
    if (in_.size() - at_ < words) throw base::Error(base::ErrorKind::kBadData, "its sample data are truncated");
  }

 private:
  const std::vector<std::uint32_t>& in_;
  std::size_t at_ = 0;
};

/// An element of a member that is an array.
template <class Member>
auto element(Member member, int k) {
  return [=](auto& thing) -> auto& { return (thing.*member)[k]; };
}

/// Reads or writes all numbers of a partial render in file order, except sphere coverage, whose count varies by pixel.
template <class Io, class P>
void each_number(Io& io, P& partial) {
  io.number(partial.work.paths);
  io.number(partial.work.rays);
  io.number(partial.work.bad_samples);
  io.number(partial.work.seconds);
  const std::size_t pixels = partial.pixel_count();
  const auto several = [&](std::size_t most, auto& things, auto... ats) {
    io.extent(things, pixels, most);
    const std::size_t of_pixel = things.size() / pixels;
    for (std::size_t k = 0; k < of_pixel; ++k)
      (io.numbers(
           pixels, [&, at = ats ](std::size_t i) -> auto& { return std::invoke(at, things[i * of_pixel + k]); }),
       ...);
  };
  const auto array = [&](auto& things, auto... ats) { several(1, things, ats...); };
  const auto itself = [](auto& v) -> auto& { return v; };
  const auto value = [](std::size_t k) {
    return [=](auto& values) -> auto& { return values[k]; };
  };
  for (auto& sums : partial.light) {
    using Sum = kernel::PixelSum;
    array(sums, element(&Sum::rgb, 0), element(&Sum::rgb, 1), element(&Sum::rgb, 2), &Sum::weight);
  }
  for (auto& sums : partial.guides) {
    using Sum = kernel::GuideSum;
    array(sums, &Sum::inverse_depth, &Sum::weight, element(&Sum::albedo, 0), element(&Sum::albedo, 1),
          element(&Sum::albedo, 2), element(&Sum::normal, 0), element(&Sum::normal, 1), element(&Sum::normal, 2));
  }
  array(partial.largest, itself);
  array(partial.counts, itself);
  array(partial.goals, itself);
  auto& layers = partial.layers;
  several(base::kMaxLightGroups * kernel::kLobes, layers.light, value(0), value(1), value(2));
  for (auto* const sums : {&layers.squares, &layers.normal, &layers.albedo}) array(*sums, value(0), value(1), value(2));
  array(layers.covered, itself);
  array(layers.hit, itself);
  array(layers.depth, itself);
  array(layers.z, itself);
  array(layers.position, value(0), value(1), value(2));
}

template <class Io, class Shares>
void each_share_number(Io& io, Shares& shares) {
  using Share = SphereCoverage;
  const auto numbers = [&](auto... ats) {
    (io.numbers(
         shares.size(), [&, at = ats ](std::size_t i) -> auto& { return std::invoke(at, shares[i]); }),
     ...);
  };
  numbers(&Share::sphere, &Share::weight, element(&Share::light, 0), element(&Share::light, 1),
          element(&Share::light, 2), &Share::front, &Share::back);
}

void write_shares(Writer& out, const std::vector<std::vector<SphereCoverage>>& of_pixels) {
  std::vector<SphereCoverage> shares;
  for (const auto& of_pixel : of_pixels) shares.insert(shares.end(), of_pixel.begin(), of_pixel.end());
  out.numbers(of_pixels.size(), [&](std::size_t i) { return static_cast<std::uint32_t>(of_pixels[i].size()); });
  each_share_number(out, shares);
}

void read_shares(Reader& in, std::vector<std::vector<SphereCoverage>>& of_pixels) {
  std::vector<std::uint32_t> counts(of_pixels.size());
  in.numbers(
      counts.size(), [&](std::size_t i) -> auto& { return counts[i]; });
  std::size_t total = 0;
  for (const std::uint32_t n : counts) total += n;
  // The spheres of a pixel are distinct, so their plane is not constant: a damaged count fails here, before allocation.
  if (total > counts.size()) in.need(total);
  std::vector<SphereCoverage> shares(total);
  each_share_number(in, shares);
  auto next = shares.begin();
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const auto end = next + static_cast<std::ptrdiff_t>(counts[i]);
    of_pixels[i].assign(next, end);
    for (auto s = next; s != end; ++s)
      if (s != next && (s - 1)->sphere >= s->sphere)
        throw base::Error(base::ErrorKind::kBadData, "its sphere numbers are not in ascending order");
    next = end;
  }
}

}  // namespace

std::vector<std::uint32_t> to_words(const Partial& partial) {
  std::vector<std::uint32_t> words;
  Writer out(words);
  for (const std::uint32_t v :
       {kFormat, static_cast<std::uint32_t>(partial.width), static_cast<std::uint32_t>(partial.height)})
    out.number(v);
  each_number(out, partial);
  out.extent(partial.layers.shares, partial.pixel_count(), 1);
  write_shares(out, partial.layers.shares);
  return words;
}

Partial from_words(const std::vector<std::uint32_t>& words, int width_px, int height_px) {
  Reader in(words);
  std::uint32_t format = 0, width = 0, height = 0;
  for (std::uint32_t* v : {&format, &width, &height}) in.number(*v);
  if (format != kFormat)
    throw base::Error(base::ErrorKind::kBadData, "this version of orrery does not know the format of its sample data");
  if (width != static_cast<std::uint32_t>(width_px) || height != static_cast<std::uint32_t>(height_px))
    throw base::Error(base::ErrorKind::kBadData, "it is " + std::to_string(width) + " x " + std::to_string(height) +
                                                     " pixels, not " + std::to_string(width_px) + " x " +
                                                     std::to_string(height_px));
  Partial partial(width_px, height_px);
  each_number(in, partial);
  const std::size_t pixels = math::pixel_count(width_px, height_px);
  if (partial.light[0].size() != pixels || partial.counts.size() != pixels)
    throw base::Error(base::ErrorKind::kBadData, kInconsistent);
  in.extent(partial.layers.shares, partial.pixel_count(), 1);
  read_shares(in, partial.layers.shares);
  const auto is_valid = [](float v) { return v >= 0 && v <= 3 * static_cast<float>(kernel::kLargestSample); };
  if (!std::all_of(partial.largest.begin(), partial.largest.end(), is_valid))
    throw base::Error(base::ErrorKind::kBadData, kInconsistent);
  return partial;
}

}  // namespace orrery::film
