// SPDX-License-Identifier: Apache-2.0
#include "render/allocation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>

#include "base/stop_point.h"

namespace orrery::render {
namespace {

/// Minimum number of samples that an iteration adds, as a fraction of the existing ones, since choosing pixels also
/// takes time.
constexpr double kMinIteration = 1.0 / 64;

/// A histogram of pixels by gain: how much their next sample reduces the image's squared error. Sixteen linear steps
/// per octave from the number's exponent and fraction, since logarithms of different libraries differ in the last bit,
/// and images would differ as well.
class Ranking {
 public:
  static constexpr int kStepsPerOctave = 16;
  static constexpr int kBins = 160 * kStepsPerOctave;

  static constexpr double kMinGain = 0x1p-130;

  /// The bin of a gain, ascending; -1 for gains of kMinGain and below.
  static int bin_of(double gain) {
    if (!(gain > kMinGain)) return -1;
    int octave = 0;
    const double fraction = std::frexp(gain / kMinGain, &octave);  // 0.5 .. 1
    return std::min((octave - 1) * kStepsPerOctave + static_cast<int>((2 * fraction - 1) * kStepsPerOctave), kBins - 1);
  }
  static double gain_of(int bin) {
    const double step = static_cast<double>(bin % kStepsPerOctave) / kStepsPerOctave;
    return std::ldexp((1 + step) * kMinGain, bin / kStepsPerOctave);
  }

  struct Bin {
    double error = 0;         ///< sum of the pixels' current squared errors
    double root = 0;          ///< sum of the roots of the squared errors of one sample
    double samples = 0;       ///< number of samples of its pixels
    std::uint64_t price = 0;  ///< samples needed to double them
  };
  std::array<Bin, kBins> bins{};
};

/// Adds the pixels without a reliable error estimate if all of them are affordable.
void add_unreliable_pixels(std::span<const std::uint32_t> samples, const std::vector<std::uint8_t>& is_unreliable,
                           const IterationGoal& goal, PixelSelection& selection) {
  const auto price_of = [&](std::size_t i) {
    return std::uint64_t{std::min(samples[i], goal.max_per_pixel - samples[i])};
  };
  std::uint64_t chosen = 0, due = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (selection.chosen[i]) {
      chosen += price_of(i);
    } else if (is_unreliable[i] != 0) {
      due += price_of(i);
    }
  }
  if (due == 0 || due > goal.affordable - std::min(chosen, goal.affordable)) return;
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (is_unreliable[i] != 0 && price_of(i) > 0) selection.chosen[i] = true;
  selection.any = true;
  selection.samples_to_goal = std::max(selection.samples_to_goal, static_cast<double>(chosen + due));
}

}  // namespace

PixelSelection choose_pixels(std::span<const std::uint32_t> samples, const std::vector<float>& error_of_one_sample,
                             const std::vector<std::uint8_t>& is_unreliable, const IterationGoal& goal) {
  PixelSelection selection;
  auto ranking = std::make_unique<Ranking>();
  std::vector<std::int16_t> bin_of(samples.size(), -1);
  double error = 0;  // sum of the squared errors of all pixels
  double all = 0;    // samples
  const base::StopPoint stop;
  for (std::size_t i = 0; i < bin_of.size(); ++i) {
    stop.check(i);
    const auto n = static_cast<double>(samples[i]);
    const auto s = static_cast<double>(error_of_one_sample[i]);
    error += s / n;
    all += n;
    const int bin = Ranking::bin_of(s / (n * n));
    if (bin < 0) continue;
    if (samples[i] >= goal.max_per_pixel) {
      selection.limited_by_pixels = true;
      continue;
    }
    bin_of[i] = static_cast<std::int16_t>(bin);
    Ranking::Bin& b = ranking->bins[static_cast<std::size_t>(bin)];
    b.error += s / n;
    b.root += std::sqrt(s);
    b.samples += n;
    b.price += std::min(samples[i], goal.max_per_pixel - samples[i]);
  }
  const double wanted = error * goal.error_ratio;

  // From the largest gain down: find the level at which the goal is reached if all pixels above are sampled down to it,
  // and how far doubling leads.
  double left = error, roots = 0, had = 0, after_doubling = error;
  std::uint64_t price = 0;
  int level = 0, doubling = Ranking::kBins, affordable = Ranking::kBins;
  bool level_found = false;
  for (int k = Ranking::kBins - 1; k >= 0; --k) {
    const Ranking::Bin& b = ranking->bins[static_cast<std::size_t>(k)];
    if (after_doubling > wanted || (doubling < Ranking::kBins && static_cast<double>(price) < all * kMinIteration)) {
      doubling = k;
      after_doubling -= b.error / 2;
    }
    price += b.price;
    if (price <= goal.affordable) affordable = k;
    left -= b.error;
    roots += b.root;
    had += b.samples;
    const double root_of_level = std::sqrt(Ranking::gain_of(k));
    if (!level_found && (left + roots * root_of_level <= wanted || k == 0)) {
      level = k;
      level_found = true;
      selection.samples_to_goal = std::max(0.0, roots / root_of_level - had);
    }
    if (level_found && after_doubling <= wanted && static_cast<double>(price) >= all * kMinIteration) break;
  }
  // Pixels that need less than 1.4 times their samples wait unless there are no others.
  const int worth_doubling = std::min(level + Ranking::kStepsPerOctave, Ranking::kBins - 1);
  const auto choose_from = [&](int lowest) {
    selection.chosen.assign(bin_of.size(), false);
    for (std::size_t i = 0; i < bin_of.size(); ++i)
      if (bin_of[i] >= lowest) selection.chosen[i] = selection.any = true;
  };
  choose_from(std::max({worth_doubling, doubling, affordable}));
  if (!selection.any) choose_from(std::max(doubling, affordable));
  add_unreliable_pixels(samples, is_unreliable, goal, selection);
  return selection;
}

}  // namespace orrery::render
