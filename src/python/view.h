// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "http/server.h"
#include "python/scene_data.h"
#include "view/site.h"
#include "view/viewer.h"

namespace orrery::python {

/// A page in a browser that shows a scene of Python, served by this process until it is closed.
class ScenePage {
 public:
  /// `scene`    its arrays outlive this
  /// `options`  first values of the controls, as in view::Wish
  /// `port`     0: a free one
  /// Errors     those of http::serve
  ScenePage(SceneData scene, const std::string& title, std::map<std::string, std::string> options, int port,
            int threads, std::uint64_t memory_limit);

  /// With the secret. Empty: closed.
  const std::string& address() const { return address_; }

  /// The settings of the scene that is shown: KEY=VALUE, those of the controls and the camera.
  std::vector<std::string> settings() const;

  /// Ends the render and the server. Must not hold the GIL.
  void close();

 private:
  std::string address_;
  std::unique_ptr<view::Viewer> viewer_;
  std::unique_ptr<view::Site> site_;
  std::unique_ptr<http::Server> server_;
};

}  // namespace orrery::python
