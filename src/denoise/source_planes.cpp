// SPDX-License-Identifier: Apache-2.0
#include "denoise/source_planes.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <string_view>

namespace orrery::denoise {
namespace {

/// Radius of the windows over which variances are averaged, px: a single difference of two halves is a poor estimate.
constexpr int kBeautyNoiseRadius = 2, kGuideNoiseRadius = 1;

// Scale of the guides: the similarity of pixels whose guides differ by 1 in total is 0.
constexpr float kAlbedoScale = 2, kNormalScale = 1, kDepthScale = 0.5F;

/// Variance estimated from the image alone: the mean square of a second difference in x and y, which vanishes for
/// smooth images. The smallest of nine neighbouring windows is taken, since edges increase it.
///
/// Reference  immerkaer1996
Values variance_of_image(const Values& in, Frame frame) {
  const Values squares = frame.each([&](int x, int y) {
    float sum = 0;
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j)
        sum += static_cast<float>((i == 0 ? -2 : 1) * (j == 0 ? -2 : 1)) * usable(in[frame.at(x + i, y + j)]);
    return sum * sum / 36;
  });
  const Values means = window_means(squares, frame, kBeautyNoiseRadius);
  constexpr int kStep = kBeautyNoiseRadius + 1;
  return frame.each([&](int x, int y) {
    float least = means[frame.at(x, y)];
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j) least = std::min(least, means[frame.at(x + i * kStep, y + j * kStep)]);
    return least;
  });
}

/// Whether a picture has all channels of a layer.
bool has_channels(const film::Picture& picture, const std::string& layer, std::string_view letters) {
  return std::all_of(letters.begin(), letters.end(),
                     [&](char letter) { return picture.find(layer + "." + letter) != nullptr; });
}

/// Name of a guide in a half, its name as a layer, its channel and its scale.
struct GuideName {
  const char* of_half;
  const char* layer;
  char channel;
  float scale;
};
constexpr GuideName kGuideNames[kGuides] = {
    {"albedo", "denoise.albedo", 'R', kAlbedoScale}, {"albedo", "denoise.albedo", 'G', kAlbedoScale},
    {"albedo", "denoise.albedo", 'B', kAlbedoScale}, {"normal", "denoise.normal", 'X', kNormalScale},
    {"normal", "denoise.normal", 'Y', kNormalScale}, {"normal", "denoise.normal", 'Z', kNormalScale},
    {"inverse_depth", "depth", 'X', kDepthScale}};

/// The scale that makes the mean of an inverse depth `scale`.
float relative_scale(const Values& inverse_depth, float scale) {
  double sum = 0;
  for (const float v : inverse_depth) sum += static_cast<double>(usable(v));
  return sum > 0 ? static_cast<float>(scale * static_cast<double>(inverse_depth.size()) / sum) : 0.0F;
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

void add_guides_of_halves(SourcePlanes& out, HalfPlanes& planes, Frame frame) {
  Values squared_errors(frame.pixels());
  for (const GuideName& name : kGuideNames) {
    const std::string end = std::string(".") + name.of_half + "." + name.channel;
    HalfPair both = planes.of(end, name.scale);
    const Values &a = *both.a, &b = *both.b;
    const Values mean = frame.each_index([&](std::size_t i) { return (usable(a[i]) + usable(b[i])) / 2; });
    if (name.scale == kDepthScale) both.scale = relative_scale(mean, name.scale);
    if (out.has_halves) add_squared_errors(both, frame, squared_errors);
    planes.release(end);
    out.guides.push_back(padded(mean, frame, both.scale));
  }
  out.guide_variance = padded(window_means(squared_errors, frame, kGuideNoiseRadius), frame);
}

void add_guides_of_layers(SourcePlanes& out, const film::Picture& picture, Frame frame) {
  for (const GuideName& name : kGuideNames) {
    const film::Plane* const plane = picture.find(std::string(name.layer) + "." + name.channel);
    if (name.scale != kDepthScale) {
      out.guides.push_back(padded(plane->values, frame, name.scale));
    } else if (plane == nullptr) {
      out.guides.emplace_back(frame.width, frame.height);
    } else {
      const Values& depth = plane->values;
      const Values inverse = frame.each_index([&](std::size_t i) { return depth[i] > 0 ? 1 / depth[i] : 0; });
      out.guides.push_back(padded(inverse, frame, relative_scale(inverse, name.scale)));
    }
  }
  out.guide_variance = PaddedPlane(frame.width, frame.height);
}

/// Variance of the beauty without halves, from the layer `variance` or from the image itself; sum over the channels.
Values variance_without_halves(const film::Picture& picture, bool has_variance, Frame frame) {
  Values sum(frame.pixels());
  for (const std::string letter : {"R", "G", "B"}) {
    const Values variance = has_variance
                                ? window_means(picture.at("variance." + letter).values, frame, kBeautyNoiseRadius)
                                : variance_of_image(picture.at(letter).values, frame);
    sum = frame.each_index([&](std::size_t i) { return sum[i] + variance[i]; });
  }
  return sum;
}

/// Reduces an outlier to the light that both halves contain.
void reduce(SourcePlanes& planes, Frame frame, const Outlier& outlier) {
  const int x = frame.x(outlier.pixel), y = frame.y(outlier.pixel);
  for (std::size_t c = 0; c < 3; ++c) {
    scale_pixel(planes.beauty[c], frame, outlier.pixel, outlier.factors[c]);
    PaddedPlane &of_bright = outlier.is_in_a ? planes.a[c] : planes.b[c],
                &of_dark = outlier.is_in_a ? planes.b[c] : planes.a[c];
    const float bright = *of_bright.at(x, y), dark = *of_dark.at(x, y);
    if (bright != 0) scale_pixel(of_bright, frame, outlier.pixel, (dark + outlier.kept * (bright - dark)) / bright);
  }
}

/// The pixels to filter: 1, or 0 where the beauty is not finite or no half has samples.
PaddedPlane valid_pixels(const film::Picture& picture, HalfCounts counts, Frame frame) {
  PaddedPlane valid(frame.width, frame.height);
  tbb::parallel_for(0, frame.height, [&](int y) {
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

SourcePlanes source_planes(film::Picture& picture, bool keeps_halves) {
  SourcePlanes out;
  const Frame frame{picture.width, picture.height};
  const auto has_half = [&](const std::string& half) {
    return has_channels(picture, half, "RGB") && has_channels(picture, half + ".albedo", "RGB") &&
           has_channels(picture, half + ".normal", "XYZ") && has_channels(picture, half + ".inverse_depth", "X");
  };
  const bool has_planes = has_half("half_a") && has_half("half_b");
  const HalfCounts counts = has_planes ? count_halves(picture, frame) : HalfCounts();
  const double lone = static_cast<double>(counts.with_one) / static_cast<double>(frame.pixels());
  out.has_halves = has_planes && lone <= kMaxLonePixels;
  out.valid = valid_pixels(picture, counts, frame);
  HalfPlanes half_planes(picture, counts, keeps_halves, frame);
  const bool has_variance = has_channels(picture, "variance", "RGB");
  if (out.has_halves) {
    const std::vector<HalfPair> halves = {half_planes.of(".R"), half_planes.of(".G"), half_planes.of(".B")};
    out.outliers = find_outliers(halves, frame);
    out.variance = padded(variance_of(halves, frame, kBeautyNoiseRadius, &out.outliers.limits), frame);
    for (std::size_t c = 0; c < 3; ++c) {
      out.a[c] = padded(*halves[c].a, frame);
      out.b[c] = padded(*halves[c].b, frame);
      half_planes.release(std::string(".") + "RGB"[c]);
    }
  } else {
    out.variance = padded(variance_without_halves(picture, has_variance, frame), frame);
    out.missing.push_back(has_planes ? "halves (one half has no samples)" : "halves");
  }
  for (std::size_t c = 0; c < 3; ++c) out.beauty[c] = padded(picture.at(std::string(1, "RGB"[c])).values, frame);
  for (const Outlier& outlier : out.outliers.pixels) reduce(out, frame, outlier);
  if (has_planes) {
    add_guides_of_halves(out, half_planes, frame);
  } else {
    if (!has_variance) out.missing.push_back("variance");
    const bool has_albedo = has_channels(picture, "denoise.albedo", "RGB"),
               has_normal = has_channels(picture, "denoise.normal", "XYZ");
    if (!has_albedo) out.missing.push_back("denoise.albedo");
    if (!has_normal) out.missing.push_back("denoise.normal");
    if (!has_channels(picture, "depth", "X")) out.missing.push_back("depth");
    if (has_albedo && has_normal) add_guides_of_layers(out, picture, frame);
  }
  if (!keeps_halves) std::erase_if(picture.planes, [](const film::Plane& plane) { return film::is_half(plane.name); });
  return out;
}

}  // namespace orrery::denoise
