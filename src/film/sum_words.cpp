// SPDX-License-Identifier: Apache-2.0
#include "film/sums.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>
#include <string>
#include <type_traits>

#include "base/error.h"
#include "base/image_limits.h"
#include "math/pixels.h"

namespace orrery::film {
namespace {

constexpr std::uint32_t kFormat = 8;

/// Number of words of an element.
template <class T>
constexpr std::size_t kWords = sizeof(T) / sizeof(std::uint32_t);

static_assert(std::endian::native == std::endian::little, "words of a number are stored least significant first");

/// Word `w` of an element, in the order of memory.
template <class T>
std::uint32_t word(const T& element, std::size_t w) {
  std::uint32_t out;
  std::memcpy(&out, reinterpret_cast<const std::byte*>(&element) + w * sizeof(out), sizeof(out));
  return out;
}
/// Leaves a word that has the value already untouched, so that pages without sums stay empty.
template <class T>
void set_word(T& element, std::size_t w, std::uint32_t value) {
  if (word(element, w) == value) return;
  std::memcpy(reinterpret_cast<std::byte*>(&element) + w * sizeof(value), &value, sizeof(value));
}

/// Header word of a plane: kConstant is followed by one word for all pixels, kPlane by one word per pixel.
constexpr std::uint32_t kConstant = 0, kPlane = 1;

constexpr const char* kInconsistent = "its sample data are inconsistent";

/// Appends numbers as 32-bit words.
class Writer {
 public:
  explicit Writer(std::vector<std::uint32_t>& out) : out_(out) {}

  template <class T>
  void number(const T& v) {
    for (std::size_t w = 0; w < kWords<T>; ++w) out_.push_back(word(v, w));
  }
  /// Appends `count` elements, as one plane for each of their words.
  template <class At>
  void elements(std::size_t count, At at) {
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
    for (std::size_t w = 0; w < kWords<T>; ++w) set_word(v, w, in_[at_++]);
  }
  template <class At>
  void elements(std::size_t count, At at) {
    using T = std::remove_cvref_t<decltype(at(0))>;
    for (std::size_t w = 0; w < kWords<T> && count > 0; ++w) {
      std::uint32_t kind = 0;
      number(kind);
      if (kind > kPlane) throw base::Error(base::ErrorKind::kBadData, kInconsistent);
      const std::size_t step = kind == kPlane ? 1 : 0, size = kind == kPlane ? count : 1;
      need(size);
      for (std::size_t i = 0; i < count; ++i) set_word(at(i), w, in_[at_ + i * step]);
      at_ += size;
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

// The sums of a pixel, and where to read them: a file has no Sums::empty.
kernel::PixelSum light_of(const Sums& p, std::size_t half, std::size_t i) { return p.light_of(half, i); }
kernel::PixelSum& light_of(Sums& p, std::size_t half, std::size_t i) { return p.light[half][i]; }
kernel::GuideSum guides_of(const Sums& p, std::size_t half, std::size_t i) { return p.guides_of(half, i); }
kernel::GuideSum& guides_of(Sums& p, std::size_t half, std::size_t i) { return p.guides[half][i]; }

/// Reads or writes all numbers in file order, except sphere coverage, whose count varies by pixel.
template <class Io, class P>
void each_number(Io& io, P& sums) {
  io.number(sums.work.paths);
  io.number(sums.work.rays);
  io.number(sums.work.bad_samples);
  io.number(sums.work.seconds);
  const std::size_t pixels = sums.pixel_count();
  const auto arrays = [&](std::size_t most, auto&... all) {
    const auto array = [&](auto& of_pixels) {
      io.extent(of_pixels, pixels, most);
      const std::size_t of_pixel = of_pixels.size() / pixels;
      for (std::size_t k = 0; k < of_pixel; ++k)
        io.elements(
            pixels, [&](std::size_t i) -> auto& { return of_pixels[i * of_pixel + k]; });
    };
    (array(all), ...);
  };
  auto& layers = sums.layers;
  for (const std::size_t half : {0, 1}) {
    io.extent(sums.light[half], pixels, 1);
    io.elements(sums.light[half].size(), [&](std::size_t i) -> decltype(auto) { return light_of(sums, half, i); });
  }
  for (const std::size_t half : {0, 1}) {
    io.extent(sums.guides[half], pixels, 1);
    io.elements(sums.guides[half].size(), [&](std::size_t i) -> decltype(auto) { return guides_of(sums, half, i); });
  }
  arrays(1, sums.largest, sums.counts, sums.goals);
  arrays(base::kMaxLightGroups * kernel::kLobes, layers.light);
  arrays(1, layers.squares, layers.normal, layers.albedo, layers.covered, layers.hit, layers.depth, layers.z,
         layers.position);
}

/// Reads or writes sphere coverage.
template <class Io, class Shares>
void each_share_number(Io& io, Shares& shares) {
  const auto numbers = [&](auto... members) {
    (io.elements(
         shares.size(), [&](std::size_t i) -> auto& { return shares[i].*members; }),
     ...);
  };
  using Share = SphereCoverage;
  numbers(&Share::sphere, &Share::weight, &Share::light, &Share::front, &Share::back);
}

void write_shares(Writer& out, const std::vector<std::vector<SphereCoverage>>& of_pixels) {
  std::vector<SphereCoverage> shares;
  for (const auto& of_pixel : of_pixels) shares.insert(shares.end(), of_pixel.begin(), of_pixel.end());
  out.elements(of_pixels.size(), [&](std::size_t i) { return static_cast<std::uint32_t>(of_pixels[i].size()); });
  each_share_number(out, shares);
}

void read_shares(Reader& in, std::vector<std::vector<SphereCoverage>>& of_pixels) {
  std::vector<std::uint32_t> counts(of_pixels.size());
  in.elements(
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

std::vector<std::uint32_t> to_words(const Sums& sums) {
  std::vector<std::uint32_t> words;
  Writer out(words);
  for (const std::uint32_t v :
       {kFormat, static_cast<std::uint32_t>(sums.width), static_cast<std::uint32_t>(sums.height)})
    out.number(v);
  each_number(out, sums);
  out.extent(sums.layers.shares, sums.pixel_count(), 1);
  write_shares(out, sums.layers.shares);
  return words;
}

Sums from_words(const std::vector<std::uint32_t>& words, int width_px, int height_px) {
  Reader in(words);
  std::uint32_t format = 0, width = 0, height = 0;
  for (std::uint32_t* v : {&format, &width, &height}) in.number(*v);
  if (format != kFormat)
    throw base::Error(base::ErrorKind::kBadData, "this version of orrery does not know the format of its sample data");
  if (width != static_cast<std::uint32_t>(width_px) || height != static_cast<std::uint32_t>(height_px))
    throw base::Error(base::ErrorKind::kBadData, "it is " + std::to_string(width) + " x " + std::to_string(height) +
                                                     " pixels, not " + std::to_string(width_px) + " x " +
                                                     std::to_string(height_px));
  Sums sums(width_px, height_px);
  each_number(in, sums);
  const std::size_t pixels = math::pixel_count(width_px, height_px);
  if (sums.light[0].size() != pixels || sums.counts.size() != pixels)
    throw base::Error(base::ErrorKind::kBadData, kInconsistent);
  in.extent(sums.layers.shares, sums.pixel_count(), 1);
  read_shares(in, sums.layers.shares);
  const auto is_valid = [](float v) { return v >= 0 && v <= 3 * static_cast<float>(kernel::kLargestSample); };
  if (!std::all_of(sums.largest.begin(), sums.largest.end(), is_valid))
    throw base::Error(base::ErrorKind::kBadData, kInconsistent);
  return sums;
}

}  // namespace orrery::film
