// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cli/options.h"
#include "job/forward.h"
#include "plot/data_frames.h"
#include "plot/plot.h"

namespace orrery::cli {

/// Arguments of the data options that need further parsing.
struct DataArguments {
  std::string frame, frames, range, replicate;
  std::vector<std::string> select, slice, opacity, radius;
  const Option* map = nullptr;

  /// Adds FILE and the options that all commands on data files share. Values go to `data`, or to this and then to
  /// `data` by read().
  ///
  /// `kind`     of FILE, in the help
  void add_to(Command& command, plot::DataOptions& data, const std::string& kind = "Data file");
  /// Adds the option of commands that use several frames.
  void add_frames_to(Command& command);
  /// Sets the members of `data` from the parsed options.
  ///
  /// Errors     base::Error(kUsage)
  void read(plot::DataOptions& data) const;
};

/// The options of a plot.
class PlotArguments {
 public:
  plot::PlotOptions options;
  DataArguments data;  ///< of `options`

  /// Adds the options that select view, style, representation, bonds and opacity.
  void add_look_to(Command& command);
  /// Adds the options of text, scales and lines over the image.
  void add_annotations_to(Command& command);

  /// Sets the members of the options that DataArguments::read() leaves, except those for outputs. Called after it.
  ///
  /// `scene`    receives the size of --print-width
  /// Errors     base::Error(kUsage)
  void read(SceneOptions& scene, const job::Job& job);

 private:
  /// Arguments that need further parsing; empty: not set.
  struct {
    std::string style, quality, bonds, vectors, velocity, background, scale_bar, print_width;
    std::vector<std::string> representation, material;
  } look_;
};

/// Lets a job show a plot.
///
/// `text`     of the scene
void show(const plot::PlotScene& made, std::shared_ptr<const std::string> text, job::Job& job);

}  // namespace orrery::cli
