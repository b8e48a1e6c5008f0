// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "kernel/forward.h"

namespace orrery::render {

struct TileWorker;

/// A thread pool for tiles, with buffers that each thread keeps from tile to tile.
class TilePool {
 public:
  explicit TilePool(int threads);
  ~TilePool();

  /// Calls `work(i, worker)` for i = 0 .. count - 1, in any order and on all threads, until `shall_stop` returns true.
  ///
  /// Result     false if some calls were skipped
  bool run(std::size_t count, const std::function<void(std::size_t i, TileWorker& worker)>& work,
           const std::function<bool()>& shall_stop);

  /// Runs `work` within the pool, so that its parallel loops use these threads.
  void execute(const std::function<void()>& work);

  /// Counts of all tiles so far.
  kernel::TileCounts counts() const;

  /// The traversals of camera rays, and of secondary rays if different: "packet", "single", or "both" if threads differ
  /// or are still measuring. For example "packet, secondary single".
  std::string traversals() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace orrery::render
