// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace orrery::image {

/// Configures OpenImageIO: one thread, no image size limit, no console output. Every function of this room calls it.
///
/// Cost       runs once per process
void prepare_library();

/// Sets the number of threads that OpenImageIO encodes and decodes with; the default is 1.
///
/// Domain     count >= 1
void set_threads(int count);

/// The version of the loaded OpenImageIO library.
std::string oiio_version();

}  // namespace orrery::image
