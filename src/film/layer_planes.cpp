// SPDX-License-Identifier: Apache-2.0
#include "film/layer_planes.h"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <limits>
#include <string>
#include <utility>

#include "film/layer_sums.h"
#include "film/layers.h"
#include "film/light_cells.h"
#include "film/sums.h"
#include "kernel/scene_view.h"

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
std::vector<RankedCoverage> ranked(const LayerRequest& r, const Matte& matte,
                                   const std::vector<SphereCoverage>& of_pixel) {
  std::vector<RankedCoverage> shares;
  for (const SphereCoverage& s : of_pixel) {
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

constexpr double kNoMean = std::numeric_limits<double>::quiet_NaN();

/// The mean of guides from their sum and number.
double mean_guide(std::int64_t sum, std::int64_t count) {
  return static_cast<double>(sum) * kernel::kGuideUnit / static_cast<double>(count);
}

/// Collects the planes of an image.
class PlaneList {
 public:
  PlaneList(const LayerRequest& request, const kernel::SceneView& view, const Sums& sums)
      : r_(request), view_(view), sums_(sums) {}

  std::vector<LayerPlanes> take() { return std::move(out_); }

  void add_beauty() {
    add("", "RGBA", PlaneKind::kLight, [&r = r_, &sums = sums_](std::size_t i, float* v) {
      sums.mean(i, v);
      v[3] = r.transparent ? sums.coverage(i) : 1.0F;
    });
  }

  void add_layers() {
    using enum PlaneKind;
    const LayerSums& l = sums_.layers;
    const auto nearest = [&](const char* layer, const char* channel, auto value, float of_miss) {
      add(layer, channel, kData, [=, &l](std::size_t i, float* v) { v[0] = l.hit[i] != 0 ? value(i) : of_miss; });
    };
    if (r_.z)
      nearest(
          "", "Z", [&l](std::size_t i) { return l.z[i]; }, kNothingHit);
    if (r_.depth)
      nearest(
          "depth", "X", [&l](std::size_t i) { return static_cast<float>(l.depth[i]); }, kNothingHit);
    if (r_.normal) add_means("N", "XYZ", kVector, l.normal);
    if (r_.position)
      add("P", "XYZ", kData, [&l](std::size_t i, float* v) { std::copy_n(l.position[i].begin(), 3, v); });
    if (r_.albedo) add_means("albedo", "RGB", kLight, l.albedo);
    if (r_.lights()) add_lights();
    if (r_.variance)
      add("variance", "RGB", kData, [&sums = sums_, &l](std::size_t i, float* v) {
        const kernel::PixelSum beauty = sums.sum(i);
        for (std::size_t c = 0; c < 3; ++c) v[c] = variance(beauty.rgb[c], l.squares[i][c], beauty.weight);
      });
    if (r_.samples)
      add("samples", "X", kData,
          [&sums = sums_](std::size_t i, float* v) { v[0] = static_cast<float>(sums.sum(i).weight); });
    // Ids start at 1; 0 means no hit.
    const auto object = [&view = view_, &l](std::size_t i) {
      return static_cast<float>(view.rods.object(l.hit[i] - 1)) + 1;
    };
    const auto material = [&r = r_, &view = view_, &l](std::size_t i) {
      return static_cast<float>(r.material_numbers[view.object_materials[l.hit[i] - 1]]);
    };
    if (r_.object_id) nearest("object_id", "X", object, 0);
    if (r_.material_id) nearest("material_id", "X", material, 0);
    if (r_.vector)
      add("Vector", "XYZW", kData, [&r = r_, &view = view_, &sums = sums_](std::size_t i, float* v) {
        write_motion_vector(r.neighbors, view, sums, i, v);
      });
    if (r_.guide_albedo) add_guide("denoise.albedo", "RGB", kLight, &kernel::GuideSum::albedo);
    if (r_.guide_normal) add_guide("denoise.normal", "XYZ", kVector, &kernel::GuideSum::normal);
    if (r_.halves) add_halves();
    for (const Matte& matte : r_.mattes) add_matte(matte);
  }

 private:
  using Values = std::function<void(std::size_t pixel, float* values)>;

  static float fraction(std::int64_t part, std::uint64_t whole) {
    return static_cast<float>(static_cast<double>(part) / static_cast<double>(whole));
  }

  static void append(std::vector<Plane>& planes, const std::string& layer, const char* channels, PlaneKind kind) {
    for (const char* c = channels; *c != 0; ++c) planes.push_back({(layer.empty() ? "" : layer + ".") + *c, {}, kind});
  }
  void add(const std::string& layer, const char* channels, PlaneKind kind, Values values) {
    out_.push_back({{}, std::move(values)});
    append(out_.back().planes, layer, channels, kind);
  }

  /// Means over all paths.
  void add_means(const char* layer, const char* channels, PlaneKind kind,
                 const base::ZeroVector<LayerSums::Channels>& sums) {
    add(layer, channels, kind, [&all = sums_, &sums](std::size_t i, float* v) {
      const auto paths = static_cast<std::int64_t>(all.paths(i));
      for (std::size_t k = 0; k < 3; ++k) v[k] = static_cast<float>(mean(sums[i][k], paths));
    });
  }

  /// The layers made from light events.
  void add_lights() {
    std::vector<std::function<float(const LightCells&, std::size_t channel)>> layers;
    std::vector<Plane> planes;
    const auto add_light = [&](const std::string& layer, auto value) {
      append(planes, layer, "RGB", PlaneKind::kLight);
      layers.push_back(value);
    };
    using enum kernel::Lobe;
    for (const auto& [requested, lobe] : {std::pair{r_.background, kBackground},
                                          {r_.diffuse, kDiffuseDirect},
                                          {r_.diffuse, kDiffuseIndirect},
                                          {r_.specular, kSpecularDirect},
                                          {r_.specular, kSpecularIndirect},
                                          {r_.transmission, kTransmissionDirect},
                                          {r_.transmission, kTransmissionIndirect},
                                          {r_.emission, kEmission}})
      if (requested)
        add_light(kLobeNames[static_cast<int>(lobe)],
                  [lobe = lobe](const LightCells& lights, std::size_t k) { return lights.of_lobe(lobe, k); });
    for (std::size_t g = 0; r_.light_groups && g < r_.groups.size(); ++g) {
      const LightGroup& group = r_.groups[g];
      if (!group.has_sources()) continue;
      add_light(group.name, [g](const LightCells& lights, std::size_t k) { return lights.of_group(g, k); });
      for (int i = 0; i < kernel::kLobes; ++i)
        if (const auto lobe = static_cast<kernel::Lobe>(i); group.has(lobe))
          add_light(group.name + "_" + kLobeNames[i],
                    [g, lobe](const LightCells& lights, std::size_t k) { return lights.of(g, lobe, k); });
    }
    out_.push_back({std::move(planes), [&r = r_, &sums = sums_, layers](std::size_t i, float* v) {
                      const std::size_t cells = r.light_cells();
                      const LightCells lights(r, {&sums.layers.light[i * cells], cells}, sums.sum(i));
                      for (const auto& value : layers)
                        for (std::size_t k = 0; k < 3; ++k) *v++ = value(lights, k);
                    }});
  }

  /// Means of a guide over both halves.
  void add_guide(const char* layer, const char* channels, PlaneKind kind, std::int64_t (kernel::GuideSum::*guide)[3]) {
    add(layer, channels, kind, [&sums = sums_, guide](std::size_t i, float* v) {
      kernel::GuideSum both = sums.guides_of(0, i);
      both += sums.guides_of(1, i);
      for (int k = 0; k < 3; ++k) v[k] = static_cast<float>(mean_guide((both.*guide)[k], both.weight));
    });
  }

  /// The two halves. They are data, so that they are stored in single precision: their difference is what matters. A
  /// half without paths is NaN, because 0 would be a valid measurement.
  void add_halves() {
    for (std::size_t half = 0; half < 2; ++half) {
      const std::string name = half == 0 ? "half_a" : "half_b";
      std::vector<Plane> planes;
      append(planes, name, "RGB", PlaneKind::kData);
      append(planes, name + ".albedo", "RGB", PlaneKind::kData);
      append(planes, name + ".normal", "XYZ", PlaneKind::kData);
      append(planes, name + ".inverse_depth", "X", PlaneKind::kData);
      out_.push_back({std::move(planes), [&sums = sums_, half](std::size_t i, float* v) {
                        const kernel::PixelSum light = sums.light_of(half, i);
                        const kernel::GuideSum guides = sums.guides_of(half, i);
                        const bool has_mean = light.weight > 0 && guides.weight > 0;
                        const auto put = [&](double value) { *v++ = static_cast<float>(has_mean ? value : kNoMean); };
                        for (const auto& sum : light.rgb) put(mean(sum, light.weight));
                        for (const std::int64_t sum : guides.albedo) put(mean_guide(sum, guides.weight));
                        for (const std::int64_t sum : guides.normal) put(mean_guide(sum, guides.weight));
                        put(mean(guides.inverse_depth, guides.weight));
                      }});
    }
  }

  /// A layer of four channels holds two ranks: id, coverage, id, coverage.
  void add_matte(const Matte& matte) {
    std::vector<Plane> planes;
    for (int layer = 0; 2 * layer < r_.matte_ranks; ++layer)
      append(planes, matte.name + static_cast<char>('0' + layer / 10) + static_cast<char>('0' + layer % 10), "RGBA",
             PlaneKind::kData);
    out_.push_back({std::move(planes), [&r = r_, &sums = sums_, &matte](std::size_t i, float* v) {
                      const std::vector<RankedCoverage> shares = ranked(r, matte, sums.layers.shares[i]);
                      for (int rank = 0; rank < r.matte_ranks + r.matte_ranks % 2; ++rank) {
                        const bool there = rank < r.matte_ranks && static_cast<std::size_t>(rank) < shares.size();
                        const RankedCoverage share = there ? shares[static_cast<std::size_t>(rank)] : RankedCoverage{};
                        *v++ = as_float(share.id);
                        *v++ = there ? fraction(share.weight, sums.paths(i)) : 0.0F;
                      }
                    }});
  }

  const LayerRequest& r_;
  const kernel::SceneView& view_;
  const Sums& sums_;
  std::vector<LayerPlanes> out_;
};

}  // namespace

std::vector<LayerPlanes> image_planes(const LayerRequest& request, const kernel::SceneView& view, const Sums& sums) {
  PlaneList list(request, view, sums);
  list.add_beauty();
  list.add_layers();
  return list.take();
}

std::vector<Plane> planes_of(const LayerRequest& request) {
  const Sums no_sums(0, 0);
  const kernel::SceneView no_scene;
  PlaneList list(request, no_scene, no_sums);
  list.add_layers();
  std::vector<Plane> planes;
  for (LayerPlanes& layer : list.take())
    std::move(layer.planes.begin(), layer.planes.end(), std::back_inserter(planes));
  return planes;
}

std::vector<DeepSample> deep_samples(const Sums& sums, std::size_t pixel, bool background_visible) {
  std::vector<DeepSample> out;
  std::vector<SphereCoverage> shares = sums.layers.shares[pixel];
  std::stable_sort(shares.begin(), shares.end(),
                   [](const SphereCoverage& a, const SphereCoverage& b) { return a.front < b.front; });
  auto left = static_cast<double>(sums.paths(pixel));  // paths that no sample so far covers
  for (const SphereCoverage& share : shares) {
    if (share.sphere == kernel::kNone && !background_visible) continue;
    DeepSample sample{};
    sample.front = static_cast<float>(share.front);
    sample.back = static_cast<float>(share.back);
    sample.alpha = static_cast<float>(static_cast<double>(share.weight) / left);
    for (int c = 0; c < 3; ++c) sample.rgb[c] = static_cast<float>(kernel::from_fixed_point(share.light[c]) / left);
    out.push_back(sample);
    left -= static_cast<double>(share.weight);
  }
  return out;
}

}  // namespace orrery::film
