// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdint>

#include "kernel/sampler-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

template <class U>
void philox_all(const std::uint32_t* counter, const std::uint32_t* key, std::uint32_t* out) {
  const hn::ScalableTag<U> du;
  Four<hn::Vec<decltype(du)>> c;
  for (int i = 0; i < 4; ++i) c.v[i] = hn::Set(du, static_cast<U>(counter[i]));
  const auto r = philox(du, c, key[0], key[1]);
  HWY_ALIGN U lanes[hn::MaxLanes(du)];
  for (int i = 0; i < 4; ++i) {
    hn::Store(r.v[i], du, lanes);
    for (std::size_t k = 1; k < hn::Lanes(du); ++k)
      if (static_cast<std::uint32_t>(lanes[k]) != static_cast<std::uint32_t>(lanes[0])) lanes[0] = ~lanes[0];
    out[i] = static_cast<std::uint32_t>(lanes[0]);
  }
}
void philox_64(const std::uint32_t* c, const std::uint32_t* k, std::uint32_t* out) {
  philox_all<std::uint64_t>(c, k, out);
}
void philox_32(const std::uint32_t* c, const std::uint32_t* k, std::uint32_t* out) {
  philox_all<std::uint32_t>(c, k, out);
}

/// Unit numbers of the smallest and the largest random bits, in double and float.
void unit_ends(double* ends, float* ends_fast) {
  const hn::ScalableTag<double> d;
  const hn::ScalableTag<float> df;
  const hn::RebindToUnsigned<decltype(d)> du;
  const hn::RebindToUnsigned<decltype(df)> duf;
  ends[0] = hn::GetLane(to_unit(d, hn::Set(du, 0u)));
  ends[1] = hn::GetLane(to_unit(d, hn::Set(du, 0xffffffffffffffffu)));  // the high half is ignored
  ends_fast[0] = hn::GetLane(to_unit(df, hn::Set(duf, 0u)));
  ends_fast[1] = hn::GetLane(to_unit(df, hn::Set(duf, 0xffffffffu)));
}

/// Random numbers of vertices 0 .. 3 of one path, four per vertex.
void numbers_of_a_path(double* out) {
  const hn::FixedTag<double, 1> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  for (std::uint32_t vertex = 0; vertex < 4; ++vertex) {
    const auto four =
        random_at_vertex(d, {SamplerKind::kIndependent, 1}, hn::Set(du, 5u), hn::Set(du, 6u), vertex, true);
    for (int i = 0; i < 4; ++i) *out++ = hn::GetLane(four.v[i]);
  }
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace orrery::kernel {
namespace {

struct KnownAnswer {
  std::uint32_t counter[4], key[2], answer[4];
};
// The published known-answer vectors of Philox4x32 with seven rounds (salmon2011, kat_vectors).
constexpr KnownAnswer kAnswers[] = {
    {{0, 0, 0, 0}, {0, 0}, {0x5f6fb709, 0x0d893f64, 0x4f121f81, 0x4f730a48}},
    {{0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff},
     {0xffffffff, 0xffffffff},
     {0x5207ddc2, 0x45165e59, 0x4d8ee751, 0x8c52f662}},
    {{0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344},
     {0xa4093822, 0x299f31d0},
     {0x4dfccaba, 0x190a87f0, 0xc47362ba, 0xb6b5242a}},
};

TEST(KernelRandom, MatchesThePublishedVectorsInBothLaneWidths) {
  for (const KnownAnswer& known : kAnswers) {
    std::uint32_t wide[4], narrow[4];
    HWY_NAMESPACE::philox_64(known.counter, known.key, wide);
    HWY_NAMESPACE::philox_32(known.counter, known.key, narrow);
    for (int i = 0; i < 4; ++i) {
      EXPECT_EQ(wide[i], known.answer[i]) << i;
      EXPECT_EQ(narrow[i], known.answer[i]) << i;
    }
  }
}

TEST(KernelRandom, UnitNumbersAreInTheOpenInterval) {
  double ends[2];
  float ends_fast[2];
  HWY_NAMESPACE::unit_ends(ends, ends_fast);
  EXPECT_EQ(ends[0], 0x1p-33);
  EXPECT_EQ(ends[1], 1 - 0x1p-33);
  EXPECT_EQ(ends_fast[0], 0x1p-24f);
  EXPECT_EQ(ends_fast[1], 1 - 0x1p-24f);
}

TEST(KernelRandom, VerticesAndDimensionsHaveDistinctNumbers) {
  double numbers[16];
  HWY_NAMESPACE::numbers_of_a_path(numbers);
  for (int i = 0; i < 16; ++i)
    for (int j = 0; j < i; ++j) EXPECT_NE(numbers[i], numbers[j]) << i << ' ' << j;
}

}  // namespace
}  // namespace orrery::kernel
