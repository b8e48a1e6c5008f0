// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace orrery::base {

/// Sets the folder of the modules; the default is that of the executable. Call before the first load_module().
void set_module_folder(std::filesystem::path folder);

/// The folder of the data files that are installed with the program, relative to its modules; it may not exist.
std::filesystem::path shared_folder();

/// Loads the module of a room, `orrery-ROOM.so` in the folder of the modules, and returns the result of its function
/// `orrery_ROOM_functions`: the table of the room's functions. A module stays loaded until the process ends. In the
/// program, the stub libraries in `orrery-ROOM-stubs` replace libraries that the module needs but does not use.
///
/// Errors     base::Error(kInternal): the module is missing or damaged
const void* load_module(const std::string& room);

}  // namespace orrery::base
