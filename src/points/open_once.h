// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "points/load_points.h"

namespace orrery::points {

/// Opens data files for several frames. The files opened last stay open, so that a frame is found from where the
/// previous one ended, and compressed data are decompressed only once. A file that has changed is opened again.
///
/// Result     for one thread at a time; its copies share the open files
/// Errors     those of data::open()
OpenData open_once();

}  // namespace orrery::points
