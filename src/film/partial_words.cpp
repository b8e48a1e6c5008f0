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
#include "film/film.h"
#include "film/layer_pixel.h"
#include "film/layers.h"

namespace orrery::film {
namespace {

constexpr std::uint32_t kFormat = 7;

enum Flag : std::uint32_t { kHasSecond = 1, kHasGoals = 2, kHasLayers = 4, kHasHalves = 8, kAllFlags = 15 };

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
  /// Appends one number of every element of `things`, as one plane per word of the number.
  template <class Things, class At>
  void numbers(Things& things, At at) {
    using T = std::remove_reference_t<decltype(std::invoke(at, things[0]))>;
    for (std::size_t w = 0; w < kWords<T> && !things.empty(); ++w) {
      const std::uint32_t first = word(std::invoke(at, things[0]), w);
      bool is_constant = true;
      for (auto& thing : things) is_constant = is_constant && word(std::invoke(at, thing), w) == first;
      out_.push_back(is_constant ? kConstant : kPlane);
      if (is_constant) {
        out_.push_back(first);
      } else {
        for (auto& thing : things) out_.push_back(word(std::invoke(at, thing), w));
      }
    }
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
  template <class Things, class At>
  void numbers(Things& things, At at) {
    using T = std::remove_reference_t<decltype(std::invoke(at, things[0]))>;
    if (things.empty()) return;
    const std::uint32_t* planes[kWords<T>];
    std::size_t steps[kWords<T>];
    for (std::size_t w = 0; w < kWords<T>; ++w) {
      std::uint32_t kind = 0;
      number(kind);
      if (kind > kPlane) throw base::Error(base::ErrorKind::kBadData, kInconsistent);
      steps[w] = kind == kPlane ? 1 : 0;
      const std::size_t size = kind == kPlane ? things.size() : 1;
      need(size);
      planes[w] = &in_[at_];
      at_ += size;
    }
    for (auto& thing : things) {
      std::uint32_t words[kWords<T>];
      for (std::size_t w = 0; w < kWords<T>; ++w) {
        words[w] = *planes[w];
        planes[w] += steps[w];
      }
      std::invoke(at, thing) = joined<T>(words);
    }
  }

  void need(std::size_t words) const {
    if (in_.size() - at_ < words) throw base::Error(base::ErrorKind::kBadData, "its sample data are truncated");
  }

 private:
  const std::vector<std::uint32_t>& in_;
  std::size_t at_ = 0;
};

/// Reads or writes several numbers of every element of `things`, one after another.
///
/// `ats`      members, or functions that return one
template <class Io, class Things, class... Ats>
void each(Io& io, Things& things, Ats... ats) {
  (io.numbers(things, ats), ...);
}

/// An element of a member that is an array.
template <class Member>
auto element(Member member, int k) {
  return [=](auto& thing) -> auto& { return (thing.*member)[k]; };
}

template <class Io, class Sums>
void each_sum(Io& io, Sums& sums) {
  for (int c = 0; c < 3; ++c) each(io, sums, element(&kernel::PixelSum::rgb, c));
  each(io, sums, &kernel::PixelSum::weight);
}

template <class Io, class Layers>
void each_layer_number(Io& io, Layers& layers) {
  using P = LayerPixel;
  for (int k = 0; k < 3; ++k)
    each(io, layers, element(&P::squares, k), element(&P::normal, k), element(&P::albedo, k), element(&P::position, k));
  each(io, layers, &P::weight, &P::lit, &P::covered, &P::depth, &P::z, &P::sphere);
}

template <class Io, class BothHalves>
void each_half_number(Io& io, BothHalves& halves) {
  for (std::size_t i = 0; i < 2; ++i) {
    for (int k = 0; k < 3; ++k)
      each(
          io, halves, [=](auto& h) -> auto& { return h[i].light.rgb[k]; },
          [=](auto& h) -> auto& { return h[i].guides.albedo[k]; },
          [=](auto& h) -> auto& { return h[i].guides.normal[k]; });
    each(
        io, halves, [=](auto& h) -> auto& { return h[i].light.weight; },
        [=](auto& h) -> auto& { return h[i].guides.weight; },
        [=](auto& h) -> auto& { return h[i].guides.inverse_depth; });
  }
}

template <class Io, class Shares>
void each_share_number(Io& io, Shares& shares) {
  each(io, shares, &SphereCoverage::sphere, &SphereCoverage::weight);
  for (int k = 0; k < 3; ++k) each(io, shares, element(&SphereCoverage::light, k));
  each(io, shares, &SphereCoverage::front, &SphereCoverage::back);
}

template <class Io, class Work>
void each_number_of_work(Io& io, Work& work) {
  io.number(work.paths);
  io.number(work.rays);
  io.number(work.bad_samples);
  io.number(work.seconds);
}

const auto itself = [](auto& v) -> auto& { return v; };

/// Reads or writes all per-pixel numbers in file order, except sphere coverage, whose count varies by pixel.
template <class Io, class P>
void each_pixel_number(Io& io, P& partial) {
  each_sum(io, partial.film.sums());
  if (partial.is_adaptive()) {
    each_sum(io, partial.second.sums());
    io.numbers(partial.largest, itself);
  }
  io.numbers(partial.counts, itself);
  if (!partial.goals.empty()) io.numbers(partial.goals, itself);
  if (!partial.layers.empty()) each_layer_number(io, partial.layers);
  if (!partial.halves.empty()) each_half_number(io, partial.halves);
}

void write_light(Writer& out, const std::vector<LayerPixel>& layers) {
  static const kernel::Int128 zero = 0;  // a pixel without light events has no sums
  std::size_t cells = 0;
  for (const LayerPixel& p : layers) cells = std::max(cells, p.light.size());
  out.number(static_cast<std::uint32_t>(cells));
  for (std::size_t i = 0; i < cells; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      out.numbers(
          layers, [=](auto& p) -> auto& { return i < p.light.size() ? p.light[i][k] : zero; });
}

void read_light(Reader& in, std::vector<LayerPixel>& layers) {
  std::uint32_t cells = 0;
  in.number(cells);
  if (cells > base::kMaxLightGroups * kernel::kLobes) throw base::Error(base::ErrorKind::kBadData, kInconsistent);
  // Each plane has two words at least: a damaged count fails here, before allocation.
  in.need(cells * 3 * 2 * kWords<kernel::Int128>);
  for (LayerPixel& p : layers) p.light.resize(cells);
  for (std::size_t i = 0; i < cells; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      in.numbers(
          layers, [=](auto& p) -> auto& { return p.light[i][k]; });
}

void write_shares(Writer& out, const Partial& partial) {
  std::vector<std::uint32_t> counts;
  std::vector<SphereCoverage> shares;
  for (const LayerPixel& p : partial.layers) {
    counts.push_back(static_cast<std::uint32_t>(p.shares.size()));
    shares.insert(shares.end(), p.shares.begin(), p.shares.end());
  }
  out.numbers(counts, itself);
  each_share_number(out, shares);
}

void read_shares(Reader& in, Partial& partial) {
  std::vector<std::uint32_t> counts(partial.layers.size());
  in.numbers(counts, itself);
  std::size_t total = 0;
  for (const std::uint32_t n : counts) total += n;
  // The spheres of a pixel are distinct, so their plane is not constant: a damaged count fails here, before allocation.
  if (total > partial.layers.size()) in.need(total);
  std::vector<SphereCoverage> shares(total);
  each_share_number(in, shares);
  auto next = shares.begin();
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const auto end = next + static_cast<std::ptrdiff_t>(counts[i]);
    partial.layers[i].shares.assign(next, end);
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
  const std::uint32_t flags = (partial.is_adaptive() ? kHasSecond : 0u) | (partial.goals.empty() ? 0u : kHasGoals) |
                              (partial.layers.empty() ? 0u : kHasLayers) | (partial.halves.empty() ? 0u : kHasHalves);
  for (const std::uint32_t v : {kFormat, static_cast<std::uint32_t>(partial.film.width()),
                                static_cast<std::uint32_t>(partial.film.height()), flags})
    out.number(v);
  each_number_of_work(out, partial.work);
  each_pixel_number(out, partial);
  if (!partial.layers.empty()) write_light(out, partial.layers);
  if (!partial.layers.empty()) write_shares(out, partial);
  return words;
}

Partial from_words(const std::vector<std::uint32_t>& words, int width_px, int height_px) {
  Reader in(words);
  std::uint32_t format = 0, width = 0, height = 0, flags = 0;
  for (std::uint32_t* v : {&format, &width, &height, &flags}) in.number(*v);
  if (format != kFormat || flags > kAllFlags)
    throw base::Error(base::ErrorKind::kBadData, "this version of orrery does not know the format of its sample data");
  if (width != static_cast<std::uint32_t>(width_px) || height != static_cast<std::uint32_t>(height_px))
    throw base::Error(base::ErrorKind::kBadData, "it is " + std::to_string(width) + " x " + std::to_string(height) +
                                                     " pixels, not " + std::to_string(width_px) + " x " +
                                                     std::to_string(height_px));
  Partial partial(width_px, height_px);
  if ((flags & kHasSecond) != 0) partial.add_second_half();
  if ((flags & kHasGoals) != 0) partial.goals.resize(partial.pixel_count());
  if ((flags & kHasLayers) != 0) partial.layers.resize(partial.pixel_count());
  if ((flags & kHasHalves) != 0) partial.halves.resize(partial.pixel_count());
  each_number_of_work(in, partial.work);
  each_pixel_number(in, partial);
  const auto is_valid = [](float v) { return v >= 0 && v <= 3 * static_cast<float>(kernel::kLargestSample); };
  if (!std::all_of(partial.largest.begin(), partial.largest.end(), is_valid))
    throw base::Error(base::ErrorKind::kBadData, kInconsistent);
  if (!partial.layers.empty()) read_light(in, partial.layers);
  if (!partial.layers.empty()) read_shares(in, partial);
  return partial;
}

}  // namespace orrery::film
