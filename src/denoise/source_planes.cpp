// SPDX-License-Identifier: Apache-2.0
#include "denoise/source_planes.h"

#include <cmath>
#include <cstddef>
#include <deque>
#include <optional>
#include <string>

#include "base/error.h"
#include "base/stop_point.h"
#include "film/layer_planes.h"
#include "film/layers.h"

namespace orrery::denoise {
namespace {

/// Radius of the windows over which variances are averaged, px: a single difference of two halves is a poor estimate.
constexpr int kBeautyNoiseRadius = 2, kGuideNoiseRadius = 1;

// Scale of the guides: the similarity of pixels whose guides differ by 1 in total is 0.
constexpr float kAlbedoScale = 1.4F, kNormalScale = 0.7F, kDepthScale = 0.35F;

/// Suffix of a guide's channel in each half, and its scale.
struct GuideName {
  const char* end;
  float scale;
};
constexpr GuideName kGuideNames[kGuides] = {{".albedo.R", kAlbedoScale},      {".albedo.G", kAlbedoScale},
                                            {".albedo.B", kAlbedoScale},      {".normal.X", kNormalScale},
                                            {".normal.Y", kNormalScale},      {".normal.Z", kNormalScale},
                                            {".inverse_depth.X", kDepthScale}};

/// The scale that makes the mean of an inverse depth `scale`.
float relative_scale(const Values& inverse_depth, float scale) {
  double sum = 0;
  for (const float v : inverse_depth) sum += static_cast<double>(usable(v));
  return sum > 0 ? static_cast<float>(scale * static_cast<double>(inverse_depth.size()) / sum) : 0.0F;
}

void require_halves(const film::Picture& picture) {
  film::LayerRequest request;
  request.halves = true;
  for (const film::Plane& plane : film::planes_of(request))
    if (picture.find(plane.name) == nullptr)
      throw base::Error(base::ErrorKind::kBadData, "the image has no channel " + plane.name +
                                                       ", from which noise is measured; render it with --layers "
                                                       "halves, or with --denoise");
}

/// Pixels classified by which halves have samples. A half without samples is NaN.
struct HalfCounts {
  std::size_t with_one = 0, with_none = 0;
};

/// Maximum fraction of pixels with a single half: with more, the halves do not describe the noise reliably.
constexpr double kMaxLonePixels = 1.0 / 16;

HalfCounts count_halves(const film::Picture& picture, Frame frame) {
  const Values &a = picture.at("half_a.inverse_depth.X").values, &b = picture.at("half_b.inverse_depth.X").values;
  HalfCounts out;
  for (std::size_t i = 0; i < frame.pixels(); ++i) {
    out.with_one += std::isnan(a[i]) != std::isnan(b[i]) ? 1 : 0;
    out.with_none += std::isnan(a[i]) && std::isnan(b[i]) ? 1 : 0;
  }
  return out;
}

/// The halves of a channel. Where one has no samples, it is replaced by the other.
class HalfPlanes {
 public:
  HalfPlanes(film::Picture& picture, HalfCounts counts, bool keeps, Frame frame)
      : picture_(picture), counts_(counts), keeps_(keeps), frame_(frame) {}

  /// `end`      suffix of the names, such as ".albedo.R"
  /// Result     valid until release()
  HalfPair of(const std::string& end, float scale = 1) {
    const Values &a = picture_.at("half_a" + end).values, &b = picture_.at("half_b" + end).values;
    return counts_.with_one == 0 ? HalfPair{&a, &b, scale} : HalfPair{&filled(a, b), &filled(b, a), scale};
  }

  /// Frees the memory of a channel, unless the picture keeps its halves.
  ///
  /// Domain     in the order of of()
  void release(const std::string& end) {
    for (const std::string half : {"half_a", "half_b"}) {
      if (!filled_.empty()) filled_.pop_front();
      if (keeps_) continue;
      for (film::Plane& plane : picture_.planes)
        if (plane.name == half + end) plane.values = Values();
    }
  }

 private:
  const Values& filled(const Values& own, const Values& other) {
    return filled_.emplace_back(
        frame_.each_index([&](std::size_t i) { return std::isnan(own[i]) ? other[i] : own[i]; }));
  }

  film::Picture& picture_;
  HalfCounts counts_;
  bool keeps_;
  Frame frame_;
  std::deque<Values> filled_;
};

void add_guides(SourcePlanes& out, HalfPlanes& planes, Frame frame) {
  Values squared_errors(frame.pixels());
  for (const GuideName& name : kGuideNames) {
    HalfPair both = planes.of(name.end, name.scale);
    const Values &a = *both.a, &b = *both.b;
    const Values mean = frame.each_index([&](std::size_t i) { return (usable(a[i]) + usable(b[i])) / 2; });
    if (name.scale == kDepthScale) both.scale = relative_scale(mean, name.scale);
    add_squared_errors(both, frame, squared_errors);
    planes.release(name.end);
    out.guides.push_back(padded(mean, frame, both.scale));
  }
  out.guide_variance = padded(window_means(squared_errors, frame, kGuideNoiseRadius), frame);
}

/// Reduces an outlier of the halves to the light that both contain.
void reduce(SourcePlanes& planes, Frame frame, const Outlier& outlier) {
  const int x = frame.x(outlier.pixel), y = frame.y(outlier.pixel);
  for (std::size_t c = 0; c < 3; ++c) {
    PaddedPlane &of_bright = outlier.is_in_a ? planes.a[c] : planes.b[c],
                &of_dark = outlier.is_in_a ? planes.b[c] : planes.a[c];
    const float bright = *of_bright.at(x, y), dark = *of_dark.at(x, y);
    if (bright != 0) scale_pixel(of_bright, frame, outlier.pixel, (dark + outlier.kept * (bright - dark)) / bright);
  }
}

/// The pixels to filter: 1, or 0 where the beauty is not finite or no half has samples.
PaddedPlane valid_pixels(const film::Picture& picture, HalfCounts counts, Frame frame) {
  PaddedPlane valid(frame.width, frame.height);
  frame.each_row([&](int y) {
    for (int x = 0; x < frame.width; ++x) *valid.at(x, y) = 1;
    for (const char* name : {"R", "G", "B"}) {
      const float* const row = picture.at(name).values.data() + frame.at(0, y);
      for (int x = 0; x < frame.width; ++x)
        if (!is_usable(row[x])) *valid.at(x, y) = 0;
    }
    if (counts.with_none == 0) return;
    const float* const a = picture.at("half_a.inverse_depth.X").values.data() + frame.at(0, y);
    const float* const b = picture.at("half_b.inverse_depth.X").values.data() + frame.at(0, y);
    for (int x = 0; x < frame.width; ++x)
      if (std::isnan(a[x]) && std::isnan(b[x])) *valid.at(x, y) = 0;
  });
  return valid;
}

}  // namespace

std::optional<SourcePlanes> source_planes(film::Picture& picture, bool keeps_halves) {
  require_halves(picture);
  SourcePlanes out;
  const base::StopPoint stop;
  const Frame frame{picture.width, picture.height, &stop};
  const HalfCounts counts = count_halves(picture, frame);
  if (static_cast<double>(counts.with_one) > kMaxLonePixels * static_cast<double>(frame.pixels())) return {};
  out.valid = valid_pixels(picture, counts, frame);
  HalfPlanes half_planes(picture, counts, keeps_halves, frame);
  const std::vector<HalfPair> halves = {half_planes.of(".R"), half_planes.of(".G"), half_planes.of(".B")};
  out.outliers = find_outliers(halves, frame);
  out.variance = padded(variance_of(halves, frame, kBeautyNoiseRadius, &out.outliers.limits), frame);
  for (std::size_t c = 0; c < 3; ++c) {
    out.a[c] = padded(*halves[c].a, frame);
    out.b[c] = padded(*halves[c].b, frame);
    half_planes.release(std::string(".") + "RGB"[c]);
  }
  for (const Outlier& outlier : out.outliers.pixels) reduce(out, frame, outlier);
  add_guides(out, half_planes, frame);
  return out;
}

}  // namespace orrery::denoise
