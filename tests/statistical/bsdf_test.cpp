// SPDX-License-Identifier: Apache-2.0
// Samples of each BSDF against the integral of its density over bins, and the density against its closed form in
// long double.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "kernel/scatter-inl.h"
#include "support/chi_square.h"

namespace orrery::test {
/// A surface interaction at the top of a unit sphere, with the incident ray in the plane z = 0; the normal is +y.
struct Interaction {
  kernel::MaterialKind kind = kernel::MaterialKind::kLambertian;
  double fuzz = 0;
  double cos_arriving = 1;
  bool from_outside = true;
  bool coat = false;  ///< of plastic: samples and density of the coat, otherwise those of the base
};
/// Directions and what is known of each, in rows.
struct Directions {
  std::vector<double> x, y, z, pdf;
  std::vector<bool> alive;  ///< neither absorbed nor, of plastic, scattered by the other lobe
  explicit Directions(std::size_t count) : x(count), y(count), z(count), pdf(count), alive(count) {}
};
}  // namespace orrery::test

HWY_BEFORE_NAMESPACE();
namespace orrery::test::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
namespace k = kernel::HWY_NAMESPACE;

constexpr kernel::Features kAllFeatures{.hemisphere = true, .rich_materials = true};

template <class D>
k::Surface<D> surface(D d, const Interaction& interaction) {
  using T = hn::TFromD<D>;
  k::Surface<D> at;
  const double arriving[3] = {std::sqrt(1 - interaction.cos_arriving * interaction.cos_arriving),
                              -interaction.cos_arriving, 0};
  const double up[3] = {0, 1, 0}, center_to_point[3] = {0, interaction.from_outside ? 1.0 : -1.0, 0};
  at.direction = k::set3(d, arriving);
  at.normal = k::set3(d, up);
  at.offset = k::set3(d, center_to_point);
  at.from_outside = hn::FirstN(d, interaction.from_outside ? hn::Lanes(d) : 0);
  at.fuzz = hn::Set(d, static_cast<T>(interaction.fuzz));
  at.eta = hn::Set(d, static_cast<T>(1 / 1.5));
  at.r0 = hn::Set(d, static_cast<T>(0.04));
  at.kind = hn::Set(k::IdTag<D>(), static_cast<hn::TFromD<k::IdTag<D>>>(interaction.kind));
  at.fresnel = hn::Zero(k::IdTag<D>());
  return at;
}

/// Fills x, y, z and alive with samples first .. first + as many as there is room for, a multiple of 16.
void sample_all(const Interaction& interaction, std::uint32_t first, bool is_extended, Directions& out) {
  kernel::Features features = kAllFeatures;
  features.rich_materials = is_extended || interaction.kind == kernel::MaterialKind::kPlastic;
  const hn::ScalableTag<double> d;
  using D = std::remove_const_t<decltype(d)>;
  const k::IdTag<D> du;
  const auto at = surface(d, interaction);
  HWY_ALIGN double alive[hn::MaxLanes(D())];
  for (std::size_t i = 0; i < out.x.size(); i += hn::Lanes(d)) {
    const auto name = hn::Iota(du, first + i);
    const auto u = k::random_at_vertex(d, {kernel::SamplerKind::kIndependent, 3}, hn::ShiftRight<8>(name),
                                       hn::And(name, hn::Set(du, 255)), 1, false);
    const auto sampled = k::sample_bsdf(d, features, at, u);
    hn::StoreU(sampled.direction.x, d, &out.x[i]);
    hn::StoreU(sampled.direction.y, d, &out.y[i]);
    hn::StoreU(sampled.direction.z, d, &out.z[i]);
    const bool is_plastic = interaction.kind == kernel::MaterialKind::kPlastic;
    const auto other_lobe = interaction.coat ? hn::Not(sampled.in_coat) : sampled.in_coat;
    const auto kept = is_plastic ? hn::AndNot(other_lobe, sampled.alive) : sampled.alive;
    hn::Store(hn::IfThenElseZero(kept, hn::Set(d, 1.0)), d, alive);
    for (std::size_t l = 0; l < hn::Lanes(d); ++l) out.alive[i + l] = alive[l] != 0;
  }
}

void sample(const Interaction& interaction, std::uint32_t first, Directions& out) {
  sample_all(interaction, first, false, out);
}
void sample_extended(const Interaction& interaction, std::uint32_t first, Directions& out) {
  sample_all(interaction, first, true, out);
}

/// Fills pdf, in lanes of T.
template <class T>
void judge(const Interaction& interaction, Directions& out) {
  const hn::ScalableTag<T> d;
  using D = std::remove_const_t<decltype(d)>;
  const auto at = surface(d, interaction);
  HWY_ALIGN T lanes[3][hn::MaxLanes(D())];
  for (std::size_t i = 0; i < out.x.size(); i += hn::Lanes(d)) {
    for (std::size_t l = 0; l < hn::Lanes(d); ++l) {
      lanes[0][l] = static_cast<T>(out.x[i + l]);
      lanes[1][l] = static_cast<T>(out.y[i + l]);
      lanes[2][l] = static_cast<T>(out.z[i + l]);
    }
    const auto w = k::load3(d, lanes[0], lanes[1], lanes[2]);
    hn::Store(interaction.coat ? k::pdf_coat(at, w) : k::pdf_bsdf(d, kAllFeatures, at, w), d, lanes[0]);
    for (std::size_t l = 0; l < hn::Lanes(d); ++l) out.pdf[i + l] = static_cast<double>(lanes[0][l]);
  }
}
void judge_double(const Interaction& interaction, Directions& out) { judge<double>(interaction, out); }
void judge_float(const Interaction& interaction, Directions& out) { judge<float>(interaction, out); }

}  // namespace orrery::test::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace orrery::test {
namespace {

using kernel::MaterialKind;

const std::vector<Interaction>& cases() {
  static const std::vector<Interaction> list = [] {
    std::vector<Interaction> all;
    for (const double cosine : {1.0, 0.6, 0.05}) {
      for (const bool outside : {true, false}) {
        all.push_back({MaterialKind::kLambertian, 0, cosine, outside});
        all.push_back({MaterialKind::kHemisphere, 0, cosine, outside});
        for (const double fuzz : {0.001, 0.1, 0.7, 1.0}) all.push_back({MaterialKind::kMetal, fuzz, cosine, outside});
        all.push_back({MaterialKind::kPlastic, 0, cosine, outside});
        for (const double fuzz : {0.001, 0.1, 0.7, 1.0})
          all.push_back({MaterialKind::kPlastic, fuzz, cosine, outside, true});
      }
    }
    return all;
  }();
  return list;
}

bool is_around_the_mirror_direction(const Interaction& interaction) {
  return interaction.kind == MaterialKind::kMetal || interaction.coat;
}

/// The probability that plastic scatters in its coat.
double coat_share(const Interaction& interaction) { return 0.04 + 0.96 * std::pow(1 - interaction.cos_arriving, 5); }

/// The cosine of the largest angle between the mirror direction and a sample. Samples of a coat that were mirrored at
/// the surface are farther away by up to twice the elevation of the mirror direction.
double lowest_cosine(const Interaction& interaction) {
  const double fuzz2 = interaction.fuzz * interaction.fuzz;
  if (!is_around_the_mirror_direction(interaction)) return 0;
  if (!interaction.coat) return std::sqrt(1 - fuzz2);
  const double rim = std::acos(1 - 5 * fuzz2 / 3), elevation = std::asin(interaction.cos_arriving);
  return rim < elevation ? std::cos(rim) : std::cos(std::min(rim + 2 * elevation, std::numbers::pi));
}

/// Coordinates of directions: c, the cosine to the axis of the distribution, as `lowest` + (1 - lowest) v^2, which
/// takes the singularity from a fuzzy metal's rim; and the turn around the axis. Both are in 0..1.
struct Chart {
  double axis[2];  ///< x and y; z = 0
  double lowest;

  explicit Chart(const Interaction& interaction) : axis{0, 1}, lowest(lowest_cosine(interaction)) {
    if (!is_around_the_mirror_direction(interaction)) return;
    axis[0] = std::sqrt(1 - interaction.cos_arriving * interaction.cos_arriving);
    axis[1] = interaction.cos_arriving;
  }
  void direction(double v, double turn, double& x, double& y, double& z) const {
    const double versine = (1 - lowest) * (1 - v) * (1 + v), c = 1 - versine, s = std::sqrt(versine * (1 + c));
    const double along = s * std::cos(2 * std::numbers::pi * turn);
    x = axis[0] * c + axis[1] * along;
    y = axis[1] * c - axis[0] * along;
    z = s * std::sin(2 * std::numbers::pi * turn);
  }
  /// Steradians per unit of v and turn.
  double solid_angle(double v) const { return 2 * (1 - lowest) * v * 2 * std::numbers::pi; }
  void coordinates(double x, double y, double z, double& v, double& turn) const {
    const double dx = x - axis[0], dy = y - axis[1];
    const double versine = (dx * dx + dy * dy + z * z) / 2;
    v = std::sqrt(std::max(0.0, 1 - versine / (1 - lowest)));
    turn = std::atan2(z, axis[1] * x - axis[0] * y) / (2 * std::numbers::pi);
    if (turn < 0) turn += 1;
  }
};

/// The density in long double: for metal the sum over the two points at which the line along w leaves and enters the
/// sphere around the tip of the mirror direction, each t^2 / (4 pi fuzz^2 |cosine|); for the coat of plastic the sum
/// over the direction and its mirror image below the surface.
long double closed_form(const Interaction& interaction, double x, double y, double z) {
  if (y <= 0) return 0;
  const long double pi = std::numbers::pi_v<long double>;
  if (interaction.kind == MaterialKind::kLambertian) return y / pi;
  if (interaction.kind == MaterialKind::kHemisphere) return 1 / (2 * pi);
  if (interaction.kind == MaterialKind::kPlastic && !interaction.coat)
    return (1 - static_cast<long double>(coat_share(interaction))) * y / pi;
  if (interaction.fuzz == 0) return 0;
  const long double f = interaction.fuzz, my = interaction.cos_arriving,
                    mx = std::sqrt(1 - interaction.cos_arriving * interaction.cos_arriving);
  const long double length =
      std::sqrt(static_cast<long double>(x) * x + static_cast<long double>(y) * y + static_cast<long double>(z) * z);
  if (interaction.coat) {
    const long double rim = 5 * f * f / 3;
    long double sum = 0;
    for (const int side : {1, -1}) {
      const long double ex = x / length - mx, ey = side * y / length - my, ez = z / length;
      sum += std::pow(std::max(1 - (ex * ex + ey * ey + ez * ez) / 2 / rim, 0.0L), 3);
    }
    return coat_share(interaction) * 2 / (pi * rim) * sum;
  }
  const long double c = (mx * x + my * y) / length;
  const long double dx = x / length - mx, dy = y / length - my, dz = z / length;
  const long double h = dx * dx + dy * dy + dz * dz, s2 = h * (1 - h / 4);
  if (c <= 0 || s2 >= f * f) return 0;
  const long double half_chord = std::sqrt(f * f - s2);
  long double sum = 0;
  for (const long double t : {c - half_chord, c + half_chord})
    if (t > 0) sum += t * t / (4 * pi * f * f * (half_chord / f));
  return sum;
}

TEST(StatisticalBsdf, SamplesHaveTheDensity) {
  constexpr int kSide = 16, kFine = 32, kAbsorbed = kSide * kSide, kCut = kAbsorbed + 1;
  constexpr std::uint32_t kBatch = 1 << 14, kBatches = 24;
  Directions batch(kBatch), fine(kFine * kFine);
  for (const Interaction& interaction : cases()) {
    const Chart chart(interaction);
    // Two more bins: what is absorbed; and all that the surface cuts, since the midpoint rule is too rough for each.
    std::vector<double> expected(kCut + 1);
    std::vector<std::uint64_t> counts(kCut + 1);
    std::vector<std::size_t> bin_of(kAbsorbed);
    double total = 0;
    for (int bin = 0; bin < kAbsorbed; ++bin) {
      const auto v_of = [&](int i) { return (bin / kSide + (i / kFine + 0.5) / kFine) / kSide; };
      for (int i = 0; i < kFine * kFine; ++i)
        chart.direction(v_of(i), (bin % kSide + (i % kFine + 0.5) / kFine) / kSide, fine.x[i], fine.y[i], fine.z[i]);
      HWY_NAMESPACE::judge_double(interaction, fine);
      double sum = 0;
      bool is_cut = false;
      for (int i = 0; i < kFine * kFine; ++i) {
        sum += fine.pdf[i] * chart.solid_angle(v_of(i));
        is_cut = is_cut || fine.y[i] <= 0;
      }
      bin_of[bin] = is_cut ? kCut : bin;
      expected[bin_of[bin]] += sum / (kFine * kFine * kSide * kSide);
      total += sum / (kFine * kFine * kSide * kSide);
    }
    if (interaction.kind != MaterialKind::kMetal) {
      const bool is_plastic = interaction.kind == MaterialKind::kPlastic;
      const double share = !is_plastic ? 1 : interaction.coat ? coat_share(interaction) : 1 - coat_share(interaction);
      EXPECT_NEAR(total, share, is_plastic ? 3e-3 : 1e-3)
          << "fuzz " << interaction.fuzz << ", cosine " << interaction.cos_arriving;
    }
    expected[kAbsorbed] = std::max(0.0, 1 - total);
    const double samples = double{kBatch} * kBatches / (total + expected[kAbsorbed]);
    for (double& e : expected) e *= samples;
    for (std::uint32_t n = 0; n < kBatches; ++n) {
      HWY_NAMESPACE::sample(interaction, n * kBatch, batch);
      for (std::uint32_t i = 0; i < kBatch; ++i) {
        std::size_t bin = kAbsorbed;
        if (batch.alive[i]) {
          double v = 0, turn = 0;
          chart.coordinates(batch.x[i], batch.y[i], batch.z[i], v, turn);
          bin = bin_of[static_cast<std::size_t>(std::min(kSide - 1, static_cast<int>(v * kSide)) * kSide +
                                                std::min(kSide - 1, static_cast<int>(turn * kSide)))];
        }
        ++counts[bin];
      }
    }
    const ChiSquare result = chi_square(counts, expected);
    EXPECT_LT(std::abs(result.z), kLargestZ) << "kind " << static_cast<int>(interaction.kind) << ", fuzz "
                                             << interaction.fuzz << ", cosine " << interaction.cos_arriving;
  }
}

TEST(StatisticalBsdf, DensityIsTheClosedFormInBothPrecisions) {
  constexpr int kCount = 1 << 12;
  Directions at(kCount);
  std::mt19937_64 random{5};
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const Interaction& interaction : cases()) {
    const Chart chart(interaction);
    int above = 0;
    for (int i = 0; i < kCount; ++i) {
      // Most directions lie inside the cone, but for its rim, where rounding alone changes the density by much.
      chart.direction(i % 4 == 0 ? 0.1 + uniform(random) : 0.1 + 0.9 * uniform(random), uniform(random), at.x[i],
                      at.y[i], at.z[i]);
      if (i % 16 == 0) at.x[i] = -at.x[i], at.y[i] = -at.y[i];
      if (!std::isfinite(at.x[i] + at.z[i])) at.x[i] = 0, at.y[i] = -1, at.z[i] = 0;
    }
    for (const bool in_double : {true, false}) {
      (in_double ? HWY_NAMESPACE::judge_double : HWY_NAMESPACE::judge_float)(interaction, at);
      // A float's direction is off by 1e-7, and the narrowest cone is 1e-3 wide.
      const double most = in_double ? 1e-9 : interaction.fuzz < 0.01 ? 0.03 : 1e-4;
      for (int i = 0; i < kCount; ++i) {
        if (!in_double && std::abs(at.y[i]) < 1e-5) continue;
        const auto expected = static_cast<double>(closed_form(interaction, at.x[i], at.y[i], at.z[i]));
        ASSERT_NEAR(at.pdf[i], expected, most * std::max(expected, 0.05))
            << "kind " << static_cast<int>(interaction.kind) << ", fuzz " << interaction.fuzz << ", cosine "
            << interaction.cos_arriving << ", direction " << at.x[i] << ' ' << at.y[i] << ' ' << at.z[i];
        above += expected > 0;
      }
    }
    EXPECT_GT(above, kCount / 4);
  }
}

TEST(StatisticalBsdf, DeltaMaterialsHaveNoDensity) {
  Directions at(16);
  for (const Interaction& interaction :
       {Interaction{MaterialKind::kMetal, 0, 0.6}, Interaction{MaterialKind::kDielectric, 0, 0.6},
        Interaction{MaterialKind::kPlastic, 0, 0.6, true, true}}) {
    HWY_NAMESPACE::sample(interaction, 0, at);
    HWY_NAMESPACE::judge_double(interaction, at);
    EXPECT_EQ(at.pdf, std::vector<double>(16, 0.0));
  }
}

/// Means, over samples, of the cosine to an axis in the plane z = 0, its square, and the two components across it.
struct Moments {
  double count = 0, sums[4] = {};

  void add(double axis_x, double axis_y, double x, double y, double z) {
    const double c = x * axis_x + y * axis_y;
    const double values[4] = {c, c * c, x * axis_y - y * axis_x, z};
    ++count;
    for (int k = 0; k < 4; ++k) sums[k] += values[k];
  }
};

/// The lobes of rough glass have the shape of a fuzzy metal's, which the tests above verify.
TEST(StatisticalBsdf, RoughGlassIsFuzzyAroundTheReflectedAndTheRefractedDirection) {
  constexpr double kFuzz = 0.3, kCosine = 0.6, kSine = 0.8;
  constexpr std::uint32_t kBatch = 1 << 14, kBatches = 64;
  Directions batch(kBatch);
  Moments metal, reflected, refracted;
  const double across = kSine / 1.5, down = -std::sqrt(1 - across * across);
  for (std::uint32_t n = 0; n < kBatches; ++n) {
    HWY_NAMESPACE::sample({MaterialKind::kMetal, kFuzz, kCosine}, n * kBatch, batch);
    for (std::uint32_t i = 0; i < kBatch; ++i) metal.add(kSine, kCosine, batch.x[i], batch.y[i], batch.z[i]);
    HWY_NAMESPACE::sample_extended({MaterialKind::kDielectric, kFuzz, kCosine}, (kBatches + n) * kBatch, batch);
    for (std::uint32_t i = 0; i < kBatch; ++i) {
      ASSERT_TRUE(batch.alive[i]) << "both cones are clear of the surface";
      if (batch.y[i] > 0) {
        reflected.add(kSine, kCosine, batch.x[i], batch.y[i], batch.z[i]);
      } else {
        refracted.add(across, down, batch.x[i], batch.y[i], batch.z[i]);
      }
    }
  }
  const double total = double{kBatch} * kBatches, share = 0.04 + 0.96 * std::pow(1 - kCosine, 5);
  EXPECT_NEAR(reflected.count / total, share, 4.5 * std::sqrt(share * (1 - share) / total));
  for (const Moments& lobe : {reflected, refracted}) {
    for (int k = 0; k < 4; ++k)
      EXPECT_NEAR(lobe.sums[k] / lobe.count, metal.sums[k] / metal.count, 4.5 * kFuzz / std::sqrt(lobe.count)) << k;
  }
}

TEST(StatisticalBsdf, RoughGlassAbsorbsWhatLeavesOnTheWrongSide) {
  Directions batch(1 << 14);
  HWY_NAMESPACE::sample_extended({MaterialKind::kDielectric, 0.9, 0.3}, 0, batch);
  int absorbed = 0;
  for (std::size_t i = 0; i < batch.x.size(); ++i) absorbed += batch.alive[i] ? 0 : 1;
  EXPECT_GT(absorbed, 500);
  EXPECT_LT(absorbed, 8000);
  HWY_NAMESPACE::sample_extended({MaterialKind::kDielectric, 0, 0.3}, 0, batch);
  EXPECT_EQ(std::count(batch.alive.begin(), batch.alive.end(), false), 0);
}

}  // namespace
}  // namespace orrery::test
