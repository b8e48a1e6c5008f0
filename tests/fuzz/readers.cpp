// SPDX-License-Identifier: Apache-2.0
#include "fuzz/readers.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <fstream>
#include <sstream>
#include <vector>

#include "base/error.h"
#include "format/read_scene.h"
#include "format/write_scene.h"
#include "points/load_points.h"
#include "scene/validate.h"

namespace orrery::fuzz {
namespace {

void write(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

/// Checks that an error has actionable, printable diagnostics.
std::string fault_with_error(const base::Error& error, bool needs_findings) {
  if (error.kind() != base::ErrorKind::kBadData) return "not bad data: " + std::string(error.what());
  if (needs_findings && error.diagnostics().empty()) return "bad data without a diagnostic";
  for (const base::Diagnostic& diagnostic : error.diagnostics()) {
    const std::string text = base::formatted(diagnostic);
    if (diagnostic.file.empty()) return "a diagnostic without a file: " + text;
    if (diagnostic.text.empty()) return "a diagnostic without a text: " + text;
    const auto is_control = [](char c) { return c >= 0 && c < ' ' && c != '\n' && c != '\t'; };
    if (std::any_of(text.begin(), text.end(), is_control)) return "a diagnostic with control characters";
  }
  return {};
}

std::string fault_with_result(const format::ReadResult& read) {
  for (const scene::SceneDiagnostic& diagnostic : scene::validate(read.scene))
    if (diagnostic.severity == base::Severity::kError)
      return "accepted despite " + diagnostic.key + ": " + diagnostic.text;
  if (read.settings.empty()) return "no settings";
  return {};
}

/// Checks that a written scene reads back and writes the same text again.
std::string fault_with_round_trip(const std::filesystem::path& folder, scene::Scene scene) {
  scene.points.clear();  // points files are not written
  const std::string text = format::scene_text(scene, "");
  write(folder / "again.toml", text);
  if (format::scene_text(format::read_scene(folder / "again.toml").scene, "") != text)
    return "changes when it is read back";
  return {};
}

std::string fault_with(const std::filesystem::path& folder, const std::filesystem::path& file,
                       const std::vector<format::Override>& overrides) {
  format::ReadResult read;
  try {
    read = format::read_scene(file, overrides);
  } catch (const base::Error& error) {
    return fault_with_error(error, true);
  } catch (const std::exception& error) {
    return "not an Error: " + std::string(error.what());
  }
  if (std::string fault = fault_with_result(read); !fault.empty()) return fault;
  try {
    return fault_with_round_trip(folder, read.scene);
  } catch (const base::Error& error) {
    return "the written scene is rejected: " +
           (error.diagnostics().empty() ? std::string(error.what()) : base::formatted(error.diagnostics()[0]));
  }
}

bool fits(const scene::Points& points, std::size_t material_count) {
  return points.radii.size() == points.centers.size() &&
         (points.materials.empty() || points.materials.size() == points.centers.size()) &&
         std::all_of(points.centers.begin(), points.centers.end(), math::is_finite) &&
         std::all_of(points.radii.begin(), points.radii.end(), [](double r) { return std::isfinite(r); }) &&
         std::all_of(points.materials.begin(), points.materials.end(), [=](auto m) { return m < material_count; });
}

}  // namespace

std::string fault_with_scene(const std::filesystem::path& folder, const std::string& bytes) {
  write(folder / "scene.toml", bytes);
  return fault_with(folder, folder / "scene.toml", {});
}

std::string fault_with_overrides(const std::filesystem::path& folder, const std::string& bytes) {
  write(folder / "base.toml",
        "[material.a]\ntype = \"metal\"\nalbedo = [1, 1, 1]\n[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = "
        "\"a\"\n");
  std::vector<format::Override> overrides;
  std::istringstream lines(bytes);
  for (std::string line; std::getline(lines, line);) overrides.emplace_back(line);
  return fault_with(folder, folder / "base.toml", overrides);
}

std::string fault_with_ply(const std::filesystem::path& folder, const std::string& bytes) {
  constexpr std::size_t kMaterials = 3;
  write(folder / "points.ply", bytes);
  scene::Points points;
  points.file = "points.ply";
  if (bytes.size() % 2 == 1) points.radius.value = 0.5;  // covers both ways to set the radius
  points::LoadRequest request;
  request.file = folder / points.file;
  request.key = "points[0]";
  request.materials = kMaterials;
  try {
    const auto diagnostics = points::load_points(request, points);
    const auto is_error = [](const auto& d) { return d.severity == base::Severity::kError; };
    if (std::any_of(diagnostics.begin(), diagnostics.end(), is_error))
      return points.centers.empty() ? "" : "points remain after an error";
    return fits(points, kMaterials) ? "" : "accepted, but not renderable";
  } catch (const base::Error& error) {
    if (!points.centers.empty() || !points.radii.empty() || !points.materials.empty())
      return "points remain after an error";
    return fault_with_error(error, true);
  } catch (const std::exception& error) {
    return "not an Error: " + std::string(error.what());
  }
}

}  // namespace orrery::fuzz
