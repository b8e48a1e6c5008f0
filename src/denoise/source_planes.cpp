// SPDX-License-Identifier: Apache-2.0
#include "denoise/source_planes.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace orrery::denoise {
namespace {

using Values = std::vector<float>;

/// Larger values would overflow when squared.
constexpr float kLargest = 0x1p40F;

/// Radius of the windows over which variances are averaged, px: a single difference of two halves is a poor estimate.
constexpr int kBeautyNoiseRadius = 2, kGuideNoiseRadius = 1;

// Scale of the guides: pixels whose guides differ by 1 in total have nothing in common.
constexpr float kAlbedoScale = 2, kNormalScale = 1, kDepthScale = 0.5F;

bool is_usable(float v) { return std::abs(v) <= kLargest; }
float usable(float v) { return is_usable(v) ? v : 0; }

/// Rows of an image and the indices of its pixels.
struct Frame {
  int width, height;

  std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
  /// Index of the pixel nearest to a place.
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(std::clamp(y, 0, height - 1)) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(std::clamp(x, 0, width - 1));
  }
  template <class F>
  Values each(F f) const {
    Values out(pixels());
    tbb::parallel_for(0, height, [&](int y) {
      for (int x = 0; x < width; ++x) out[at(x, y)] = f(x, y);
    });
    return out;
  }
};

/// Means over square windows.
Values window_means(const Values& in, Frame frame, int radius) {
  const auto mean = [radius](auto at) {
    float sum = 0;
    for (int i = -radius; i <= radius; ++i) sum += at(i);
    return sum / static_cast<float>(2 * radius + 1);
  };
  const Values rows = frame.each([&](int x, int y) { return mean([&](int i) { return in[frame.at(x + i, y)]; }); });
  return frame.each([&](int x, int y) { return mean([&](int i) { return rows[frame.at(x, y + i)]; }); });
}

/// Variance of the mean of two halves.
Values variance_of(const Values& a, const Values& b, Frame frame, int radius) {
  const Values squares = frame.each([&](int x, int y) {
    const float difference = usable(a[frame.at(x, y)]) - usable(b[frame.at(x, y)]);
    return difference * difference / 4;
  });
  return window_means(squares, frame, radius);
}

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

/// The planes of a picture by name.
class Planes {
 public:
  explicit Planes(const film::Picture& picture) : picture_(picture) {}

  const Values* find(const std::string& name) const {
    const film::Plane* const plane = picture_.find(name);
    return plane != nullptr ? &plane->values : nullptr;
  }
  const Values& at(const std::string& name) const { return *find(name); }
  bool has(const std::string& layer, const char* letters) const {
    for (const char* c = letters; *c != 0; ++c)
      if (find(layer + "." + *c) == nullptr) return false;
    return true;
  }

 private:
  const film::Picture& picture_;
};

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

void add_guide(SourcePlanes& out, const Values& value, const Values& variance, Frame frame, float scale) {
  out.guides.push_back(padded(value, frame.width, frame.height, scale));
  out.guide_variance.push_back(padded(variance, frame.width, frame.height, scale * scale));
}

void add_guides_of_halves(SourcePlanes& out, const Planes& planes, Frame frame) {
  for (const GuideName& name : kGuideNames) {
    const std::string end = std::string(".") + name.of_half + "." + name.channel;
    const Values &a = planes.at("half_a" + end), &b = planes.at("half_b" + end);
    const Values mean =
        frame.each([&](int x, int y) { return (usable(a[frame.at(x, y)]) + usable(b[frame.at(x, y)])) / 2; });
    const bool is_depth = name.scale == kDepthScale;
    add_guide(out, mean, variance_of(a, b, frame, kGuideNoiseRadius), frame,
              is_depth ? relative_scale(mean, name.scale) : name.scale);
  }
}

void add_guides_of_layers(SourcePlanes& out, const Planes& planes, Frame frame) {
  const Values none(frame.pixels());
  for (const GuideName& name : kGuideNames) {
    const Values* const plane = planes.find(std::string(name.layer) + "." + name.channel);
    if (name.scale != kDepthScale) {
      add_guide(out, *plane, none, frame, name.scale);
    } else if (plane == nullptr) {
      add_guide(out, none, none, frame, 1);
    } else {
      const Values inverse = frame.each([&](int x, int y) {
        const float depth = (*plane)[frame.at(x, y)];
        return depth > 0 ? 1 / depth : 0;
      });
      add_guide(out, inverse, none, frame, relative_scale(inverse, name.scale));
    }
  }
}

/// The sum of planes, border included.
PaddedPlane sum_of(const std::vector<PaddedPlane>& planes, Frame frame) {
  PaddedPlane out(frame.width, frame.height);
  constexpr int kBorder = PaddedPlane::kBorder;
  tbb::parallel_for(-kBorder, frame.height + kBorder, [&](int y) {
    for (const PaddedPlane& plane : planes)
      for (int x = -kBorder; x < frame.width + kBorder; ++x) *out.at(x, y) += *plane.at(x, y);
  });
  return out;
}

}  // namespace

PaddedPlane padded(const std::vector<float>& values, int width_px, int height_px, float scale) {
  PaddedPlane out(width_px, height_px);
  constexpr int kBorder = PaddedPlane::kBorder;
  const Frame frame{width_px, height_px};
  tbb::parallel_for(-kBorder, height_px + kBorder, [&](int y) {
    for (int x = -kBorder; x < width_px + kBorder; ++x) *out.at(x, y) = usable(values[frame.at(x, y)]) * scale;
  });
  return out;
}

SourcePlanes source_planes(const film::Picture& picture) {
  SourcePlanes out;
  const Frame frame{picture.width, picture.height};
  const Planes planes(picture);
  const auto add = [&](const Values& values) { return padded(values, frame.width, frame.height); };
  const auto has_half = [&](const std::string& half) {
    return planes.has(half, "RGB") && planes.has(half + ".albedo", "RGB") && planes.has(half + ".normal", "XYZ") &&
           planes.has(half + ".inverse_depth", "X");
  };
  out.has_halves = has_half("half_a") && has_half("half_b");
  const bool has_variance = planes.has("variance", "RGB");
  for (std::size_t c = 0; c < 3; ++c) {
    const std::string letter(1, "RGB"[c]);
    const Values& beauty = planes.at(letter);
    out.beauty[c] = add(beauty);
    if (out.has_halves) {
      const Values &a = planes.at("half_a." + letter), &b = planes.at("half_b." + letter);
      out.a[c] = add(a);
      out.b[c] = add(b);
      out.variance[c] = add(variance_of(a, b, frame, kBeautyNoiseRadius));
    } else if (has_variance) {
      out.variance[c] = add(window_means(planes.at("variance." + letter), frame, kBeautyNoiseRadius));
    } else {
      out.variance[c] = add(variance_of_image(beauty, frame));
    }
  }
  if (out.has_halves) {
    add_guides_of_halves(out, planes, frame);
  } else {
    out.missing.push_back("halves");
    if (!has_variance) out.missing.push_back("variance");
    const bool has_albedo = planes.has("denoise.albedo", "RGB"), has_normal = planes.has("denoise.normal", "XYZ");
    if (!has_albedo) out.missing.push_back("denoise.albedo");
    if (!has_normal) out.missing.push_back("denoise.normal");
    if (!planes.has("depth", "X")) out.missing.push_back("depth");
    if (has_albedo && has_normal) add_guides_of_layers(out, planes, frame);
  }
  out.total_guide_variance = sum_of(out.guide_variance, frame);
  out.valid = PaddedPlane(frame.width, frame.height);
  tbb::parallel_for(0, frame.height, [&](int y) {
    for (int x = 0; x < frame.width; ++x) {
      bool good = true;
      for (const char* name : {"R", "G", "B"}) good = good && is_usable(planes.at(name)[frame.at(x, y)]);
      *out.valid.at(x, y) = good ? 1.0F : 0.0F;
    }
  });
  return out;
}

}  // namespace orrery::denoise
