// SPDX-License-Identifier: Apache-2.0
#include "display/bake.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include <fmt/core.h>

#include "display/settings.h"
#include "display/view.h"

namespace orrery::display {
namespace {

namespace ocio = OCIO_NAMESPACE;

/// Range of the shaper: stops below and above mid grey, evenly spaced so that highlights keep their colour.
constexpr double kMidGrey = 0.18;
constexpr double kStopsBelow = 7, kStopsAbove = 7;
constexpr int kShaperSize = 65536;

/// The radiance at position `x` (0..1) along an edge of the cube. Linear near black, so that 0 maps to 0.
double light_at(double x) {
  const double darkest = std::exp2(-kStopsBelow), brightest = std::exp2(kStopsAbove);
  // a (b^x - 1) rises from 0 to `brightest`. At 0 its slope is that of a curve with `darkest` per stop.
  const double base = brightest / darkest;
  return kMidGrey * darkest * (std::pow(base, x) - 1) * brightest / (brightest - darkest);
}

/// The position of a radiance along an edge of the cube; the inverse of light_at.
double place_of(double light) {
  const double darkest = std::exp2(-kStopsBelow), brightest = std::exp2(kStopsAbove);
  const double scaled = light * (brightest - darkest) / (kMidGrey * darkest * brightest);
  return std::log(scaled + 1) / std::log(brightest / darkest);
}

std::string row_text(double r, double g, double b) {
  return fmt::format("{:.7f} {:.7f} {:.7f}\n", static_cast<float>(r), static_cast<float>(g), static_cast<float>(b));
}

std::string title(const View& view, const Settings& settings) {
  return fmt::format("{} to {}, {}", settings.working_space, view.choice.display, view.choice.view);
}

/// A view as LUTs: scale, one-dimensional shaper, cube.
struct Tables {
  double scale;
  std::vector<double> shaper;
  int size;                 ///< points along each edge of the cube
  std::vector<float> cube;  ///< R G B, red varies fastest
};

Tables tabulated(const View& view, const Settings& settings, int size) {
  const double end = light_at(1), gain = std::exp2(settings.stops());
  Tables out{1 / end, {}, size, {}};
  for (int i = 0; i < kShaperSize; ++i)
    out.shaper.push_back(std::clamp(place_of(end * i / (kShaperSize - 1)), 0.0, 1.0));
  const auto at = [&](int i) { return static_cast<float>(light_at(static_cast<double>(i) / (size - 1)) * gain); };
  for (int b = 0; b < size; ++b)
    for (int g = 0; g < size; ++g)
      for (int r = 0; r < size; ++r) out.cube.insert(out.cube.end(), {at(r), at(g), at(b)});
  ocio::PackedImageDesc all(out.cube.data(), size, static_cast<long>(size) * size, 3);
  view.processor->apply(all);
  return out;
}

ocio::MatrixTransformRcPtr scaling(double s) {
  auto matrix = ocio::MatrixTransform::Create();
  const double m[16] = {s, 0, 0, 0, 0, s, 0, 0, 0, 0, s, 0, 0, 0, 0, 1};
  matrix->setMatrix(m);
  return matrix;
}

/// The transforms of a view including the exposure.
ocio::GroupTransformRcPtr steps(const View& view, const Settings& settings) {
  auto group = view.transform->getOptimizedProcessor(ocio::OPTIMIZATION_LOSSLESS)->createGroupTransform();
  if (settings.stops() != 0) group->prependTransform(scaling(std::exp2(settings.stops())));
  return group;
}

ocio::GroupTransformRcPtr tables_as_steps(const Tables& tables) {
  auto group = ocio::GroupTransform::Create();
  group->appendTransform(scaling(tables.scale));
  auto shaper = ocio::Lut1DTransform::Create(tables.shaper.size(), false);
  for (std::size_t i = 0; i < tables.shaper.size(); ++i) {
    const auto v = static_cast<float>(tables.shaper[i]);
    shaper->setValue(i, v, v, v);
  }
  group->appendTransform(shaper);
  const auto size = static_cast<unsigned long>(tables.size);
  auto cube = ocio::Lut3DTransform::Create(size);
  cube->setInterpolation(ocio::INTERP_TETRAHEDRAL);
  const float* rgb = tables.cube.data();
  for (unsigned long b = 0; b < size; ++b)
    for (unsigned long g = 0; g < size; ++g)
      for (unsigned long r = 0; r < size; ++r, rgb += 3) cube->setValue(r, g, b, rgb[0], rgb[1], rgb[2]);
  group->appendTransform(cube);
  return group;
}

std::string clf_text(const ocio::GroupTransformRcPtr& group, const std::string& description) {
  group->getFormatMetadata().addAttribute(ocio::METADATA_ID, "orrery");
  group->getFormatMetadata().addChildElement(ocio::METADATA_DESCRIPTION, description.c_str());
  std::ostringstream out;
  group->write(ocio::Config::CreateRaw(), "Academy/ASC Common LUT Format", out);
  return out.str();
}

}  // namespace

std::string bake_cube(const Settings& settings, int size) {
  const View view = find_view(settings);
  const Tables tables = tabulated(view, settings, size);
  std::string out = fmt::format("# {}\nLUT_1D_SIZE {}\nLUT_1D_INPUT_RANGE 0.0 {:.7f}\nLUT_3D_SIZE {}\n",
                                title(view, settings), kShaperSize, static_cast<float>(1 / tables.scale), size);
  for (const double v : tables.shaper) out += row_text(v, v, v);
  for (std::size_t i = 0; i < tables.cube.size(); i += 3)
    out += row_text(tables.cube[i], tables.cube[i + 1], tables.cube[i + 2]);
  return out;
}

std::string bake_clf(const Settings& settings, int size) {
  const View view = find_view(settings);
  const std::string description = title(view, settings);
  try {
    return clf_text(steps(view, settings), description);
  } catch (const ocio::Exception&) {
    return clf_text(tables_as_steps(tabulated(view, settings, size)), description);
  }
}

}  // namespace orrery::display
