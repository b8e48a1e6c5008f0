// SPDX-License-Identifier: Apache-2.0
#include "job/picture_header.h"

#include <cmath>
#include <cstddef>
#include <ctime>
#include <numbers>

#include <fmt/core.h>

#include "compile/camera_basis.h"
#include "compile/compiled_scene.h"
#include "display/color_space.h"
#include "job/version.h"
#include "load/read_scene.h"
#include "scene/scene.h"
#include "scene/value_text.h"

namespace orrery::job {
namespace {

using Matrix = std::array<std::array<double, 4>, 4>;

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix out{};
  for (std::size_t row = 0; row < 4; ++row)
    for (std::size_t column = 0; column < 4; ++column)
      for (std::size_t k = 0; k < 4; ++k) out[row][column] += a[row][k] * b[k][column];
  return out;
}

std::array<float, 16> as_float(const Matrix& m) {
  std::array<float, 16> out{};
  for (std::size_t i = 0; i < 16; ++i) out[i] = static_cast<float>(m[i / 4][i % 4]);
  return out;
}

void set_capture_date(image::Header& header) {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  char text[32];
  std::strftime(text, sizeof(text), "%Y:%m:%d %H:%M:%S", &local);
  header.capture_date = text;
  header.utc_offset_s = static_cast<float>(-local.tm_gmtoff);
}

/// Frame rate as a fraction: whole rates exactly, NTSC rates such as 23.976 as multiples of 1000/1001, others in
/// thousandths.
std::array<int, 2> rational(double rate) {
  const double whole = std::round(rate);
  if (std::abs(rate - whole) < 1e-9 && whole >= 1) return {static_cast<int>(whole), 1};
  const double of_ntsc = std::round(rate * 1.001);
  if (std::abs(rate - of_ntsc / 1.001) < 5e-4) return {static_cast<int>(of_ntsc) * 1000, 1001};
  return {static_cast<int>(std::lround(rate * 1000)), 1000};
}

/// The colour map of a points table as in a scene file, with the range that was used; empty: none.
std::string color_text(const scene::Points& points) {
  if (points.color.column.empty()) return {};
  std::string out = fmt::format("column = {}, map = {}", scene::string_text(points.color.column),
                                scene::string_text(points.color.map));
  if (points.color_range) out += ", range = " + scene::interval_text(*points.color_range);
  return out;
}

/// Samples per pixel; with adaptive sampling, their mean.
int mean_samples(const compile::CompiledScene& compiled, const JobReport& report) {
  if (!report.render.noise) return compiled.samples;
  return static_cast<int>(std::lround(static_cast<double>(report.render.paths) / compiled.width / compiled.height));
}

}  // namespace

CameraMatrices camera_matrices(const scene::Camera& camera, const scene::Image& image) {
  const compile::CameraAxes axes = compile::camera_axes(camera);
  const math::Vec3d x = axes.x, y = axes.y, z = -axes.z, from = camera.look_from;
  const auto along = [&](const math::Vec3d& axis) { return -math::dot(from, axis); };
  const Matrix view = {{{x.x, y.x, z.x, 0}, {x.y, y.y, z.y, 0}, {x.z, y.z, z.z, 0}, {along(x), along(y), along(z), 1}}};
  const double aspect = image.width * image.pixel_aspect / image.height;
  if (camera.projection == scene::Projection::kOrthographic) {
    // x = X / width + 1/2, y = 1/2 - Y / height, z = Z
    const double width = camera.width.value_or(0);
    const Matrix parallel = {{{1 / width, 0, 0, 0}, {0, -aspect / width, 0, 0}, {0, 0, 1, 0}, {0.5, 0.5, 0, 1}}};
    return {as_float(view), as_float(product(view, parallel))};
  }
  const double tangent = std::tan(camera.vfov / 360 * std::numbers::pi);
  // x / w = (X / (Z tangent aspect) + 1) / 2, y / w = (1 - Y / (Z tangent)) / 2, z / w = 1: layers hold the depth.
  const Matrix projection = {
      {{0.5 / (tangent * aspect), 0, 0, 0}, {0, -0.5 / tangent, 0, 0}, {0.5, 0.5, 1, 1}, {0, 0, 0, 0}}};
  return {as_float(view), as_float(product(view, projection))};
}

std::string settings_lines(const load::ReadResult& read, bool reproducible) {
  std::string lines;
  for (const load::Setting& setting : read.settings)
    if (!reproducible || setting.key != "render.accelerator")
      lines += fmt::format("{} = {}\n", setting.key, setting.value);
  return lines;
}

image::Header picture_header(const load::ReadResult& read, const compile::CompiledScene& compiled,
                             const JobReport& report, bool reproducible) {
  image::Header header;
  header.software = "orrery " + program_version();
  header.dpi = read.scene.image.dpi;
  const CameraMatrices matrices = camera_matrices(read.scene.camera, read.scene.image);
  header.world_to_camera = matrices.world_to_camera;
  header.world_to_ndc = matrices.world_to_ndc;
  if (read.scene.camera.defocus_angle > 0)
    header.focus = static_cast<float>(compile::focus_distance(read.scene.camera));
  if (const display::KnownSpace* space = display::known_space(read.scene.color.working_space())) {
    header.chromaticities = space->chromaticities;
    header.color_interop_id = space->interop_id;
  }
  header.frames_per_second = rational(read.scene.animation.fps);
  header.attributes = {{"orrery/version", program_version()},
                       {"orrery/sceneHash", report.scene_hash},
                       {"orrery/samples", mean_samples(compiled, report)},
                       {"orrery/maxDepth", static_cast<int>(compiled.max_depth)},
                       {"orrery/seed", std::to_string(compiled.sampler.seed)}};
  for (std::size_t i = 0; i < read.scene.points.size(); ++i)
    if (const std::string text = color_text(read.scene.points[i]); !text.empty())
      header.attributes.push_back({fmt::format("orrery/points[{}].color", i), text});
  if (const auto& backdrop = compiled.backdrop)
    header.attributes.push_back({"orrery/backdrop", fmt::format("{} {} {}", backdrop->x, backdrop->y, backdrop->z)});
  if (report.render.noise) header.attributes.push_back({"orrery/noise", static_cast<float>(*report.render.noise)});
  for (const load::Setting& setting : read.settings)
    if (setting.key == "render.precision" || setting.key == "render.shading" || setting.key == "render.sampler")
      header.attributes.push_back({"orrery/" + setting.key.substr(7), scene::unquoted(setting.value)});
  for (const auto& [layer, bad] : report.bad_layers)
    header.attributes.push_back(
        {"orrery/badValues/" + layer, fmt::format("{} nan, {} infinite, {} negative, {} above half", bad.nan,
                                                  bad.infinite, bad.negative, bad.above_half)});
  if (!report.display.config_id.empty()) header.attributes.push_back({"orrery/ocioConfigId", report.display.config_id});
  header.attributes.push_back({"orrery/settings", settings_lines(read, reproducible)});
  if (!report.missing.empty()) header.attributes.push_back({"orrery/missing", report.missing});
  if (reproducible) return header;
  set_capture_date(header);
  header.attributes.push_back({"orrery/renderSeconds", static_cast<float>(report.phases.render_s)});
  if (report.render.accelerator.empty()) return header;  // merged from shards, which may differ
  header.attributes.push_back({"orrery/accelerator", report.render.accelerator});
  header.attributes.push_back({"orrery/isa", report.render.isa});
  return header;
}

}  // namespace orrery::job
