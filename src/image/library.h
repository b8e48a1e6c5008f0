// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace orrery::image {

/// Makes OpenImageIO a quiet guest: no threads of its own, nothing on the console. Every function of this room calls
/// it.
///
/// Cost       once a process
void prepare_library();

/// Lets OpenImageIO encode and decode with more than one thread.
///
/// Domain     count >= 1; 1 is what stands until this is called
void set_threads(int count);

/// The version of OpenImageIO that is loaded.
std::string oiio_version();

}  // namespace orrery::image
