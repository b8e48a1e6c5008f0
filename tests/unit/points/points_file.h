// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "points/load_points.h"
#include "points/rows.h"
#include "scene/scene.h"
#include "support/temp_dir.h"

namespace orrery::points {

/// "error points[0].radius: text", one line per diagnostic.
inline std::string text_of(const std::vector<scene::SceneDiagnostic>& diagnostics) {
  std::string out;
  for (const scene::SceneDiagnostic& d : diagnostics)
    out += std::string(d.severity == base::Severity::kError ? "error " : "warning ") + d.key + ": " + d.text + "\n";
  return out;
}
inline std::string text_of(KeyFaults& faults) { return text_of(faults.take()); }

/// Writes data files and loads their spheres.
class PointsFile : public testing::Test {
 protected:
  /// Writes a file and names it in `points` and `request`.
  void write(const std::string& name, const std::string& text) {
    support::write_bytes(folder_ / name, text);
    points.file = name;
    request.file = folder_ / name;
    request.folder = folder_.path();
    request.key = "points[0]";
  }
  /// Loads the file into `points`. Returns the diagnostics.
  std::string load() { return text_of(load_points(request, points)); }
  /// Loads a file into `points` by keys that `points` has.
  std::string load(const std::string& name, const std::string& text) {
    write(name, text);
    return load();
  }
  /// The x coordinates of the spheres.
  std::vector<double> x() const {
    std::vector<double> out;
    for (const math::Vec3d& c : points.centers) out.push_back(c.x);
    return out;
  }
  /// The colour of a sphere.
  math::Vec3d color(std::size_t i) const { return points.palette.at(points.colors.at(i)); }

  scene::Points points;
  LoadRequest request;
  support::TempDir folder_;
};

}  // namespace orrery::points
