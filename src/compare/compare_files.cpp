// SPDX-License-Identifier: Apache-2.0
#include "compare/compare_files.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <nlohmann/json.hpp>

#include <fmt/core.h>

#include "base/available_memory.h"
#include "base/error.h"
#include "base/file_set.h"
#include "base/text.h"
#include "compare/color_view.h"
#include "compare/perceptual.h"
#include "image/format.h"
#include "image/header.h"
#include "image/read.h"
#include "image/write.h"
#include "job/report_text.h"
#include "job/resources.h"
#include "job/version.h"

namespace orrery::compare {
namespace {

std::string size_text(const film::Picture& picture) { return fmt::format("{} x {}", picture.width, picture.height); }

base::Error bad_data(const std::string& text) { return {base::ErrorKind::kBadData, text}; }

void count_differing(const film::Picture& picture, const film::Picture& reference, const std::string& layer,
                     Comparison& out) {
  for (const film::Plane& plane : picture.planes) {
    const film::Plane* const other = reference.find(plane.name);
    if (other == nullptr) {
      out.only_in_picture.push_back(plane.name);
      continue;
    }
    if (!is_of_layer(plane, layer)) continue;
    out.values += plane.values.size();
    for (std::size_t i = 0; i < plane.values.size(); ++i)
      if (plane.values[i] != other->values[i] && !(std::isnan(plane.values[i]) && std::isnan(other->values[i])))
        ++out.differing;
  }
  for (const film::Plane& plane : reference.planes)
    if (picture.find(plane.name) == nullptr) out.only_in_reference.push_back(plane.name);
}

void write_map(const std::filesystem::path& file, const Map& map, double full) {
  if (file.empty()) return;
  if (image::is_display_format(image::format_of(file))) {
    image::write_encoded(file, encoded(false_color(map, full)), job::program_version());
  } else {
    image::ExrOptions options;
    options.as_float = true;
    image::write_exr(file, grey(map), {}, options);
  }
}

/// Checks the output files before work begins: known formats, creatable, distinct from the inputs and each other.
void check_files(const std::filesystem::path& picture, const std::filesystem::path& reference,
                 const ComparisonPictures& pictures) {
  base::FileSet files;
  files.add_input(picture, "image");
  files.add_input(reference, "image");
  for (const auto& [file, role] : {std::pair{pictures.heat, "--heat"}, std::pair{pictures.flip, "--flip"}}) {
    if (file.empty()) continue;
    if (image::format_of(file) == image::Format::kHdr)
      base::refuse(file.string() + ": Radiance stores colours, not error maps; use EXR, or a display format");
    files.add_output(file, role);
  }
}

}  // namespace

const std::vector<std::string>& limitable_metrics() {
  static const std::vector<std::string> names = {"rmse", "relmse", "mae", "max", "display", "flip", "bias", "z"};
  return names;
}

double Comparison::metric(const std::string& name) const {
  if (name == "rmse") return errors.rmse;
  if (name == "relmse") return errors.relative_mse;
  if (name == "mae") return errors.mae;
  if (name == "max") return errors.max;
  if (name == "display") return errors.display;
  if (name == "bias") return std::abs(errors.bias);
  if (name == "flip" && flip) return *flip;
  if (name == "z" && z_test) return std::abs(z_test->largest_z);
  base::refuse(fmt::format("--fail-above {}: not available for these images; {}", name,
                           name == "z" ? "render with --layers variance" : "it covers colours only"));
}

Comparison compare(const film::Picture& picture, const film::Picture& reference, Encoding encoding,
                   const std::string& layer, int threads) {
  if (picture.width != reference.width || picture.height != reference.height)
    throw bad_data(fmt::format("images of different sizes cannot be compared: {} and {}", size_text(picture),
                               size_text(reference)));
  Comparison out;
  out.width = picture.width;
  out.height = picture.height;
  count_differing(picture, reference, layer, out);
  const ComparedChannels c = compared_channels(picture, reference, layer);
  out.channels = c.names;
  out.is_matte = c.is_matte;
  out.no_hit = c.no_hit;
  out.no_hit_in_one = c.no_hit_in_one;
  out.errors = pixel_errors(c.picture, c.reference, c.excluded);
  if (out.errors.values == 0 && out.errors.not_finite + out.no_hit_in_one > 0)
    throw bad_data(
        fmt::format("nothing to compare: no value of {} is finite and a hit in both images", base::joined(c.names)));
  out.display_map = display_error_map(c.picture, c.reference, c.excluded);
  if (!layer.empty() || c.names.size() < 3) return out;
  // For metrics that need display-encoded input: without exposure.
  const auto code = [&](float v) {
    v = std::clamp(v, 0.0f, 1.0f);
    return encoding == Encoding::kLight ? srgb_encoded(v) : v;
  };
  const Maps code_a = maps_of(c.picture, code), code_b = maps_of(c.reference, code);
  out.ssim = ssim(code_a, code_b);
  out.flip_map = encoding == Encoding::kDisplay
                     ? flip(code_a, code_b)
                     : hdr_flip(maps_of(c.picture, std::identity()), maps_of(c.reference, std::identity()),
                                job::thread_count(threads));
  out.flip = out.flip_map.mean();
  out.z_test = z_test(c.picture, color_of(picture, "variance"), c.reference, color_of(reference, "variance"));
  return out;
}

Comparison compare_files(const std::filesystem::path& picture, const std::filesystem::path& reference,
                         const std::string& layer, const ComparisonPictures& pictures, int threads) {
  const bool developed = image::is_display_format(image::format_of(picture));
  if (developed != image::is_display_format(image::format_of(reference))) {
    const auto& linear = developed ? reference : picture;
    base::refuse(
        fmt::format("{0} is scene-linear, but the other image is display-encoded; develop it first: orrery develop {0} "
                    "-o developed.png",
                    base::shell_quoted(linear.string())));
  }
  check_files(picture, reference, pictures);
  if (!layer.empty() && !pictures.flip.empty()) base::refuse("--flip covers colours only; remove --layer");
  const auto read = [](const std::filesystem::path& file) {
    return image::read(file, image::Parts::kAll, base::available_memory().value_or(0));
  };
  const film::Picture a = read(picture), b = read(reference);
  for (const auto& file : {pictures.heat, pictures.flip})
    if (!file.empty()) image::check_size(file, a.width, a.height);
  Comparison out = compare(a, b, developed ? Encoding::kDisplay : Encoding::kLight, layer, threads);
  write_map(pictures.heat, out.display_map, kFalseColorMax);
  write_map(pictures.flip, out.flip_map, 1);
  return out;
}

std::string comparison_text(const Comparison& c) {
  using job::add_row;
  std::string out;
  const PixelErrors& e = c.errors;
  add_row(out, "images", "{} x {}, channels {}", c.width, c.height, base::joined(c.channels));
  if (c.is_matte)
    add_row(out, "matte", "{:.6g} of the coverage belongs to different objects; errors are of this fraction", e.mae);
  add_row(out, "rmse", "{:.6g}", e.rmse);
  add_row(out, "relmse", "{:.6g}", e.relative_mse);
  add_row(out, "mae", "{:.6g}", e.mae);
  add_row(out, "max", "{:.6g}{}", e.max,
          e.max_channel >= 0 ? fmt::format(" in {} at {}, {}", c.channel(e.max_channel), e.max_x, e.max_y) : "");
  add_row(out, "psnr", "{}", std::isfinite(e.psnr_db()) ? fmt::format("{:.2f} dB", e.psnr_db()) : "infinite");
  add_row(out, "display", "{:.6g} relative display error, as in --noise", e.display);
  add_row(out, "bias", "{:+.3g} of the mean", e.bias);
  if (c.ssim) add_row(out, "ssim", "{:.6g}", *c.ssim);
  if (c.flip) add_row(out, "flip", "{:.6g}", *c.flip);
  if (c.z_test) {
    const ZTest& z = *c.z_test;
    add_row(out, "noise", "rmse {:.6g} explained by the variances, {:.6g} unexplained", z.noise, z.bias);
    add_row(out, "mean bias", "{:+.3g} relative, standard error {:.2g}", z.mean_bias, z.mean_bias_error);
    add_row(out, "z-test", "{}: {} of {} blocks of {} px exceed |z| = {:.2f}; maximum {:+.2f} in {} at {}, {}",
            z.differ() ? "the images differ by more than noise" : "no difference but noise", z.rejected, z.tests,
            kTestedSide, z.critical_z, z.largest_z, c.channel(z.channel), z.x, z.y);
  }
  add_row(out, "differing", "{} of {} values", c.differing, c.values);
  if (c.no_hit > 0)
    add_row(out, "left out", "{} pixels without a hit, {} of them in one image only", c.no_hit, c.no_hit_in_one);
  if (e.not_finite > 0) add_row(out, "left out", "{} non-finite values", e.not_finite);
  return out;
}

std::string comparison_json(const Comparison& c) {
  using nlohmann::json;
  const PixelErrors& e = c.errors;
  json max_at, z_test;
  if (e.max_channel >= 0) max_at = {{"channel", c.channel(e.max_channel)}, {"x", e.max_x}, {"y", e.max_y}};
  if (c.z_test) {
    const ZTest& z = *c.z_test;
    z_test = {{"tests", z.tests},
              {"rejected", z.rejected},
              {"critical_z", z.critical_z},
              {"largest_z", z.largest_z},
              {"at", {{"channel", c.channel(z.channel)}, {"x", z.x}, {"y", z.y}}},
              {"family_wise_error", kFamilyWiseError},
              {"noise_rmse", z.noise},
              {"bias_rmse", z.bias},
              {"mean_bias", z.mean_bias},
              {"mean_bias_error", z.mean_bias_error}};
  }
  return job::json_text({{"schema", "orrery.compare/2"},
                         {"width", c.width},
                         {"height", c.height},
                         {"channels", c.channels},
                         {"rmse", e.rmse},
                         {"relmse", e.relative_mse},
                         {"mae", e.mae},
                         {"max", e.max},
                         {"max_at", max_at},
                         {"psnr_db", e.psnr_db()},
                         {"display", e.display},
                         {"bias", e.bias},
                         {"ssim", job::json_or_null(c.ssim)},
                         {"flip", job::json_or_null(c.flip)},
                         {"z_test", z_test},
                         {"values", c.values},
                         {"differing", c.differing},
                         {"not_finite", e.not_finite},
                         {"no_hit", c.no_hit},
                         {"no_hit_in_one", c.no_hit_in_one},
                         {"only_in_a", c.only_in_picture},
                         {"only_in_b", c.only_in_reference}});
}

}  // namespace orrery::compare
