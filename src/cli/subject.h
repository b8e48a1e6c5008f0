// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "cli/plot_options.h"
#include "job/job.h"
#include "view/viewer.h"

namespace orrery::cli {

struct FilmSettings;

/// The options that say what is shown. Those of data files have no effect on scenes.
struct ShownOptions {
  PlotArguments plot;
  SceneOptions scene;
  job::Job job;
  const Command* command = nullptr;

  void add_to(Command& parsed);
};

/// The files that options name besides FILE.
std::set<std::string> files_of(const ShownOptions& shown);

/// Checks the words of a film: the options of an image, and --frames, --turntable and --fps.
///
/// `allowed`    the files that they may name
/// Errors       base::Error(kUsage)
void check_film(const std::string& file, const std::vector<std::string>& words, const std::set<std::string>& allowed);

/// Returns what `orrery view` shows of a scene or a data file.
///
/// `words`      options and their values, as typed
/// `allowed`    the files that they may name
/// Errors       base::Error: those of plot::make_plot(); kUsage for other words
view::Subject subject_of(const std::filesystem::path& file, const std::vector<std::string>& words,
                         const std::set<std::string>& allowed);

/// Returns what `orrery view` shows for the options of `orrery plot`, also those of annotations.
///
/// `open`       opens the data file; null: by its name
/// `film`       settings of a film, whose frames are in the result; null: a still image
/// Result       its job keeps `open`
/// Errors       as subject_of()
view::Subject data_subject(const std::string& file, const std::vector<std::string>& words,
                           const job::Resources& resources, const points::OpenData& open,
                           const FilmSettings* film = nullptr);

}  // namespace orrery::cli
