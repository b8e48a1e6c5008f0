// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <string>
#include <utility>
#include <vector>

#include "job/prepared_scene.h"
#include "load/load_scene.h"
#include "math/vec3.h"
#include "scene/scene.h"

namespace orrery::view {

/// A sphere or a rod that a client has chosen.
struct Picked {
  std::string title;   ///< "row 17 of melt.dump", "sphere[3]"
  math::Vec3d center;  ///< scene units; the middle of a rod
  double radius = 0;
  std::vector<std::pair<std::string, std::string>> values = {};  ///< columns of its row, or keys, and their values
};

/// Tells what is visible at a point of a prepared scene.
class Picker {
 public:
  /// Domain     `prepared` outlives this, and changes only between close() and open()
  explicit Picker(const job::PreparedScene& prepared) : prepared_(prepared) {}

  /// The sphere or the rod at a point of the image.
  ///
  /// `x`, `y`   fractions of the image's width and height, from the upper left corner
  /// Result     empty if the background is visible, or until open()
  /// Errors     those of load::read_source_rows
  /// Cost       reads the data file, unless its columns take little memory and the particle before was of the same file
  std::optional<Picked> pick(double x, double y);

  /// Opposite corners of the box around the centres of the particles, or in a scene without data of all spheres; empty:
  /// there are none.
  ///
  /// Domain     after open()
  std::optional<std::array<math::Vec3d, 2>> bounds() const;

  /// Waits until no call of pick() looks at the scene, so that it can change.
  ///
  /// `source`   of the next scene
  /// `is_new`   its data files may be others
  void close(load::SceneSource source, bool is_new);
  /// The scene has its BVH.
  void open() { is_open_ = true; }
  bool is_open() const { return is_open_; }

 private:
  struct Data;

  Picked describe_sphere(std::size_t index);
  Picked describe_rod(std::size_t index);
  /// Describes the two particles of a bond of a points table, or of a stub of one.
  void add_bond(std::size_t table, bool is_stub, std::size_t index, Picked& out);
  std::shared_ptr<const Data> data_of(std::size_t table);
  const scene::Scene& scene() const { return prepared_.loaded().read.scene; }

  const job::PreparedScene& prepared_;
  std::shared_mutex looks_;  ///< shared by the calls of pick() that look at `prepared_` and `source_`
  std::atomic<bool> is_open_{false};
  load::SceneSource source_;
  std::mutex reading_;  ///< guards read_
  std::shared_ptr<const Data> read_;
};

}  // namespace orrery::view
