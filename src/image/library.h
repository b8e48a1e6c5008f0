// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace orrery::image {

/// Configures OpenImageIO: one thread, no image size limit, no console output. Every function of this room calls it.
///
/// Cost       runs once per process
void prepare_library();

/// Sets the number of threads that OpenImageIO encodes and decodes with; the default is 1.
///
/// Domain     count >= 1
/// Errors     base::Error(kInternal): the program cannot load OpenImageIO
void set_threads(int count);

}  // namespace orrery::image
