// SPDX-License-Identifier: Apache-2.0
#include "display/develop.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <fmt/core.h>

#include "base/error.h"
#include "base/stop_point.h"
#include "display/settings.h"
#include "display/view.h"
#include "film/picture.h"
#include "math/pixels.h"
#include "math/vec3.h"

namespace orrery::display {
namespace {

namespace ocio = OCIO_NAMESPACE;

/// Pixels transformed at a time: they fit into the L2 cache, and large images are not copied as a whole.
constexpr std::size_t kPixelsAtATime = std::size_t{1} << 14;

/// Limit of the exposure: beyond it every half is black or white. Keeps the gain within the range of float.
constexpr double kMaxGainStops = 120;

const std::vector<float>& plane(const film::Picture& picture, const char* name) {
  const std::vector<float>& values = picture.at(name).values;
  if (values.size() != math::pixel_count(picture.width, picture.height))
    throw base::Error(base::ErrorKind::kInternal, fmt::format("plane {} does not have the image's size", name));
  return values;
}

float gain_of(const Settings& settings) {
  return static_cast<float>(std::exp2(std::clamp(settings.stops(), -kMaxGainStops, kMaxGainStops)));
}

/// Applies the gain and clamps to the range of half, since beyond it a view's curves can overflow to NaN.
float fit(float v, float gain) {
  if (!std::isfinite(v)) return 0;
  return std::clamp(v * gain, -film::kLargestHalf, film::kLargestHalf);
}

/// Divides a premultiplied value by alpha; 0 if alpha is 0.
float unmultiplied(float v, float alpha) { return alpha > 0 ? v / alpha : 0.0f; }

/// Applies a display transform to pixels, R, G, B each, with the gain.
///
/// `coverage` of each pixel by objects in front of the backdrop; null: unknown
void apply(const View& view, float* rgb, const float* coverage, std::size_t pixels, const Settings& settings,
           float gain) {
  const auto transform = [pixels](const ocio::ConstCPUProcessorRcPtr& processor, float* values) {
    ocio::PackedImageDesc image(values, static_cast<long>(pixels), 1, 3);
    processor->apply(image);
  };
  if (!view.page || coverage == nullptr) return transform(view.processor, rgb);
  // A pixel is objects over backdrop. The looks of the view apply to the colour of the objects alone.
  std::vector<float> objects(3 * pixels);
  const math::Vec3d& backdrop = *settings.backdrop;
  const float behind[3] = {fit(static_cast<float>(backdrop.x), gain), fit(static_cast<float>(backdrop.y), gain),
                           fit(static_cast<float>(backdrop.z), gain)};
  for (std::size_t i = 0; i < 3 * pixels; ++i) {
    const float of_page = (1 - coverage[i / 3]) * behind[i % 3];
    objects[i] = unmultiplied(rgb[i] - of_page, coverage[i / 3]);
  }
  std::vector<float> looked = objects;
  transform(view.looks, looked.data());
  for (std::size_t i = 0; i < 3 * pixels; ++i) rgb[i] += (looked[i] - objects[i]) * coverage[i / 3];
  transform(view.page, rgb);
}

std::uint16_t quantised(float v, double largest) {
  const double shown = v > 0 ? std::min(static_cast<double>(v), 1.0) : 0.0;  // NaN is not > 0
  return static_cast<std::uint16_t>(std::clamp(shown * largest + 0.5, 0.0, largest));
}

}  // namespace

Choice choose(const Settings& settings) { return find_view(settings).choice; }

film::EncodedPicture develop(const film::Picture& picture, const Settings& settings, int bits, Alpha alpha) {
  if (bits != 8 && bits != 16) throw base::Error(base::ErrorKind::kInternal, "a developed image has 8 or 16 bits");
  const std::vector<float>* const planes[3] = {&plane(picture, "R"), &plane(picture, "G"), &plane(picture, "B")};
  const View view = find_view(settings);
  const std::size_t pixels = planes[0]->size();
  film::EncodedPicture out;
  out.width = picture.width;
  out.height = picture.height;
  out.bits = bits;
  out.is_srgb = view.is_srgb;
  const float* const covered = alpha == Alpha::kStraight ? plane(picture, "A").data() : nullptr;
  out.channels = covered != nullptr ? 4 : 3;
  const auto channels = static_cast<std::size_t>(out.channels);
  out.values.resize(pixels * channels);
  const double largest = bits == 8 ? 255 : 65535;
  const float gain = gain_of(settings);
  const bool over_page = covered == nullptr && !picture.coverage.empty();
  std::vector<float> rgb(std::min(pixels, kPixelsAtATime) * 3);
  const base::StopPoint stop;
  for (std::size_t begin = 0; begin < pixels; begin += kPixelsAtATime) {
    stop.check();
    const std::size_t count = std::min(kPixelsAtATime, pixels - begin);
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t c = 0; c < 3; ++c) {
        const float v = (*planes[c])[begin + i];
        rgb[i * 3 + c] = fit(covered != nullptr ? unmultiplied(v, covered[begin + i]) : v, gain);
      }
    apply(view, rgb.data(), over_page ? &picture.coverage[begin] : nullptr, count, settings, gain);
    for (std::size_t i = 0; i < count; ++i) {
      std::uint16_t* const pixel = &out.values[(begin + i) * channels];
      for (std::size_t c = 0; c < 3; ++c) pixel[c] = quantised(rgb[i * 3 + c], largest);
      if (covered != nullptr) pixel[3] = quantised(covered[begin + i], largest);
    }
  }
  return out;
}

struct PixelDeveloper::Impl {
  Settings settings;
  View view;
  float gain;
};

PixelDeveloper::PixelDeveloper(const Settings& settings)
    : impl_(std::make_unique<Impl>(Impl{settings, find_view(settings), gain_of(settings)})) {}
PixelDeveloper::~PixelDeveloper() = default;

void PixelDeveloper::operator()(float* rgb, const float* coverage, std::size_t pixels, std::uint8_t* codes) const {
  for (std::size_t i = 0; i < 3 * pixels; ++i) rgb[i] = fit(rgb[i], impl_->gain);
  apply(impl_->view, rgb, coverage, pixels, impl_->settings, impl_->gain);
  for (std::size_t i = 0; i < 3 * pixels; ++i) codes[i] = static_cast<std::uint8_t>(quantised(rgb[i], 255));
}

std::string ocio_version() { return ocio::GetVersion(); }

}  // namespace orrery::display
