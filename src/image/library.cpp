// SPDX-License-Identifier: Apache-2.0
#include "image/library.h"

#include <OpenImageIO/imageio.h>

#include <mutex>

namespace orrery::image {
namespace {

void use_threads(int count) {
  OIIO::attribute("threads", count);
  // OpenEXR counts helpers beside the calling thread, and 0 would mean as many as there are processors.
  OIIO::attribute("exr_threads", count > 1 ? count : -1);
}

}  // namespace

void prepare_library() {
  static std::once_flag once;
  std::call_once(once, [] {
    use_threads(1);
    OIIO::attribute("limits:imagesize_MB", 0);  // it would refuse to read back what it has just written
    OIIO::attribute("debug", 0);                // distributions build it with messages to the console
  });
}

void set_threads(int count) {
  prepare_library();
  use_threads(count);
}

std::string oiio_version() {
  const int v = OIIO::openimageio_version();
  return std::to_string(v / 10000) + "." + std::to_string(v / 100 % 100) + "." + std::to_string(v % 100);
}

}  // namespace orrery::image
