// SPDX-License-Identifier: Apache-2.0
#include "image/library.h"

#include <OpenImageIO/imageio.h>

#include <mutex>

namespace orrery::image {
namespace {

void use_threads(int count) {
  OIIO::attribute("threads", count);
  // OpenEXR counts threads in addition to the calling one; 0 means one per processor, -1 none.
  OIIO::attribute("exr_threads", count > 1 ? count : -1);
}

}  // namespace

void prepare_library() {
  static std::once_flag once;
  std::call_once(once, [] {
    use_threads(1);
    OIIO::attribute("limits:imagesize_MB", 0);  // else OpenImageIO refuses to read back its own large files
    OIIO::attribute("debug", 0);                // distributions enable debug messages on the console
  });
}

void set_threads(int count) {
  prepare_library();
  use_threads(count);
}

}  // namespace orrery::image
