// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "display/forward.h"

namespace orrery::preview {

class Canvas;

/// Receives whole lines for the user. Called on the preview's thread.
using OnNote = std::function<void(const std::string& text)>;

/// Shows images, for example in a viewer. All functions are called on one thread, and none waits for the viewer, except
/// finish() for a limited time.
///
/// Errors     base::Error from begin() and update() ends the preview, not the render
class Sink {
 public:
  Sink() = default;
  virtual ~Sink() = default;
  Sink(const Sink&) = delete;
  Sink& operator=(const Sink&) = delete;

  /// Minimum time between updates.
  virtual double interval_s() const = 0;

  /// Begins an image.
  ///
  /// Domain     `canvas` lives until finish() returns
  virtual void begin(const display::PictureInfo& picture, const Canvas& canvas) = 0;

  /// Shows cells that have changed.
  virtual void update(const std::vector<std::size_t>& cells) = 0;

  /// Continues output that would have blocked. Called frequently.
  virtual void poll() {}

  /// Ends an image: waits until the viewer has received everything, unless it hangs.
  virtual void finish() {}
};

}  // namespace orrery::preview
