// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "measure/bench_scene.h"
#include "film/picture.h"
#include "job/scene_source.h"

namespace orrery::measure {

struct Request {
  job::SceneSource scene;
  std::filesystem::path report;  ///< file that the caller will write; refused where it is read
  std::string isa;               ///< empty: the processor's best
  int threads = 0;               ///< 0: as many as this process may use
  double budget_s = 120;         ///< for everything
  double noise = 0.01;           ///< that the recommendation shall reach
  /// Above 0: seconds are counted in paths, so many a second, and not by the clock; then the same is measured on every
  /// machine. For tests.
  double paths_per_s = 0;
  const std::atomic<bool>* cancel = nullptr;
  std::function<void(const std::string& what, double fraction)> on_progress;
};

/// What a choice comes to. Errors are those of film::display_error_squared, roots of means over pixels.
struct Point {
  std::string axis;          ///< "samples", "sampler", "precision" ...
  std::string name;          ///< "64 independent"
  std::string flags;         ///< that choose it on the command line
  double samples = 0;        ///< per pixel, mean
  double seconds = 0;        ///< to render one picture of the study's size
  double error = 0;          ///< root of noise^2 + bias^2
  double bias = 0;           ///< part of it that more samples would not take away; 0 if none was found
  double noise = 0;          ///< the rest
  double bias_squared = 0;   ///< unbiased estimate, also below 0
  double bias_chance = 1;    ///< bound on the probability that an unbiased choice gives as large an estimate
  double energy = 0;         ///< excess light, relative to all light
  double efficiency = 0;     ///< 1 / (error^2 seconds)
  std::uint64_t memory = 0;  ///< bytes, estimated
  bool is_shortcut = false;  ///< gives another picture than the scene asks for, however many samples
  bool on_front = false;     ///< nothing else is both quicker and better
  film::Picture picture;     ///< planes R, G, B
};

/// What a way of writing the picture comes to.
struct FilePoint {
  std::string name;  ///< "half zips"
  std::string flags;
  std::uint64_t bytes = 0;
  double write_s = 0;
  double error = 0;  ///< display error that writing brings in
};

/// A line of points by rising samples, and how steep it falls.
struct Slope {
  std::string name;
  double slope = 0;  ///< of log error by log samples
};

struct Recommendation {
  std::string words;
  std::string command;
  double noise = 0, bias = 0;   ///< that the picture will have
  double seconds = 0;           ///< of rendering, at the scene's size
  double samples = 0;           ///< per pixel
  double baseline_seconds = 0;  ///< for the same error with the scene's own settings, the same samples in all pixels
};

struct Study {
  std::string scene_hash, scene, version;
  int width = 0, height = 0;              ///< px, of the study
  int scene_width = 0, scene_height = 0;  ///< px
  std::uint64_t spheres = 0;
  int threads = 0;
  std::string isa;
  double seconds = 0, budget_s = 0;
  double reference_noise = 0, reference_samples = 0, reference_s = 0;
  film::Picture reference;
  std::vector<Point> points;
  std::vector<FilePoint> files;
  std::vector<Slope> slopes;
  std::vector<std::string> left_out;  ///< axes that this scene cannot feel, and points that the budget did not allow
  std::vector<measure::FeatureCost> features;
  Recommendation recommendation;
};

/// Measures what this scene's shortcuts cost and bring.
///
/// Renders a reference and each choice twice, with different seeds: errors that all of them have in common are bias,
/// the rest is noise. Finds a recommendation, and tries it at the scene's own size. What the budget does not allow is
/// left out and named.
///
/// Errors     as job::run_job; base::Error(kUsage) if the budget does not allow a reference and two choices, with what
///            these need; kStopped
Study run_study(const Request& request);

/// For people.
std::string study_text(const Study& study);
/// As JSON, "orrery.study/1"; pictures are left out.
std::string study_json(const Study& study);
/// One file with everything in it; see report.cpp.
std::string study_html(const Study& study);

}  // namespace orrery::measure
