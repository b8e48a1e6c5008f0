// SPDX-License-Identifier: Apache-2.0
#include "film/layer_film.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

#include "film/layers.h"
#include "film/light_cells.h"
#include "kernel/scene_view.h"
#include "math/pixels.h"

namespace orrery::film {
namespace {

using kernel::Int128;

/// A relative spread below this is rounding error; the beauty's floats cannot represent it either.
constexpr double kMinSpread = 0x1p-48;

/// The squared standard error of a pixel's mean radiance, from the sum and the sum of squares of `n` paths.
float variance(Int128 sum, Int128 squares, std::int64_t n) {
  if (n < 2) return 0;
  const auto count = static_cast<double>(n);
  const double light = kernel::from_fixed_point(sum), of_squares = static_cast<double>(squares) * kSquareUnit;
  const double spread = of_squares - light * light / count;
  const double of_one = spread > kMinSpread * of_squares ? spread / (count - 1) : 0;
  return static_cast<float>(count * of_one / (count * count));
}

/// A Cryptomatte id and its weight in a pixel.
struct RankedCoverage {
  std::uint32_t id;
  std::int64_t weight;
};

/// The ids of a matte in a pixel by descending coverage; ties by ascending id.
std::vector<RankedCoverage> ranked(const LayerRequest& r, const Matte& matte, const LayerPixel& p) {
  std::vector<RankedCoverage> shares;
  for (const SphereCoverage& s : p.shares) {
    if (s.sphere == kernel::kNone) continue;
    const std::uint32_t id = r.matte_id(matte, s.sphere);
    if (id == 0) continue;
    const auto known =
        std::find_if(shares.begin(), shares.end(), [id](const RankedCoverage& share) { return share.id == id; });
    if (known == shares.end()) {
      shares.push_back({id, s.weight});
    } else {
      known->weight += s.weight;
    }
  }
  std::sort(shares.begin(), shares.end(), [](const RankedCoverage& a, const RankedCoverage& b) {
    return a.weight != b.weight ? a.weight > b.weight : a.id < b.id;
  });
  return shares;
}

float as_float(std::uint32_t bits) {
  float f;
  std::memcpy(&f, &bits, sizeof(f));
  return f;
}

/// Name of a lobe's layer in a light group; a string only where one is needed.
struct GroupLayer {
  const std::string& group;
  const char* lobe;
  operator std::string() const { return group + "_" + lobe; }
};

/// Calls `f(layer, channel, kind, value)` for every channel of the layers made from light events, in file order.
template <class F>
void each_light_channel(const LayerRequest& r, const LayerPixel& p, const kernel::PixelSum& beauty, F f) {
  const LightCells lights(r, p, beauty);
  const auto channels = [&](const auto& layer, auto value) {
    for (std::size_t k = 0; k < 3; ++k) f(layer, "RGB"[k], PlaneKind::kLight, value(k));
  };
  using enum kernel::Lobe;
  for (const auto& [requested, lobe] : {std::pair{r.background, kBackground},
                                        {r.diffuse, kDiffuseDirect},
                                        {r.diffuse, kDiffuseIndirect},
                                        {r.specular, kSpecularDirect},
                                        {r.specular, kSpecularIndirect},
                                        {r.transmission, kTransmissionDirect},
                                        {r.transmission, kTransmissionIndirect},
                                        {r.emission, kEmission}})
    if (requested)
      channels(kLobeNames[static_cast<int>(lobe)], [&, lobe = lobe](std::size_t k) { return lights.of_lobe(lobe, k); });
  if (!r.light_groups) return;
  for (std::size_t g = 0; g < r.groups.size(); ++g) {
    const LightGroup& group = r.groups[g];
    if (!group.has_sources()) continue;
    channels(group.name, [&](std::size_t k) { return lights.of_group(g, k); });
    for (int i = 0; i < kernel::kLobes; ++i) {
      const auto lobe = static_cast<kernel::Lobe>(i);
      if (group.has(lobe))
        channels(GroupLayer{group.name, kLobeNames[i]}, [&](std::size_t k) { return lights.of(g, lobe, k); });
    }
  }
}

constexpr double kNoMean = std::numeric_limits<double>::quiet_NaN();

/// The mean of guides from their sum and total weight.
double mean_guide(std::int64_t sum, std::int64_t weight) {
  return static_cast<double>(sum) * kernel::kGuideUnit / static_cast<double>(weight);
}

/// Calls `f(layer, channel, kind, value)` for every channel of the two halves. They are data, so that they are stored
/// in single precision: their difference is what matters. A half without weight is NaN, because 0 would be a valid
/// measurement.
template <class F>
void each_half_channel(const Halves& halves, F f) {
  struct Names {
    const char *beauty, *albedo, *normal, *inverse_depth;
  };
  static constexpr Names kNames[2] = {{"half_a", "half_a.albedo", "half_a.normal", "half_a.inverse_depth"},
                                      {"half_b", "half_b.albedo", "half_b.normal", "half_b.inverse_depth"}};
  for (std::size_t i = 0; i < 2; ++i) {
    const Names& names = kNames[i];
    const kernel::PixelSum& light = halves[i].light;
    const kernel::GuideSum& guides = halves[i].guides;
    const bool has_mean = light.weight > 0 && guides.weight > 0;
    const auto channels = [&](const char* layer, const char* letters, auto mean_of) {
      for (int k = 0; k < 3; ++k)
        f(layer, letters[k], PlaneKind::kData, static_cast<float>(has_mean ? mean_of(k) : kNoMean));
    };
    channels(names.beauty, "RGB", [&](int k) { return mean(light.rgb[k], light.weight); });
    channels(names.albedo, "RGB", [&](int k) { return mean_guide(guides.albedo[k], guides.weight); });
    channels(names.normal, "XYZ", [&](int k) { return mean_guide(guides.normal[k], guides.weight); });
    f(names.inverse_depth, 'X', PlaneKind::kData,
      static_cast<float>(has_mean ? mean(guides.inverse_depth, guides.weight) : kNoMean));
  }
}

/// Calls `f(layer, channel, kind, value)` for every requested channel, in file order.
template <class F>
void each_channel(const LayerRequest& r, const LayerPixel& p, const Halves& halves, const kernel::PixelSum& beauty,
                  const kernel::SceneView& view, F f) {
  const bool hit = p.sphere != kernel::kNone;
  using enum PlaneKind;
  const auto vector = [&](const char* layer, const char* letters, PlaneKind kind, auto value) {
    for (int k = 0; k < 3; ++k) f(layer, letters[k], kind, value(k));
  };
  const auto means = [&](const char* layer, const char* letters, PlaneKind kind, const Int128(&sum)[3]) {
    vector(layer, letters, kind, [&](int k) { return static_cast<float>(mean(sum[k], p.weight)); });
  };
  if (r.z) f("", 'Z', kData, hit ? static_cast<float>(p.z) : kNothingHit);
  if (r.depth) f("depth", 'X', kData, hit ? static_cast<float>(p.depth) : kNothingHit);
  if (r.normal) means("N", "XYZ", kVector, p.normal);
  if (r.position) vector("P", "XYZ", kData, [&](int k) { return static_cast<float>(p.position[k]); });
  if (r.albedo) means("albedo", "RGB", kLight, p.albedo);
  if (r.lights()) each_light_channel(r, p, beauty, f);
  if (r.variance) vector("variance", "RGB", kData, [&](int c) { return variance(beauty.rgb[c], p.squares[c], p.lit); });
  if (r.samples) f("samples", 'X', kData, static_cast<float>(p.lit));
  // Ids start at 1; 0 means no hit.
  if (r.object_id) f("object_id", 'X', kData, hit ? static_cast<float>(view.rods.object(p.sphere)) + 1 : 0.0F);
  if (r.material_id)
    f("material_id", 'X', kData, hit ? static_cast<float>(r.material_numbers[view.object_materials[p.sphere]]) : 0.0F);
  if (r.guide_albedo || r.guide_normal) {
    kernel::GuideSum guides = halves[0].guides;
    guides += halves[1].guides;
    const auto guide = [&](const char* layer, const char* letters, PlaneKind kind, const std::int64_t(&sum)[3]) {
      vector(layer, letters, kind, [&](int k) { return static_cast<float>(mean_guide(sum[k], guides.weight)); });
    };
    if (r.guide_albedo) guide("denoise.albedo", "RGB", kLight, guides.albedo);
    if (r.guide_normal) guide("denoise.normal", "XYZ", kVector, guides.normal);
  }
  if (r.halves) each_half_channel(halves, f);
  for (const Matte& matte : r.mattes) {
    const std::vector<RankedCoverage> shares = ranked(r, matte, p);
    // A layer of four channels holds two ranks: id, coverage, id, coverage.
    for (int rank = 0; rank < r.matte_ranks + r.matte_ranks % 2; ++rank) {
      const char name[] = {static_cast<char>('0' + rank / 20), static_cast<char>('0' + rank / 2 % 10), 0};
      const bool there = rank < r.matte_ranks && static_cast<std::size_t>(rank) < shares.size() && p.weight > 0;
      const RankedCoverage share = there ? shares[static_cast<std::size_t>(rank)] : RankedCoverage{0, 0};
      f(matte.name + name, rank % 2 == 0 ? 'R' : 'B', kData, as_float(share.id));
      f(matte.name + name, rank % 2 == 0 ? 'G' : 'A', kData,
        there ? static_cast<float>(static_cast<double>(share.weight) / static_cast<double>(p.weight)) : 0.0F);
    }
  }
}

/// The deep samples of a pixel, nearest first, with alphas that composite to each sphere's coverage.
std::vector<DeepSample> deep_samples(const LayerPixel& p, bool background_visible) {
  std::vector<DeepSample> out;
  if (p.weight <= 0) return out;
  std::vector<SphereCoverage> shares = p.shares;
  std::stable_sort(shares.begin(), shares.end(),
                   [](const SphereCoverage& a, const SphereCoverage& b) { return a.front < b.front; });
  std::int64_t left = p.weight;  // weight of the paths that no sample so far covers
  for (const SphereCoverage& share : shares) {
    if (share.sphere == kernel::kNone && !background_visible) continue;
    const auto seen = static_cast<double>(left);
    DeepSample sample{};
    sample.front = static_cast<float>(share.front);
    sample.back = static_cast<float>(share.back);
    sample.alpha = static_cast<float>(static_cast<double>(share.weight) / seen);
    for (int c = 0; c < 3; ++c) sample.rgb[c] = static_cast<float>(kernel::from_fixed_point(share.light[c]) / seen);
    out.push_back(sample);
    left -= share.weight;
  }
  return out;
}

}  // namespace

std::vector<Plane> planes_of(const LayerRequest& request) {
  std::vector<Plane> planes;
  each_channel(request, {}, {}, {}, {}, [&](const std::string& layer, char channel, PlaneKind kind, float) {
    planes.push_back({(layer.empty() ? "" : layer + ".") + channel, {}, kind});
  });
  return planes;
}

LayerFilm::LayerFilm(const LayerRequest& request, const kernel::SceneView& view, int width_px, int height_px)
    : request_(request), view_(view), planes_(planes_of(request)) {
  const std::size_t pixels = math::pixel_count(width_px, height_px);
  for (Plane& plane : planes_) plane.values.resize(pixels);
  if (request_.coverage) coverage_.resize(pixels);
  if (!request_.deep) return;
  deep_.width = width_px;
  deep_.height = height_px;
  deep_.pixels.resize(pixels);
}

void LayerFilm::set(std::size_t pixel, const LayerPixel& sums, const Halves& halves, const kernel::PixelSum& beauty) {
  std::size_t plane = 0;
  each_channel(request_, sums, halves, beauty, view_,
               [&](const auto&, char, PlaneKind, float v) { planes_[plane++].values[pixel] = v; });
  if (request_.deep) deep_.pixels[pixel] = deep_samples(sums, !request_.coverage);
  if (request_.coverage && sums.weight > 0)
    coverage_[pixel] = static_cast<float>(static_cast<double>(sums.covered) / static_cast<double>(sums.weight));
}

DeepPicture LayerFilm::take_deep() { return std::move(deep_); }

void LayerFilm::move_to(Picture& picture) {
  for (Plane& plane : picture.planes)
    if (plane.name == "A" && request_.coverage) plane.values = std::move(coverage_);
  picture.is_transparent = request_.coverage;
  for (Plane& plane : planes_) picture.planes.push_back(std::move(plane));
}

}  // namespace orrery::film
