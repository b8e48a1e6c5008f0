// SPDX-License-Identifier: Apache-2.0
#include "denoise/denoise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "base/error.h"
#include "math/dispatch.h"

namespace orrery::denoise {
namespace {

constexpr int kWidth = 150, kHeight = 50;
constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight;

/// Two surfaces of equal colour and different normal, lit differently, that meet in column kEdge.
constexpr int kEdge = 75;
float true_light(std::size_t pixel) { return static_cast<int>(pixel % kWidth) < kEdge ? 0.5F : 0.6F; }

/// A noisy image of them with the layer `halves`.
///
/// `noise`    standard deviation of a half
film::Picture noisy(float noise, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal(0, 1);
  film::Picture picture{kWidth, kHeight, {}};
  const auto plane = [&](const std::string& name, auto at) {
    film::Plane out{name, std::vector<float>(kPixels)};
    for (std::size_t i = 0; i < kPixels; ++i) out.values[i] = at(i);
    picture.planes.push_back(std::move(out));
  };
  for (const char* half : {"half_a", "half_b"}) {
    for (const char* end : {".R", ".G", ".B"})
      plane(std::string(half) + end,
            [&](std::size_t i) { return std::max(0.0F, true_light(i) + noise * normal(random)); });
    for (const char* end : {".albedo.R", ".albedo.G", ".albedo.B"})
      plane(std::string(half) + end, [](std::size_t) { return 0.5F; });
    for (const char* end : {".normal.X", ".normal.Y", ".normal.Z"})
      plane(std::string(half) + end, [&](std::size_t i) {
        return static_cast<int>(i % kWidth) < kEdge ? (end[8] == 'X' ? 1.0F : 0.0F) : (end[8] == 'Y' ? 1.0F : 0.0F);
      });
    plane(std::string(half) + ".inverse_depth.X", [](std::size_t) { return 0.1F; });
  }
  for (const char* name : {"R", "G", "B"}) {
    const std::vector<float> a = picture.find(std::string("half_a.") + name)->values;
    const std::vector<float> b = picture.find(std::string("half_b.") + name)->values;
    plane(name, [&](std::size_t i) { return (a[i] + b[i]) / 2; });
  }
  plane("A", [](std::size_t) { return 1.0F; });
  plane("Z", [](std::size_t i) { return static_cast<float>(i % 3); });
  return picture;
}

const std::vector<float>& values(const film::Picture& picture, const std::string& name) {
  return picture.find(name)->values;
}

std::vector<float>& values_of(film::Picture& picture, const std::string& name) {
  return std::find_if(picture.planes.begin(), picture.planes.end(), [&](const auto& p) { return p.name == name; })
      ->values;
}

double mean_squared_error(const film::Picture& picture) {
  double sum = 0;
  for (const char* name : {"R", "G", "B"})
    for (std::size_t i = 0; i < kPixels; ++i)
      sum += std::pow(static_cast<double>(values(picture, name)[i]) - static_cast<double>(true_light(i)), 2);
  return sum / 3 / kPixels;
}

TEST(DenoiseDenoise, RemovesNoiseAndKeepsAnEdgeBetweenNormals) {
  film::Picture picture = noisy(0.1F);
  const double before = mean_squared_error(picture);
  EXPECT_TRUE(denoise(picture).is_filtered);
  EXPECT_LT(mean_squared_error(picture), before / 15);
  double left = 0, right = 0;  // beside the edge, where a blur would be closest to the mean
  for (std::size_t y = 0; y < kHeight; ++y) {
    left += static_cast<double>(values(picture, "G")[y * kWidth + kEdge - 1]) / kHeight;
    right += static_cast<double>(values(picture, "G")[y * kWidth + kEdge]) / kHeight;
  }
  EXPECT_NEAR(left, 0.5, 0.01);
  EXPECT_NEAR(right, 0.6, 0.01);
}

TEST(DenoiseDenoise, LeavesAnImageWithoutNoiseAlone) {
  film::Picture picture = noisy(0);
  const film::Picture before = picture;
  denoise(picture);
  for (const char* name : {"R", "G", "B"})
    for (std::size_t i = 0; i < kPixels; ++i) EXPECT_NEAR(values(picture, name)[i], values(before, name)[i], 1e-6F);
}

TEST(DenoiseDenoise, KeepsEnergyAndOtherPlanes) {
  film::Picture picture = noisy(0.2F);
  const film::Picture before = picture;
  denoise(picture);
  double was = 0, is = 0;
  for (std::size_t i = 0; i < kPixels; ++i) {
    was += static_cast<double>(values(before, "R")[i]);
    is += static_cast<double>(values(picture, "R")[i]);
  }
  EXPECT_NEAR(is / was, 1, 1e-5);
  for (const char* name : {"A", "Z"}) EXPECT_EQ(values(picture, name), values(before, name)) << name;
  EXPECT_EQ(values(picture, "half_a.R"), values(before, "half_a.R"));
  ASSERT_EQ(picture.planes.size(), before.planes.size());
}

/// Replaces the light of both halves by f(pixel, normally distributed random number), and the beauty by their mean.
template <class F>
void set_light(film::Picture& picture, F f) {
  std::mt19937 random(3);
  std::normal_distribution<float> normal(0, 1);
  for (const std::string name : {"R", "G", "B"}) {
    for (std::size_t i = 0; i < kPixels; ++i) {
      const float a = values_of(picture, "half_a." + name)[i] = f(i, normal(random));
      const float b = values_of(picture, "half_b." + name)[i] = f(i, normal(random));
      values_of(picture, name)[i] = (a + b) / 2;
    }
  }
}

/// Mean of a column of pixels.
double column_mean(const film::Picture& picture, const std::string& name, std::size_t x) {
  double sum = 0;
  for (std::size_t y = 0; y < kHeight; ++y) sum += static_cast<double>(values(picture, name)[y * kWidth + x]);
  return sum / kHeight;
}

TEST(DenoiseDenoise, RareBrightPixelsKeepTheirLight) {
  // Their darker neighbours take nothing from them, but they take from these.
  film::Picture picture = noisy(0);
  std::mt19937 random(5);
  set_light(picture, [&](std::size_t, float normal) {
    return 0.5F + 0.02F * normal + (random() % 8 == 0 ? 0.4F + 0.3F * std::abs(normal) : 0.0F);
  });
  const film::Picture before = picture;
  denoise(picture);
  for (const char* name : {"R", "G", "B"}) {
    double was = 0, is = 0;
    for (std::size_t i = 0; i < kPixels; ++i) {
      was += static_cast<double>(values(before, name)[i]);
      is += static_cast<double>(values(picture, name)[i]);
    }
    EXPECT_NEAR(is / was, 1, 1e-4) << name;
  }
}

double sum_of(const film::Picture& picture, const std::string& name) {
  double out = 0;
  for (const float v : values(picture, name)) out += static_cast<double>(v);
  return out;
}

/// Mean squared error of values clamped to 0..1 to a constant light.
double clamped_error(const film::Picture& picture, double light) {
  double out = 0;
  const std::string green = "G";
  for (const float v : values(picture, green)) out += std::pow(std::clamp(static_cast<double>(v), 0.0, 1.0) - light, 2);
  return out / kPixels;
}

/// Largest and smallest value within the filter's window around a pixel, without the pixel.
std::pair<float, float> range_around(const film::Picture& picture, std::size_t pixel) {
  std::pair<float, float> out{1e30F, -1e30F};
  for (std::size_t dy = 0; dy <= 16; ++dy)
    for (std::size_t dx = 0; dx <= 16; ++dx) {
      const std::size_t at = pixel + dy * kWidth + dx - 8 * kWidth - 8;
      if (at == pixel) continue;
      out.first = std::min(out.first, values(picture, "G")[at]);
      out.second = std::max(out.second, values(picture, "G")[at]);
    }
  return out;
}

constexpr float kDim = 0.1F;
constexpr std::size_t kBright = 25 * kWidth + 40;

/// A dim surface with little noise, and a pixel whose halves are `a` and `b`.
film::Picture with_bright_pixel(float a, float b) {
  film::Picture picture = noisy(0);
  bool is_a = false;
  set_light(picture, [&](std::size_t i, float normal) {
    if (i != kBright) return kDim + 0.01F * normal;
    is_a = !is_a;
    return is_a ? a : b;
  });
  return picture;
}

TEST(DenoiseDenoise, AnOutlierOfOneHalfLeavesNoSquare) {
  film::Picture picture = with_bright_pixel(200 * kDim, kDim);
  const film::Picture before = picture;
  denoise(picture);
  EXPECT_LT(clamped_error(picture, static_cast<double>(kDim)), clamped_error(before, static_cast<double>(kDim)) / 10);
  const auto [least, most] = range_around(picture, kBright);
  EXPECT_LT(most, kDim * 1.07F) << "a difference of two codes of 8 bits";
  EXPECT_LT(most - least, kDim * 0.07F);
  EXPECT_LT(values(picture, "G")[kBright], kDim * 1.1F) << "it is gone";
  for (const char* name : {"R", "G", "B"}) EXPECT_NEAR(sum_of(picture, name) / sum_of(before, name), 1, 1e-4);
}

TEST(DenoiseDenoise, AnOutlierOfTooMuchLightStaysAPixel) {
  for (const float light : {3e2F, 3e5F}) {
    film::Picture picture = with_bright_pixel(light, kDim);
    const film::Picture before = picture;
    denoise(picture);
    EXPECT_LT(clamped_error(picture, static_cast<double>(kDim)), clamped_error(before, static_cast<double>(kDim)));
    EXPECT_NEAR(values(picture, "G")[kBright], light / 2, 0.01F * light);
    EXPECT_LT(range_around(picture, kBright).second, kDim * 1.07F);
    for (const char* name : {"R", "G", "B"}) EXPECT_NEAR(sum_of(picture, name) / sum_of(before, name), 1, 1e-4);
  }
}

TEST(DenoiseDenoise, AHighlightOfBothHalvesStays) {
  for (const auto& [a, b] : {std::pair{100.0F, 90.0F}, std::pair{150.0F, 50.0F}}) {
    film::Picture picture = with_bright_pixel(a, b);
    const film::Picture before = picture;
    denoise(picture);
    EXPECT_NEAR(values(picture, "G")[kBright], (a + b) / 2, 0.5F);
    EXPECT_LE(range_around(picture, kBright).second, range_around(before, kBright).second);
  }
}

TEST(DenoiseDenoise, ManyFirefliesLeaveNoSquares) {
  film::Picture picture = noisy(0);
  std::mt19937 random(5);
  set_light(picture,
            [&](std::size_t, float normal) { return 0.5F + 0.05F * normal + (random() % 1000 == 0 ? 10.0F : 0.0F); });
  const film::Picture before = picture;
  denoise(picture);
  double squares_were = 0, squares = 0;
  for (std::size_t i = 0; i < kPixels; ++i) {
    squares_were += std::pow(static_cast<double>(values(before, "G")[i]) - 0.51, 2);
    squares += std::pow(static_cast<double>(values(picture, "G")[i]) - 0.51, 2);
  }
  EXPECT_NEAR(sum_of(picture, "G") / sum_of(before, "G"), 1, 1e-4);
  EXPECT_LT(squares, squares_were / 90);
  const auto [least, most] = std::minmax_element(values(picture, "G").begin(), values(picture, "G").end());
  EXPECT_LT(*most / *least, 1.6F);
}

TEST(DenoiseDenoise, AShadowTakesNoLightFromAdjacentNoise) {
  film::Picture picture = noisy(0);
  for (film::Plane& plane : picture.planes)
    if (plane.name.find("normal") != std::string::npos) plane.values.assign(kPixels, 0.5F);
  set_light(picture, [](std::size_t i, float normal) {
    const bool is_shadow = static_cast<int>(i % kWidth) < kEdge;
    return is_shadow ? 0.1F + 0.01F * normal : std::max(0.0F, 0.5F + 0.3F * normal);
  });
  denoise(picture);
  for (int x = 1; x <= 3; ++x) EXPECT_NEAR(column_mean(picture, "R", std::size_t{kEdge} - x), 0.1, 0.027) << x;
}

TEST(DenoiseDenoise, IsTheSameForAllThreadsAndInstructionSets) {
  film::Picture one = noisy(0.1F), two = one;
  denoise(one, 1);
  denoise(two, 2);
  math::TargetChoice& choice = math::target_choice();
  for (const char* name : {"R", "G", "B"}) EXPECT_EQ(values(one, name), values(two, name));
  for (std::int64_t rest = choice.available(); rest != 0; rest &= rest - 1) {
    choice.limit(rest & -rest);
    film::Picture other = noisy(0.1F);
    denoise(other);
    for (const char* name : {"R", "G", "B"}) EXPECT_EQ(values(one, name), values(other, name)) << (rest & -rest);
  }
  choice.limit(choice.available());
}

/// Adds layers that divide the beauty, in single precision, with independent noise.
void add_light_layers(film::Picture& picture) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> part(0, 8);
  for (const char letter : {'R', 'G', 'B'}) {
    const std::vector<float> beauty = values(picture, std::string(1, letter));
    film::Plane key_diffuse{std::string("key_diffuse_direct.") + letter, beauty},
        key = {std::string("key.") + letter, beauty};
    film::Plane rim_diffuse{std::string("rim_diffuse_direct.") + letter, beauty},
        rim = {std::string("rim.") + letter, beauty};
    film::Plane rim_specular{std::string("rim_specular_direct.") + letter, beauty};
    film::Plane diffuse{std::string("diffuse_direct.") + letter, beauty},
        specular{std::string("specular_direct.") + letter, beauty};
    for (std::size_t i = 0; i < kPixels; ++i) {
      const float last_bit = std::ldexp(1.0F, std::ilogb(beauty[i]) - 23);
      const float units = beauty[i] / last_bit;
      const float first = std::floor(units * static_cast<float>(part(random)) / 16),
                  second = std::floor((units - first) / 3);
      key_diffuse.values[i] = key.values[i] = first * last_bit;
      rim_diffuse.values[i] = second * last_bit;
      rim_specular.values[i] = specular.values[i] = (units - first - second) * last_bit;
      rim.values[i] = (units - first) * last_bit;
      diffuse.values[i] = (first + second) * last_bit;
    }
    for (film::Plane* plane : {&diffuse, &specular, &key, &key_diffuse, &rim, &rim_diffuse, &rim_specular})
      picture.planes.push_back(std::move(*plane));
  }
}

TEST(DenoiseDenoise, LightLayersStillAddUpToTheBeauty) {
  film::Picture picture = noisy(0.2F);
  const auto set_outlier = [&](std::size_t pixel, float light) {  // in one half
    for (const std::string name : {"R", "G", "B"}) {
      values_of(picture, "half_b." + name)[pixel] = light;
      values_of(picture, name)[pixel] = (values(picture, "half_a." + name)[pixel] + light) / 2;
    }
  };
  set_outlier(20 * kWidth + 30, 50);    // spread
  set_outlier(20 * kWidth + 33, 5e4F);  // kept
  film::Picture beauty_alone = picture;
  add_light_layers(picture);
  const film::Picture before = picture;
  EXPECT_EQ(denoise(picture).layers.size(), 7U);
  denoise(beauty_alone);
  for (const std::string end : {".R", ".G", ".B"}) {
    const std::vector<float> beauty = values(picture, end.substr(1));
    EXPECT_EQ(beauty, values(beauty_alone, end.substr(1))) << "the weights are those of the beauty alone";
    const auto expect_sum = [&](const std::vector<float>& whole, const std::vector<std::string>& layers) {
      for (std::size_t i = 0; i < kPixels; ++i) {
        float up = 0, down = 0;
        for (std::size_t k = 0; k < layers.size(); ++k) {
          up += values(picture, layers[k] + end)[i];
          down += values(picture, layers[layers.size() - 1 - k] + end)[i];
          ASSERT_GE(values(picture, layers[k] + end)[i], 0);
        }
        ASSERT_EQ(up, whole[i]) << layers[0] << " " << i;
        ASSERT_EQ(down, whole[i]);
      }
    };
    expect_sum(beauty, {"diffuse_direct", "specular_direct"});
    expect_sum(beauty, {"key", "rim"});
    expect_sum(beauty, {"key_diffuse_direct", "rim_diffuse_direct", "rim_specular_direct"});
    expect_sum(values(picture, "rim" + end), {"rim_diffuse_direct", "rim_specular_direct"});
    expect_sum(values(picture, "diffuse_direct" + end), {"key_diffuse_direct", "rim_diffuse_direct"});
    double variation = 0, variation_before = 0;
    for (std::size_t i = 21 * kWidth + 1; i < kPixels; ++i) {
      variation += std::abs(static_cast<double>(values(picture, "key" + end)[i] - values(picture, "key" + end)[i - 1]));
      variation_before +=
          std::abs(static_cast<double>(values(before, "key" + end)[i] - values(before, "key" + end)[i - 1]));
    }
    EXPECT_LT(variation, variation_before / 3) << "layers are filtered too";
  }
}

TEST(DenoiseDenoise, LayersWithOnlyPartOfTheLightAreAlsoFiltered) {
  film::Picture picture = noisy(0.2F);
  film::Picture partial = picture;
  add_light_layers(picture);
  for (const std::string end : {".R", ".G", ".B"}) partial.planes.push_back(*picture.find("specular_direct" + end));
  denoise(picture);
  denoise(partial);
  for (std::size_t i = 0; i < kPixels; ++i) {
    EXPECT_NEAR(values(partial, "specular_direct.R")[i], values(picture, "specular_direct.R")[i], 1e-5F);
    ASSERT_LE(values(partial, "specular_direct.R")[i], values(partial, "R")[i]);
  }
}

TEST(DenoiseDenoise, BadPixelsStayAloneAndDoNotSpread) {
  film::Picture picture = noisy(0.1F);
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();
  const std::size_t bad[] = {0, 20 * kWidth + 40, 49 * kWidth + 149, 3 * kWidth + 3};
  const float as[] = {kNan, kInfinity, -kInfinity, 3e38F};
  for (int k = 0; k < 4; ++k)
    for (const char* name : {"R", "half_a.R", "half_a.albedo.G", "half_b.normal.X", "half_a.inverse_depth.X"})
      for (film::Plane& plane : picture.planes)
        if (plane.name == name) plane.values[bad[k]] = as[k];
  EXPECT_EQ(denoise(picture).bad_pixels, 4U);
  for (const char* name : {"R", "G", "B"})
    for (std::size_t i = 0; i < kPixels; ++i) {
      if (std::find(std::begin(bad), std::end(bad), i) != std::end(bad)) continue;
      EXPECT_NEAR(values(picture, name)[i], true_light(i), 0.15F) << name << i;
    }
  EXPECT_TRUE(std::isnan(values(picture, "R")[0]));
}

TEST(DenoiseDenoise, TheHalvesCanBeRemoved) {
  film::Picture kept = noisy(0.1F), removed = kept;
  // Where one half lacks samples, it is replaced by the other.
  for (film::Picture* const picture : {&kept, &removed})
    for (film::Plane& plane : picture->planes)
      if (plane.name.starts_with("half_b.")) plane.values[20 * kWidth + 30] = std::numeric_limits<float>::quiet_NaN();
  denoise(kept);
  denoise(removed, 0, false);
  for (const film::Plane& plane : removed.planes) EXPECT_EQ(plane.values, values(kept, plane.name)) << plane.name;
  EXPECT_EQ(removed.planes.size() + 20, kept.planes.size());
}

TEST(DenoiseDenoise, WithoutOneHalfTheImageIsUnchanged) {
  film::Picture picture = noisy(0.1F);
  for (film::Plane& plane : picture.planes)
    if (plane.name.starts_with("half_b."))
      for (std::size_t i = 0; i < kPixels; i += 2) plane.values[i] = std::numeric_limits<float>::quiet_NaN();
  const film::Picture before = picture;
  EXPECT_FALSE(denoise(picture, 0, false).is_filtered);
  ASSERT_EQ(picture.planes.size() + 20, before.planes.size()) << "the halves are removed";
  for (const film::Plane& plane : picture.planes) EXPECT_EQ(plane.values, values(before, plane.name)) << plane.name;
}

TEST(DenoiseDenoise, PixelsWithoutSamplesStayAsTheyAre) {
  film::Picture picture = noisy(0.1F);
  constexpr std::size_t kHole = 20 * kWidth + 30;
  for (film::Plane& plane : picture.planes)
    if (film::is_half(plane.name)) plane.values[kHole] = std::numeric_limits<float>::quiet_NaN();
  for (const char* name : {"R", "G", "B"}) values_of(picture, name)[kHole] = 0;
  const Report report = denoise(picture);
  EXPECT_EQ(report.bad_pixels, 1U);
  EXPECT_EQ(values(picture, "R")[kHole], 0);
  EXPECT_NEAR(values(picture, "R")[kHole + 1], 0.5, 0.1) << "and do not darken others";
}

/// Colours are premultiplied: a transparent pixel that receives light must receive alpha, too.
TEST(DenoiseDenoise, AlphaIsFilteredWithTheColors) {
  film::Picture picture = noisy(0);
  std::mt19937 random(5);
  for (std::size_t i = 0; i < kPixels; ++i) {
    const float alpha = random() % 2 == 0 ? 0.0F : 1.0F;  // an edge out of focus, at two samples
    values_of(picture, "A")[i] = alpha;
    for (const std::string name : {"R", "G", "B"}) {
      values_of(picture, "half_a." + name)[i] = random() % 2 == 0 ? 0.0F : 2 * alpha;
      values_of(picture, "half_b." + name)[i] = 2 * alpha - values_of(picture, "half_a." + name)[i];
      values_of(picture, name)[i] = alpha;
    }
  }
  denoise(picture);
  double spread = 0;
  for (std::size_t i = 0; i < kPixels; ++i) {
    const float alpha = values(picture, "A")[i];
    EXPECT_TRUE(alpha >= 0 && alpha <= 1);
    EXPECT_NEAR(values(picture, "R")[i], alpha, 0.06) << i;
    spread += alpha > 0.1F && alpha < 0.9F ? 1 : 0;
  }
  EXPECT_GT(spread, 0.5 * kPixels) << "the noise was filtered";
}

TEST(DenoiseDenoise, RadianceOfAnyScaleIsFilteredEqually) {
  film::Picture normal = noisy(0.1F), tiny = normal;
  constexpr float kScale = 0x1p-30F;  // a power of two, so that no rounding differs
  for (film::Plane& plane : tiny.planes)
    if (plane.name.size() <= 8 && plane.name != "A" && plane.name != "Z")
      for (float& v : plane.values) v *= kScale;
  denoise(normal);
  denoise(tiny);
  for (std::size_t i = 0; i < kPixels; ++i) EXPECT_NEAR(values(tiny, "R")[i] / kScale, values(normal, "R")[i], 1e-5F);
}

TEST(DenoiseDenoise, SmallImagesAndMissingChannels) {
  film::Picture dot{1, 1, {}};
  for (const film::Plane& plane : noisy(0.1F).planes) dot.planes.push_back({plane.name, {plane.values.front()}});
  const film::Picture before = dot;
  EXPECT_TRUE(denoise(dot).is_filtered);
  EXPECT_FLOAT_EQ(values(dot, "B")[0], values(before, "B")[0]);
  for (const char* name : {"B", "half_a.R", "half_b.inverse_depth.X"}) {
    film::Picture incomplete = before;
    std::erase_if(incomplete.planes, [&](const film::Plane& plane) { return plane.name == name; });
    EXPECT_THROW(denoise(incomplete), base::Error) << name;
  }
}

}  // namespace
}  // namespace orrery::denoise
