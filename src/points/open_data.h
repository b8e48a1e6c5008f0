// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>

#include "data/data_file.h"

namespace orrery::points {

/// Opens a data file, as formats::open() does.
using OpenData = std::function<std::unique_ptr<data::DataFile>(const std::filesystem::path&, const data::OpenOptions&)>;

/// Returns a function that opens data files for several frames. It keeps the most recent files open, so that each frame
/// is searched from the end of the previous one and compressed data are decompressed only once. A file that has changed
/// is reopened.
///
/// Result     not thread-safe; copies share the open files
/// Errors     those of formats::open()
OpenData open_once();

/// Returns a function that opens a file by `open`, but only the first time: the file is closed after its first use.
OpenData handed_over(OpenData open);

}  // namespace orrery::points
