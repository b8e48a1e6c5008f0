// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>

#include "data/forward.h"

namespace orrery::points {

/// Opens a data file, as particles::open() does.
using OpenData = std::function<std::unique_ptr<data::DataFile>(const std::filesystem::path&, const data::OpenOptions&)>;

/// Opens data files for several frames. The files opened last stay open, so that a frame is found from where the
/// previous one ended, and compressed data are decompressed only once. A file that has changed is opened again.
///
/// Result     for one thread at a time; its copies share the open files
/// Errors     those of particles::open()
OpenData open_once();

}  // namespace orrery::points
