// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "support/chi_square.h"

#include "kernel/opacity-inl.h"
#include "kernel/sampler-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

/// The thresholds of paths, by the lanes of T, as packets have them.
template <class T>
void thresholds_in(const Sampler& sampler, std::uint32_t pixel, std::size_t count, float* out) {
  const hn::ScalableTag<T> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto samples = hn::Iota(du, static_cast<IdOf<T>>(i));
    store_floats(d, numbers_of_path(d, sampler, hn::Set(du, IdOf<T>{pixel}), samples).threshold, out + i);
  }
}
void thresholds_in_double(const Sampler& sampler, std::uint32_t pixel, std::size_t count, float* out) {
  thresholds_in<double>(sampler, pixel, count, out);
}
void thresholds_in_float(const Sampler& sampler, std::uint32_t pixel, std::size_t count, float* out) {
  thresholds_in<float>(sampler, pixel, count, out);
}

/// The times and thresholds of paths of the first sample of pixels.
void numbers_of_pixels(const Sampler& sampler, std::size_t count, double* times, double* thresholds) {
  const hn::FixedTag<double, 1> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  for (std::size_t i = 0; i < count; ++i) {
    const auto numbers = numbers_of_path(d, sampler, hn::Set(du, i), hn::Zero(du));
    times[i] = hn::GetLane(numbers.time);
    thresholds[i] = hn::GetLane(numbers.threshold);
  }
}

/// Whether an object is visible to the rays of a packet, as bits, by visible_lanes() and by visible_objects().
template <class T>
void visible_in(const RayPacket<T>& packet, float opacity, std::uint32_t* lanes, std::uint32_t* objects) {
  const hn::ScalableTag<T> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  const float opacities[] = {1, opacity};
  *lanes = *objects = 0;
  for (int i = 0; i < kPacketSize; i += static_cast<int>(hn::Lanes(d))) {
    const auto all = hn::FirstN(d, hn::Lanes(d));
    const auto of_lanes = visible_lanes(d, packet, i, opacity);
    const auto of_objects = visible_objects(d, packet.threshold + i, hn::Set(du, IdOf<T>{1}), all, opacities);
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, of_lanes, bits);
    *lanes |= (bits[0] | bits[1] << 8u) << i;
    hn::StoreMaskBits(d, of_objects, bits);
    *objects |= (bits[0] | bits[1] << 8u) << i;
  }
}
void visible_in_double(const RayPacket<double>& packet, float opacity, std::uint32_t* lanes, std::uint32_t* objects) {
  visible_in(packet, opacity, lanes, objects);
}
void visible_in_float(const RayPacket<float>& packet, float opacity, std::uint32_t* lanes, std::uint32_t* objects) {
  visible_in(packet, opacity, lanes, objects);
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace orrery::kernel {
namespace {

Sampler sampler_of(SamplerKind kind) {
  Sampler out;
  out.seed = 7;
  out.kind = kind;
  return out;
}

std::vector<float> thresholds(const Sampler& sampler, std::uint32_t pixel, std::size_t count) {
  std::vector<float> out(count);
  HWY_NAMESPACE::thresholds_in_double(sampler, pixel, count, out.data());
  return out;
}

TEST(KernelOpacity, ThresholdsOfAPixelAreStratified) {
  constexpr std::size_t kSamples = 64;
  for (std::uint32_t pixel = 0; pixel < 20; ++pixel) {
    std::vector<int> strata(kSamples);
    for (const float threshold : thresholds(sampler_of(SamplerKind::kSobol), pixel, kSamples)) {
      ASSERT_GE(threshold, 0);
      ASSERT_LT(threshold, 1);
      ++strata[static_cast<std::size_t>(threshold * kSamples)];
    }
    EXPECT_EQ(strata, std::vector<int>(kSamples, 1)) << pixel;
  }
}

TEST(KernelOpacity, ThresholdsAreUniformAndIndependentOfNeighboursAndTimes) {
  for (const SamplerKind kind : {SamplerKind::kSobol, SamplerKind::kIndependent}) {
    std::vector<double> times(100000), of_paths(times.size());
    HWY_NAMESPACE::numbers_of_pixels(sampler_of(kind), times.size(), times.data(), of_paths.data());
    std::vector<std::uint64_t> of_neighbours(64), of_times(64);
    const auto bin = [](double a, double b) {
      return static_cast<std::size_t>(a * 8) * 8 + static_cast<std::size_t>(b * 8);
    };
    for (std::size_t i = 0; i < times.size(); i += 2) {
      ++of_neighbours[bin(of_paths[i], of_paths[i + 1])];
      ++of_times[bin(of_paths[i], times[i])];
    }
    EXPECT_LT(std::abs(test::chi_square_of_equal_bins(of_neighbours).z), test::kLargestZ);
    EXPECT_LT(std::abs(test::chi_square_of_equal_bins(of_times).z), test::kLargestZ);
  }
}

TEST(KernelOpacity, BothPrecisionsHaveTheSameThresholds) {
  for (const SamplerKind kind : {SamplerKind::kSobol, SamplerKind::kIndependent, SamplerKind::kBlueNoise}) {
    std::vector<float> narrow(1024);
    HWY_NAMESPACE::thresholds_in_float(sampler_of(kind), 77, narrow.size(), narrow.data());
    const std::vector<float> wide = thresholds(sampler_of(kind), 77, narrow.size());
    for (std::size_t i = 0; i < narrow.size(); ++i) EXPECT_NEAR(wide[i], narrow[i], 0x1p-23F);
  }
}

template <class T>
void expect_visible(void (*visible)(const RayPacket<T>&, float, std::uint32_t*, std::uint32_t*)) {
  RayPacket<T> packet;
  for (int lane = 0; lane < kPacketSize; ++lane)
    packet.threshold[lane] = static_cast<float>(lane) / static_cast<float>(kPacketSize);
  for (int count = 0; count <= kPacketSize; ++count) {
    // A threshold that is equal to the opacity hides the object: with 0, none is visible.
    std::uint32_t lanes = 0, objects = 0;
    visible(packet, static_cast<float>(count) / static_cast<float>(kPacketSize), &lanes, &objects);
    EXPECT_EQ(lanes, (1u << count) - 1) << count;
    EXPECT_EQ(objects, (1u << count) - 1) << count;
  }
}

TEST(KernelOpacity, ObjectsAreVisibleBelowTheirOpacity) {
  expect_visible<double>(HWY_NAMESPACE::visible_in_double);
  expect_visible<float>(HWY_NAMESPACE::visible_in_float);
}

}  // namespace
}  // namespace orrery::kernel
