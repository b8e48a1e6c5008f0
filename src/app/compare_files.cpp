// SPDX-License-Identifier: Apache-2.0
#include "app/compare_files.h"

#include <cmath>
#include <limits>

#include <nlohmann/json.hpp>

#include "app/text.h"
#include "base/error.h"
#include "image/format.h"
#include "image/read.h"

namespace orrery::app {
namespace {

std::string size_text(const film::Picture& picture) {
  return std::to_string(picture.width) + " x " + std::to_string(picture.height);
}

/// Sums over values; the mean is taken at the end.
struct Sums {
  double squares = 0, relative = 0;
  std::uint64_t count = 0;
};

void compare_planes(const film::Plane& a, const film::Plane& b, Comparison& out, Sums& sums) {
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    const double x = a.values[i], y = b.values[i];
    if (!std::isfinite(x) || !std::isfinite(y)) {
      ++out.not_finite;
      continue;
    }
    const double difference = std::abs(x - y);
    sums.squares += difference * difference;
    sums.relative += difference * difference / (y * y + kRelativeFloor);
    ++sums.count;
    if (difference > 0) ++out.differing;
    if (difference <= out.max) continue;
    out.max = difference;
    out.max_channel = a.name;
    out.max_x = static_cast<int>(i % static_cast<std::size_t>(out.width));
    out.max_y = static_cast<int>(i / static_cast<std::size_t>(out.width));
  }
}

}  // namespace

double Comparison::psnr_db() const {
  return rmse > 0 ? -20 * std::log10(rmse) : std::numeric_limits<double>::infinity();
}

Comparison compare(const film::Picture& picture, const film::Picture& reference) {
  if (picture.width != reference.width || picture.height != reference.height)
    throw base::Error(base::ErrorKind::kBadData, "pictures of different sizes cannot be compared: " +
                                                     size_text(picture) + " and " + size_text(reference));
  Comparison out;
  out.width = picture.width;
  out.height = picture.height;
  Sums sums;
  for (const film::Plane& plane : picture.planes) {
    const film::Plane* const other = reference.find(plane.name);
    if (other == nullptr) continue;
    out.channels.push_back(plane.name);
    compare_planes(plane, *other, out, sums);
  }
  if (out.channels.empty())
    throw base::Error(base::ErrorKind::kBadData, "the pictures have no channel of the same name");
  if (sums.count > 0) {
    out.rmse = std::sqrt(sums.squares / static_cast<double>(sums.count));
    out.relative_mse = sums.relative / static_cast<double>(sums.count);
  }
  return out;
}

Comparison compare_files(const std::filesystem::path& picture, const std::filesystem::path& reference) {
  const bool developed = image::is_display_format(image::format_of(picture));
  if (developed != image::is_display_format(image::format_of(reference))) {
    const auto& linear = developed ? reference : picture;
    throw base::Error(base::ErrorKind::kUsage,
                      linear.string() + " holds scene-linear light and the other picture what " +
                          "a display shows; develop it first: orrery develop " + linear.string() + " -o developed.png");
  }
  return compare(image::read(picture), image::read(reference));
}

std::string comparison_text(const Comparison& c) {
  std::string channels;
  for (const std::string& name : c.channels) channels += (channels.empty() ? "" : ", ") + name;
  std::string out;
  append(out, "pictures    %d x %d, channels %s\n", c.width, c.height, channels.c_str());
  append(out, "rmse        %.6g\n", c.rmse);
  append(out, "relmse      %.6g\n", c.relative_mse);
  append(out, "max         %.6g", c.max);
  if (!c.max_channel.empty()) append(out, " in %s at %d, %d", c.max_channel.c_str(), c.max_x, c.max_y);
  if (std::isfinite(c.psnr_db())) {
    append(out, "\npsnr        %.2f dB\n", c.psnr_db());
  } else {
    out += "\npsnr        infinite\n";
  }
  append(out, "differing   %llu of %llu values\n", static_cast<unsigned long long>(c.differing),
         static_cast<unsigned long long>(c.channels.size()) * static_cast<unsigned long long>(c.width) *
             static_cast<unsigned long long>(c.height));
  if (c.not_finite > 0)
    append(out, "left out    %llu values that are not finite\n", static_cast<unsigned long long>(c.not_finite));
  return out;
}

std::string comparison_json(const Comparison& c) {
  using nlohmann::json;
  json out = {{"schema", "orrery.compare/1"},
              {"width", c.width},
              {"height", c.height},
              {"channels", c.channels},
              {"rmse", c.rmse},
              {"relmse", c.relative_mse},
              {"max", c.max},
              {"max_at", nullptr},
              {"psnr_db", nullptr},
              {"differing", c.differing},
              {"not_finite", c.not_finite}};
  if (!c.max_channel.empty()) out["max_at"] = {{"channel", c.max_channel}, {"x", c.max_x}, {"y", c.max_y}};
  if (std::isfinite(c.psnr_db())) out["psnr_db"] = c.psnr_db();
  return json_text(out);
}

}  // namespace orrery::app
