// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "job/resources.h"
#include "points/load_points.h"
#include "view/viewer.h"

namespace orrery::cli {

struct FilmSettings;

/// Returns what `orrery view` shows for the options of `orrery plot`, also those of annotations.
///
/// `words`      options and their values, as typed
/// `open`       opens the data file; null: by its name
/// `film`       settings of a film, whose frames are in the result; null: a still image
/// Result       its job keeps `open`
/// Errors       base::Error: those of plot::make_plot(); kUsage for other words
view::Subject data_subject(const std::string& file, std::vector<std::string> words, const job::Resources& resources,
                           const points::OpenData& open, const FilmSettings* film = nullptr);

}  // namespace orrery::cli
