// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace orrery::image {

/// Configures OpenImageIO: one thread, no image size limit, no console output. Every function of this room calls it.
///
/// Cost       runs once per process
void prepare_library();

/// Starts loading OpenImageIO on another thread, in a program that loads it on demand. The next function of this room
/// that needs it waits until it is loaded, and reports a failure as base::Error(kInternal).
void start_loading();

/// Sets the number of threads that OpenImageIO encodes and decodes with; the default is 1.
///
/// Domain     count >= 1
void set_threads(int count);

}  // namespace orrery::image
