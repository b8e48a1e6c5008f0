// SPDX-License-Identifier: Apache-2.0
#include "film/partial.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <string>
#include <type_traits>

#include "base/error.h"
#include "base/image_limits.h"
#include "film/film.h"
#include "film/layer_pixel.h"
#include "film/layers.h"

namespace orrery::film {
namespace {

using kernel::Int128;

constexpr std::uint32_t kFormat = 6;

enum Flag : std::uint32_t { kHasSecond = 1, kHasGoals = 2, kHasLayers = 4, kHasHalves = 8, kAllFlags = 15 };

std::uint32_t bits(float v) { return std::bit_cast<std::uint32_t>(v); }
std::uint64_t bits(std::uint64_t v) { return v; }
std::uint64_t bits(std::int64_t v) { return static_cast<std::uint64_t>(v); }
std::uint64_t bits(double v) { return std::bit_cast<std::uint64_t>(v); }

/// Header word of a plane: kConstant is followed by one word for all pixels, kPlane by one word per pixel.
constexpr std::uint32_t kConstant = 0, kPlane = 1;

constexpr const char* kInconsistent = "its sample data are inconsistent";

/// Appends numbers as 32-bit words, least significant first.
class Writer {
 public:
  explicit Writer(std::vector<std::uint32_t>& out) : out_(out) {}

  void number(const std::uint32_t& v) { out_.push_back(v); }
  template <class T>
  void number(const T& v) {
    if constexpr (sizeof(T) == sizeof(Int128)) {
      for (int w = 0; w < 4; ++w) out_.push_back(word(v, w));
    } else {
      for (int w = 0; w < 2; ++w) out_.push_back(static_cast<std::uint32_t>(bits(v) >> 32 * w));
    }
  }
  /// Appends one number of every element of `things`, as one plane per word of the number.
  template <class Things, class At>
  void numbers(Things& things, At at) {
    using T = std::remove_reference_t<decltype(at(things[0]))>;
    constexpr int kWords = sizeof(T) / sizeof(std::uint32_t);
    for (int w = 0; w < kWords && !things.empty(); ++w) {
      const std::uint32_t first = word(at(things[0]), w);
      bool is_constant = true;
      for (auto& thing : things) is_constant = is_constant && word(at(thing), w) == first;
      out_.push_back(is_constant ? kConstant : kPlane);
      if (is_constant) {
        out_.push_back(first);
      } else {
        for (auto& thing : things) out_.push_back(word(at(thing), w));
      }
    }
  }

 private:
  static std::uint32_t word(std::uint32_t v, int) { return v; }
  static std::uint32_t word(float v, int) { return bits(v); }
  template <class T>
  static std::uint32_t word(const T& v, int w) {
    if constexpr (sizeof(T) == sizeof(Int128)) {
      return static_cast<std::uint32_t>(v >> 32 * w);
    } else {
      return static_cast<std::uint32_t>(bits(v) >> 32 * w);
    }
  }

  std::vector<std::uint32_t>& out_;
};

/// Reads numbers that Writer appended.
class Reader {
 public:
  explicit Reader(const std::vector<std::uint32_t>& in) : in_(in) {}

  void number(std::uint32_t& v) {
    need(1);
    v = in_[at_++];
  }
  void number(std::uint64_t& v) { v = take64(); }
  void number(double& v) { v = std::bit_cast<double>(take64()); }

  template <class Things, class At>
  void numbers(Things& things, At at) {
    using T = std::remove_reference_t<decltype(at(things[0]))>;
    constexpr std::size_t kWords = sizeof(T) / sizeof(std::uint32_t);
    if (things.empty()) return;
    const std::uint32_t* planes[kWords];
    std::size_t steps[kWords];
    for (std::size_t w = 0; w < kWords; ++w) {
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
      std::uint32_t words[kWords];
      for (std::size_t w = 0; w < kWords; ++w) {
        words[w] = *planes[w];
        planes[w] += steps[w];
      }
      at(thing) = joined<T>(words);
    }
  }

  void need(std::size_t words) const {
    if (in_.size() - at_ < words) throw base::Error(base::ErrorKind::kBadData, "its sample data are truncated");
  }

 private:
  template <class T>
  static T joined(const std::uint32_t* words) {
    if constexpr (sizeof(T) == sizeof(std::uint32_t)) {
      return std::bit_cast<T>(words[0]);
    } else if constexpr (sizeof(T) == sizeof(Int128)) {
      __extension__ using Unsigned = unsigned __int128;
      Unsigned v = 0;
      for (int w = 4; w-- > 0;) v = v << 32 | words[w];
      return static_cast<Int128>(v);
    } else {
      return std::bit_cast<T>(std::uint64_t{words[1]} << 32 | words[0]);
    }
  }
  std::uint64_t take64() {
    need(2);
    at_ += 2;
    return std::uint64_t{in_[at_ - 1]} << 32 | in_[at_ - 2];
  }

  const std::vector<std::uint32_t>& in_;
  std::size_t at_ = 0;
};

template <class Io, class Sums>
void each_sum(Io& io, Sums& sums) {
  for (int c = 0; c < 3; ++c)
    io.numbers(
        sums, [c](auto& s) -> auto& { return s.rgb[c]; });
  io.numbers(
      sums, [](auto& s) -> auto& { return s.weight; });
}

template <class Io, class Layers>
void each_layer_number(Io& io, Layers& layers) {
  for (int k = 0; k < 3; ++k) {
    io.numbers(
        layers, [k](auto& p) -> auto& { return p.squares[k]; });
    io.numbers(
        layers, [k](auto& p) -> auto& { return p.negative_light[k]; });
    io.numbers(
        layers, [k](auto& p) -> auto& { return p.negative_squares[k]; });
    io.numbers(
        layers, [k](auto& p) -> auto& { return p.normal[k]; });
    io.numbers(
        layers, [k](auto& p) -> auto& { return p.albedo[k]; });
    io.numbers(
        layers, [k](auto& p) -> auto& { return p.position[k]; });
  }
  io.numbers(
      layers, [](auto& p) -> auto& { return p.weight; });
  io.numbers(
      layers, [](auto& p) -> auto& { return p.lit; });
  io.numbers(
      layers, [](auto& p) -> auto& { return p.paths; });
  io.numbers(
      layers, [](auto& p) -> auto& { return p.covered; });
  io.numbers(
      layers, [](auto& p) -> auto& { return p.depth; });
  io.numbers(
      layers, [](auto& p) -> auto& { return p.z; });
  io.numbers(
      layers, [](auto& p) -> auto& { return p.sphere; });
}

template <class Io, class Halves>
void each_half_number(Io& io, Halves& halves) {
  for (std::size_t i = 0; i < 2; ++i) {
    for (int k = 0; k < 3; ++k) {
      io.numbers(
          halves, [=](auto& h) -> auto& { return h[i].light.rgb[k]; });
      io.numbers(
          halves, [=](auto& h) -> auto& { return h[i].guides.albedo[k]; });
      io.numbers(
          halves, [=](auto& h) -> auto& { return h[i].guides.normal[k]; });
    }
    io.numbers(
        halves, [=](auto& h) -> auto& { return h[i].light.weight; });
    io.numbers(
        halves, [=](auto& h) -> auto& { return h[i].guides.weight; });
    io.numbers(
        halves, [=](auto& h) -> auto& { return h[i].guides.inverse_depth; });
  }
}

template <class Io, class Shares>
void each_share_number(Io& io, Shares& shares) {
  io.numbers(
      shares, [](auto& s) -> auto& { return s.sphere; });
  io.numbers(
      shares, [](auto& s) -> auto& { return s.weight; });
  for (int k = 0; k < 3; ++k)
    io.numbers(
        shares, [k](auto& s) -> auto& { return s.light[k]; });
  io.numbers(
      shares, [](auto& s) -> auto& { return s.front; });
  io.numbers(
      shares, [](auto& s) -> auto& { return s.back; });
}

template <class Io, class EffortType>
void each_effort(Io& io, EffortType& work) {
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
  static const Int128 zero = 0;  // a pixel without light events has no sums
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
  in.need(cells * std::size_t{3 * 2 * sizeof(Int128) / sizeof(std::uint32_t)});
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
  each_effort(out, partial.work);
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
  each_effort(in, partial.work);
  each_pixel_number(in, partial);
  const auto is_valid = [](float v) { return v >= 0 && v <= 3 * static_cast<float>(kernel::kLargestSample); };
  if (!std::all_of(partial.largest.begin(), partial.largest.end(), is_valid))
    throw base::Error(base::ErrorKind::kBadData, kInconsistent);
  if (!partial.layers.empty()) read_light(in, partial.layers);
  if (!partial.layers.empty()) read_shares(in, partial);
  return partial;
}

}  // namespace orrery::film
