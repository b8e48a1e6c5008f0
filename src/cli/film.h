// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "plot/plot.h"

namespace orrery::cli {

class SceneOptions;

/// Starts a program that gets a signal when the thread that started it ends: a command that is killed cancels nothing.
///
/// `streams`  descriptors of its standard input, output and error; -1: /dev/null
/// Result     its process; -1 if it cannot be started, 127 is its status if there is no such program
pid_t start_program(const std::filesystem::path& program, std::vector<std::string> words,
                    const std::array<int, 3>& streams, int signal);

/// Speed of a film, and the orbit of its camera.
struct FilmSettings {
  double fps = 24;         ///< frames per second
  double turntable_s = 0;  ///< duration of an orbit of the camera; 0: none

  /// Adds these settings to a plot. A turntable of data without selected frames shows one of them during one orbit.
  void apply(SceneOptions& scene, plot::PlotOptions& plot) const;
};

/// A film file, and its frames as PNG files in a folder next to it. The frames stay until the film is complete, so that
/// a stopped command continues from them.
class Film {
 public:
  /// Checks the request; no file is touched.
  ///
  /// Errors     base::Error: kUsage if the format cannot have this rate; kCannotCreate if the program ffmpeg is not
  ///            installed
  Film(std::filesystem::path file, double fps, bool keeps_frames);
  ~Film();
  Film(const Film&) = delete;
  Film& operator=(const Film&) = delete;

  /// True for the extensions of films.
  static bool is_film(const std::filesystem::path& file);

  const std::filesystem::path& file() const { return file_; }
  /// The name of the frames, with a frame pattern.
  std::filesystem::path frame_pattern() const;

  /// Creates the folder of the frames, and locks it against other commands.
  ///
  /// Errors     base::Error(kCannotCreate)
  void open_folder();

  /// Refuses a size, px, that the format cannot have.
  void check_size(int width, int height) const;

  /// Encodes the film, and then removes its frames, unless they are to be kept. A base::StopScope can stop it.
  ///
  /// Errors     base::Error: kIo if ffmpeg fails, kCannotCreate, kStopped; the frames stay
  void encode(const std::vector<int>& frames) const;

 private:
  std::filesystem::path file_, folder_;
  double fps_;
  bool keeps_frames_;
  int lock_ = -1;  ///< descriptor of the locked folder
};

}  // namespace orrery::cli
