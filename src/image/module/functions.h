// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/library.h"
#include "image/partial_file.h"
#include "image/read.h"
#include "image/verify.h"
#include "image/write.h"

namespace orrery::image {

/// The functions of this room that need OpenImageIO and that other rooms call. The program finds them in a module,
/// which it loads when the first of them is called.
struct Functions {
  decltype(&image::set_threads) set_threads;
  decltype(&image::oiio_version) oiio_version;
  decltype(&image::read) read;
  decltype(&image::write_exr) write_exr;
  decltype(&image::write_deep) write_deep;
  decltype(&image::write_hdr) write_hdr;
  decltype(&image::write_encoded) write_encoded;
  decltype(&image::write_partial) write_partial;
  decltype(&image::read_provenance) read_provenance;
  decltype(&image::read_partial) read_partial;
  decltype(&image::verified_stamp) verified_stamp;
};

/// The only name that the module is asked for.
inline constexpr const char* kFunctionsName = "orrery_image_functions";
using GetFunctions = const Functions* (*)();

}  // namespace orrery::image
