// SPDX-License-Identifier: Apache-2.0
#include "render/allocation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>

namespace orrery::render {
namespace {

constexpr int kReach = 2;  ///< px, of the square in which errors are averaged, to each side

/// Squared errors of one sample, each the mean over the square around its pixel.
std::vector<float> averaged(const PixelErrors& e) {
  const auto at = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(e.width) + static_cast<std::size_t>(x);
  };
  std::vector<float> along(e.squared.size()), out(e.squared.size());
  for (int y = 0; y < e.height; ++y) {
    for (int x = 0; x < e.width; ++x) {
      float sum = 0;
      for (int k = std::max(x - kReach, 0); k <= std::min(x + kReach, e.width - 1); ++k)
        sum += e.squared[at(k, y)] * static_cast<float>(e.samples[at(k, y)]);
      along[at(x, y)] = sum / static_cast<float>(std::min(x + kReach, e.width - 1) - std::max(x - kReach, 0) + 1);
    }
  }
  for (int y = 0; y < e.height; ++y) {
    const int first = std::max(y - kReach, 0), last = std::min(y + kReach, e.height - 1);
    for (int x = 0; x < e.width; ++x) {
      float sum = 0;
      for (int k = first; k <= last; ++k) sum += along[at(x, k)];
      out[at(x, y)] = sum / static_cast<float>(last - first + 1);
    }
  }
  return out;
}

/// Pixels by what their next sample takes away of the picture's squared error, in sixteen even steps to an octave. Of
/// a number's own exponent and fraction, since a library's logarithm may differ in its last bit, and with it pictures.
class Ranking {
 public:
  static constexpr int kStepsPerOctave = 16;
  static constexpr int kBins = 160 * kStepsPerOctave;

  static constexpr double kLeast = 0x1p-130;

  /// The bin of a gain; the larger, the more. Gains of kLeast and less are none.
  static int bin_of(double gain) {
    if (!(gain > kLeast)) return -1;
    int octave = 0;
    const double fraction = std::frexp(gain / kLeast, &octave);  // 0.5 .. 1
    return std::min((octave - 1) * kStepsPerOctave + static_cast<int>((2 * fraction - 1) * kStepsPerOctave), kBins - 1);
  }
  static double gain_of(int bin) {
    const double step = static_cast<double>(bin % kStepsPerOctave) / kStepsPerOctave;
    return std::ldexp((1 + step) * kLeast, bin / kStepsPerOctave);
  }

  struct Bin {
    double error = 0;         ///< squared, of its pixels as they are
    double root = 0;          ///< of the squared errors of one sample, added up
    double samples = 0;       ///< that its pixels have had
    std::uint64_t price = 0;  ///< samples that doubling costs
  };
  std::array<Bin, kBins> bins{};
};

}  // namespace

double PixelErrors::sum() const {
  double sum = 0;
  for (const float e : squared) sum += static_cast<double>(e);
  return sum;
}

Round choose_pixels(const PixelErrors& errors, const RoundGoal& goal) {
  const std::vector<float> of_one_sample = averaged(errors);
  Round round;
  auto ranking = std::make_unique<Ranking>();
  std::vector<std::int16_t> bin_of(of_one_sample.size(), -1);
  double told = 0;  // by the averages; its pixels' own errors add up to nearly the same
  for (std::size_t i = 0; i < bin_of.size(); ++i) {
    const auto n = static_cast<double>(errors.samples[i]);
    const auto s = static_cast<double>(of_one_sample[i]);
    told += s / n;
    const int bin = Ranking::bin_of(s / (n * n));
    if (bin < 0) continue;
    if (errors.samples[i] >= goal.most_per_pixel) {
      round.limited_by_pixels = true;
      continue;
    }
    bin_of[i] = static_cast<std::int16_t>(bin);
    Ranking::Bin& b = ranking->bins[static_cast<std::size_t>(bin)];
    b.error += s / n;
    b.root += std::sqrt(s);
    b.samples += n;
    b.price += std::min(errors.samples[i], goal.most_per_pixel - errors.samples[i]);
  }
  // The averages are scaled to what the pixels themselves say, for that is what the goal is about.
  const double sum = errors.sum();
  const double wanted = sum > 0 ? goal.squared_sum * told / sum : 0;

  // Down from the pixels with the largest gain: where the level lies at which the goal is reached if all above it go
  // on until they are down at it, and how far doubling leads.
  double left = told, roots = 0, had = 0, after_doubling = told;
  std::uint64_t price = 0;
  int level = 0, doubling = Ranking::kBins, affordable = Ranking::kBins;
  bool level_found = false;
  for (int k = Ranking::kBins - 1; k >= 0; --k) {
    const Ranking::Bin& b = ranking->bins[static_cast<std::size_t>(k)];
    if (price + b.price <= goal.affordable) affordable = k;
    price += b.price;
    if (after_doubling > wanted) {
      doubling = k;
      after_doubling -= b.error / 2;
    }
    left -= b.error;
    roots += b.root;
    had += b.samples;
    const double root_of_level = std::sqrt(Ranking::gain_of(k));
    if (!level_found && (left + roots * root_of_level <= wanted || k == 0)) {
      level = k;
      level_found = true;
      round.samples_to_goal = std::max(0.0, roots / root_of_level - had);
    }
    if (level_found && after_doubling <= wanted) break;
  }
  // Pixels that need less than 1.4 times their samples wait, unless there are no others.
  const int worth_doubling = std::min(level + Ranking::kStepsPerOctave, Ranking::kBins - 1);
  const auto choose_from = [&](int lowest) {
    round.chosen.assign(bin_of.size(), false);
    for (std::size_t i = 0; i < bin_of.size(); ++i)
      if (bin_of[i] >= lowest) round.chosen[i] = round.any = true;
  };
  choose_from(std::max({worth_doubling, doubling, affordable}));
  if (!round.any) choose_from(std::max(doubling, affordable));
  return round;
}

}  // namespace orrery::render
