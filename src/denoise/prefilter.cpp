// SPDX-License-Identifier: Apache-2.0
#include "denoise/prefilter.h"

#include "denoise/source_planes.h"
#include "denoise/tiles.h"

namespace orrery::denoise {
namespace {

/// Squared differences of patches, in units of the variance, at which their similarity becomes 0.
constexpr float kGuideTolerance = 4, kVarianceTolerance = 5;

/// Radius of the windows, px. Guides are less noisy than the beauty. A larger window for the halves would blur shadows
/// before the final weights can distinguish them.
constexpr int kGuideRadius = 2, kRadius = 1;

/// Radius of the windows over which the variance of the filtered halves is averaged, px: they differ over larger areas
/// than the noisy ones.
constexpr int kNoiseRadius = 3;
/// Distance of the windows among which the smallest variance is taken, px. At an edge between noisy and clean light,
/// that window is on the pixel's side or on the cleaner one.
constexpr int kNoiseStep = 2;

/// Minimum variance of filtered halves, as a fraction of the unfiltered variance: halves can be equal by chance.
constexpr float kMinVariance = 0.06F;

/// Filters planes with the same weights.
std::vector<Values> filtered(const WeightSource& source, const std::vector<const PaddedPlane*>& planes, Frame frame,
                             Tiles& tiles) {
  std::vector<Values> out(planes.size());
  tbb::parallel_for(std::size_t{0}, out.size(), [&](std::size_t i) { out[i].resize(frame.pixels()); });
  tiles.each([&](Worker& worker, int x, int y) {
    compute_weights(source, x, y, worker.scratch, worker.weights);
    for (std::size_t i = 0; i < planes.size(); ++i) {
      apply_weights(worker.weights, source.radius, *planes[i], x, y, worker.pixels);
      tiles.each_pixel(x, y, [&](std::size_t in_tile, int column, int row) {
        out[i][frame.at(column, row)] = worker.pixels[in_tile];
      });
    }
  });
  return out;
}

}  // namespace

std::vector<PaddedPlane> filtered_guides(const SourcePlanes& planes, Frame frame, Tiles& tiles) {
  WeightSource source;
  source.radius = kGuideRadius;
  source.tolerance = kGuideTolerance;
  source.valid = &planes.valid;
  source.variance = &planes.guide_variance;
  std::vector<const PaddedPlane*> noisy;
  for (const PaddedPlane& guide : planes.guides) {
    source.compared.push_back({&guide, &guide});
    noisy.push_back(&guide);
  }
  std::vector<PaddedPlane> out;
  for (const Values& values : filtered(source, noisy, frame, tiles)) out.push_back(padded(values, frame));
  return out;
}

FilteredHalves filtered_halves(const SourcePlanes& planes, const std::vector<PaddedPlane>& guides, Frame frame,
                               Tiles& tiles) {
  WeightSource source;
  source.radius = kRadius;
  source.tolerance = kVarianceTolerance;
  source.valid = &planes.valid;
  source.variance = &planes.variance;
  for (const PaddedPlane& guide : guides) source.guides.push_back(&guide);
  source.guide_variance = &planes.guide_variance;
  std::vector<const PaddedPlane*> noisy;
  for (std::size_t c = 0; c < 3; ++c) {
    source.compared.push_back({&planes.a[c], &planes.b[c]});
    noisy.insert(noisy.end(), {&planes.a[c], &planes.b[c]});
  }
  const std::vector<Values> clean = filtered(source, noisy, frame, tiles);
  FilteredHalves out;
  std::vector<HalfPair> halves;
  for (std::size_t c = 0; c < 3; ++c) {
    const Values &a = clean[2 * c], &b = clean[2 * c + 1];
    out.a[c] = padded(a, frame);
    out.b[c] = padded(b, frame);
    halves.push_back({&a, &b});
  }
  const Values variance =
      least_around(variance_of(halves, frame, kNoiseRadius, &planes.outliers.limits), frame, kNoiseStep);
  out.variance = padded(
      frame.each([&](int x, int y) { return variance[frame.at(x, y)] + kMinVariance * *planes.variance.at(x, y); }),
      frame);
  return out;
}

}  // namespace orrery::denoise
