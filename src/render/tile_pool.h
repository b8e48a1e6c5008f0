// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "kernel/render_tile.h"
#include "render/render.h"
#include "render/tile_renderer.h"

namespace orrery::render {

/// Threads that share out tiles, and what each of them keeps from one tile to the next.
class TilePool {
 public:
  explicit TilePool(int threads);
  ~TilePool();

  /// Calls `work(i, worker)` for i = 0 .. count - 1, in any order and from all threads, until `shall_stop` says so.
  ///
  /// Result     false where some were left out
  bool run(std::size_t count, const std::function<void(std::size_t i, TileWorker& worker)>& work,
           const std::function<bool()>& shall_stop);

  /// Runs something with these threads.
  void execute(const std::function<void()>& work);

  /// Of all tiles so far.
  kernel::TileCounts counts() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace orrery::render
