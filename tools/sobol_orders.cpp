// SPDX-License-Identifier: Apache-2.0
// Searches the matrices of src/kernel/sobol_columns.h, kSobolOrders, and prints them. Takes two minutes.
//   c++ -std=c++20 -O2 -Isrc tools/sobol_orders.cpp -o build/sobol_orders && build/sobol_orders
//
// Vertex v of a path uses the points of one two-dimensional sequence in the order index -> A_v index, where A_v is a
// matrix over GF(2). All A_v together define one digital net with twice as many dimensions as vertices; the search also
// makes numbers of different vertices jointly well distributed. The cost function is the closed-form variance of
// scrambled nets: over all scramblings, two points whose coordinates share l leading digits have the covariance k(l) of
// a random function with independent wavelets, and dimensions multiply as prod (1 + weight k(l)). The covariance
// depends only on the difference of two indices, so 2^m points cost 2^m terms.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <random>
#include <vector>

#include "kernel/sobol_columns.h"

namespace {

using orrery::kernel::kSobolBits;
using orrery::kernel::kSobolColumns;
using orrery::kernel::kSobolFreeBits;
using orrery::kernel::kSobolVertices;
using orrery::kernel::SobolOrder;

constexpr int kJudgedBits = 10;  ///< nets of 4 to 1024 points count
constexpr int kJudged = 1 << kJudgedBits;

/// Weight of a vertex relative to the previous one; the camera has weight 1.
constexpr double kDecay = 0.6;
/// Cost, in factors of e in the variance, of a product of two vertices with twice the variance of independent numbers.
constexpr double kExcess = 1;
constexpr int kStarts = 12, kFirstTries = 750, kSteps = 3000, kMaxFailures = 800;

/// Distribution of an integrand's variance over the digits.
enum class Kind { kSmooth, kRough };
double covariance(Kind kind, int shared_digits) {
  return kind == Kind::kSmooth ? 1 - 1.75 * std::pow(0.25, shared_digits) : 1 - 1.5 * std::pow(0.5, shared_digits);
}

/// A coordinate in one of the first four Sobol dimensions, with its bits in reverse order.
std::uint32_t coordinate(int dimension, std::uint32_t at) {
  if (dimension == 0) return at;
  std::uint32_t out = 0;
  for (std::size_t j = 0; j < kSobolBits; ++j) {
    if ((at >> j & 1) == 0) continue;
    if (dimension == 1) {
      // (1 + t)^j over GF(2).
      for (std::size_t i = 0; i <= j; ++i) out ^= ((i & j) == i ? 1u : 0u) << i;
    } else {
      out ^= dimension == 2 ? kSobolColumns.third[j] : kSobolColumns.fourth[j];
    }
  }
  return out;
}

std::uint32_t apply(const SobolOrder& order, std::uint32_t index) {
  std::uint32_t out = 0;
  for (std::size_t j = 0; j < kSobolBits; ++j)
    if ((index >> j & 1) != 0) out ^= order[j];
  return out;
}

/// Whether the submatrix of the first `bits` rows and columns is invertible.
bool is_invertible(const SobolOrder& order, std::size_t bits) {
  std::vector<std::uint32_t> rows(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(bits));
  for (std::size_t bit = 0; bit < bits; ++bit) {
    std::size_t pivot = bit;
    while (pivot < bits && (rows[pivot] >> bit & 1) == 0) ++pivot;
    if (pivot == bits) return false;
    std::swap(rows[bit], rows[pivot]);
    for (std::size_t i = 0; i < bits; ++i)
      if (i != bit && (rows[i] >> bit & 1) != 0) rows[i] ^= rows[bit];
  }
  return true;
}

using Covariances = std::vector<double>;  ///< indexed by the difference of two indices

Covariances covariances(const SobolOrder& order, int dimension, Kind kind) {
  double by_digits[33];
  for (int l = 0; l <= 32; ++l) by_digits[l] = covariance(kind, l);
  Covariances out(kJudged);
  for (std::uint32_t d = 0; d < kJudged; ++d)
    out[d] = by_digits[std::countr_zero(coordinate(dimension, apply(order, d)))];
  return out;
}

/// Product of the covariances of all dimensions so far.
struct Net {
  Covariances product = Covariances(kJudged, 1.0);
  double independent = 1;  ///< the same for independent points

  void add(const Covariances& dimension, double weight) {
    for (std::size_t d = 0; d < kJudged; ++d) product[d] *= 1 + weight * dimension[d];
    independent *= 1 + weight;
  }
};

class Search {
 public:
  Search() {
    SobolOrder plain{};
    for (std::size_t j = 0; j < kSobolBits; ++j) plain[j] = 1u << j;
    for (int dimension = 0; dimension < 4; ++dimension) {
      const Covariances c = covariances(plain, dimension, Kind::kRough);
      with_lens_.add(c, 1);
      if (dimension < 2) pinhole_.add(c, 1);
      if (dimension < 2) earlier_.push_back(covariances(plain, dimension, Kind::kSmooth));
    }
    orders_.push_back(plain);
  }

  void run() {
    const Search camera_only = *this;
    for (double weight = kDecay; orders_.size() < kSobolVertices; weight *= kDecay) {
      const SobolOrder order = best(2, weight, Kind::kSmooth, kSobolFreeBits);
      for (int dimension = 0; dimension < 2; ++dimension) {
        const Covariances c = covariances(order, dimension, Kind::kSmooth);
        with_lens_.add(c, weight);
        pinhole_.add(c, weight);
        earlier_.push_back(c);
      }
      orders_.push_back(order);
    }
    // A path's time matters most in combination with the camera's numbers, also at few samples: no free bits.
    with_lens_ = camera_only.with_lens_;
    pinhole_ = camera_only.pinhole_;
    earlier_ = camera_only.earlier_;
    orders_.push_back(best(1, 1, Kind::kRough, 0));
    add_second_points(camera_only);
    for (const SobolOrder& order : orders_) {
      std::printf("    {");
      for (std::size_t j = 0; j < kSobolBits; ++j) std::printf("%s%#x", j == 0 ? "" : ", ", order[j]);
      std::printf("},\n");
    }
  }

 private:
  /// A vertex's second point goes together with the numbers that have led there, the camera's and those of the first
  /// points of the vertices before; and it must not go wrong together with any other.
  void add_second_points(const Search& camera_only) {
    const auto first_orders = orders_;
    with_lens_ = camera_only.with_lens_;
    pinhole_ = camera_only.pinhole_;
    earlier_.clear();
    for (std::size_t vertex = 0; vertex < kSobolVertices; ++vertex)
      for (int dimension = 0; dimension < 2; ++dimension)
        earlier_.push_back(covariances(first_orders[vertex], dimension, Kind::kSmooth));
    double weight = kDecay;
    for (std::size_t vertex = 0; vertex < kSobolVertices; ++vertex) {
      const SobolOrder order = best(2, 1, Kind::kSmooth, kSobolFreeBits);
      for (int dimension = 0; dimension < 2; ++dimension) {
        earlier_.push_back(covariances(order, dimension, Kind::kSmooth));
        if (vertex == 0) continue;
        const Covariances c = covariances(first_orders[vertex], dimension, Kind::kSmooth);
        with_lens_.add(c, weight);
        pinhole_.add(c, weight);
      }
      if (vertex > 0) weight *= kDecay;
      orders_.push_back(order);
    }
  }

  /// Of nets of 4 .. 1024 points: the sum of the logarithms of their variances, with and without a lens, each relative
  /// to independent points. And what products of two numbers of different vertices vary more than independent ones.
  double cost(const SobolOrder& order, int dimensions, double weight, Kind kind, double most) const {
    Covariances own(kJudged, 1.0);
    double one = 1;
    for (int k = 0; k < dimensions; ++k) {
      const Covariances c = covariances(order, k, kind);
      for (std::size_t d = 0; d < kJudged; ++d) own[d] *= 1 + weight * c[d];
      one *= 1 + weight;
    }
    double out = 0, with_lens = 0, pinhole = 0;
    std::size_t d = 0;
    for (int bits = 0; bits <= kJudgedBits; ++bits) {
      for (; d < std::size_t{1} << bits; ++d) {
        with_lens += with_lens_.product[d] * own[d] - 1;
        pinhole += pinhole_.product[d] * own[d] - 1;
      }
      const double variances = std::log(with_lens / (with_lens_.independent * one - 1)) +
                               std::log(pinhole / (pinhole_.independent * one - 1));
      if (bits >= 2) out += variances * (bits == 2 ? 0.5 : 1);
    }
    return out < most ? out + excess_of_products(order, dimensions) : out;
  }

  double excess_of_products(const SobolOrder& order, int dimensions) const {
    std::vector<Covariances> own;
    for (int k = 0; k < dimensions; ++k) own.push_back(covariances(order, k, Kind::kSmooth));
    double out = 0;
    for (std::size_t vertex = 0; vertex < earlier_.size(); vertex += 2) {  // two dimensions each
      double sum = 0;
      std::size_t d = 0;
      for (int bits = 0; bits <= kJudgedBits; ++bits) {
        for (; d < std::size_t{1} << bits; ++d)
          for (const Covariances& c : own) sum += c[d] * (earlier_[vertex][d] + earlier_[vertex + 1][d]);
        if (bits >= 2) out += std::max(0.0, sum / (2 * dimensions) - 1);
      }
    }
    return kExcess * out;
  }

  SobolOrder random_order(std::size_t free_bits) {
    SobolOrder out;
    do {
      for (std::size_t j = 0; j < kSobolBits; ++j)
        out[j] = j < free_bits ? chance() & ((1u << free_bits) - 1) : 1u << j | (chance() & ((1u << j) - 1));
    } while (!is_invertible(out, free_bits));
    return out;
  }

  /// Flips up to three random bits.
  void change(SobolOrder& order, std::size_t free_bits) {
    for (auto n = 1 + chance() % 3; n > 0; --n) {
      const std::size_t j = chance() % kJudgedBits;
      if (const std::size_t below = j < free_bits ? free_bits : j; below > 0) order[j] ^= 1u << (chance() % below);
    }
  }

  /// The best order of kStarts hill climbs.
  SobolOrder best(int dimensions, double weight, Kind kind, std::size_t free_bits) {
    SobolOrder out{};
    double lowest = HUGE_VAL;
    for (int start = 0; start < kStarts; ++start) {
      SobolOrder here{};
      double at = HUGE_VAL;
      const auto take_if_better = [&](const SobolOrder& order) {
        const double c = cost(order, dimensions, weight, kind, at);
        if (c >= at) return false;
        at = c;
        here = order;
        return true;
      };
      for (int i = 0; i < kFirstTries; ++i) take_if_better(random_order(free_bits));
      for (int i = 0, failures = 0; i < kSteps && failures < kMaxFailures; ++i) {
        SobolOrder next = here;
        change(next, free_bits);
        if (!is_invertible(next, free_bits)) continue;
        failures = take_if_better(next) ? 0 : failures + 1;
      }
      if (at < lowest) {
        lowest = at;
        out = here;
      }
    }
    return out;
  }

  std::uint32_t chance() { return static_cast<std::uint32_t>(random_()); }

  std::mt19937 random_{11};
  Net with_lens_, pinhole_;
  std::vector<Covariances> earlier_;  ///< of all dimensions of earlier vertices
  std::vector<SobolOrder> orders_;
};

}  // namespace

int main() { Search().run(); }
