// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "film/picture.h"
#include "load/load_scene.h"

namespace orrery::study {

/// Scene and limits of a study.
struct Request {
  load::SceneSource scene;
  std::filesystem::path report;  ///< file that the caller will write; checked for conflicts with input files
  int threads = 0;               ///< 0: as many as this process may use
  double budget_s = 120;         ///< time for the whole study
  double noise = 0.01;           ///< target noise of the recommendation
  /// If above 0, time is the number of paths divided by this rate instead of clock time, so that results do not depend
  /// on the machine. For tests.
  double paths_per_s = 0;
  const std::atomic<bool>* cancel = nullptr;
  std::function<void(const std::string& what, double fraction)> on_progress;
};

/// Error estimates of a choice, from its two renders and those of the reference.
struct Errors {
  double noise = 0;         ///< error that more samples reduce
  double bias_squared = 0;  ///< unbiased estimate of the squared bias; can be negative
  double bias_chance = 1;   ///< upper bound of the p-value: probability of such an estimate without bias
  double energy = 0;        ///< mean radiance error, relative to the mean radiance
};

/// Result of one choice. Errors are root mean film::display_error_squared over the pixels.
struct Point {
  std::string axis;    ///< "samples", "sampler", "precision" ...
  std::string name;    ///< "64 independent"
  std::string flags;   ///< command-line options that select it
  double samples = 0;  ///< mean samples per pixel
  double seconds = 0;  ///< time to render one image of the study's size
  double error = 0;    ///< total error: noise, plus the error common to both renders if that is significant
  double bias = 0;     ///< error of a shortcut that more samples do not reduce; 0 if not significant
  Errors measured;
  double efficiency = 0;     ///< 1 / (error^2 seconds)
  std::uint64_t memory = 0;  ///< estimated bytes
  bool is_shortcut = false;  ///< converges to a different image than the scene's settings
  bool on_front = false;     ///< on the Pareto front of time and error
  film::Picture picture;     ///< planes R, G, B
};

/// Convergence rate of a sampler.
struct Slope {
  std::string name;
  double slope = 0;  ///< slope of log error over log samples
};

/// Recommended settings for the target noise, with the forecast of a render.
struct Recommendation {
  std::string words;
  std::string command;
  double noise = 0, bias = 0;   ///< expected errors of the image
  double seconds = 0;           ///< render time at full resolution
  double samples = 0;           ///< mean samples per pixel
  double baseline_seconds = 0;  ///< render time for the same error with independent samples, uniform over the image
};

/// Results of a study.
struct Study {
  std::string scene_hash, scene, version;
  int width = 0, height = 0;              ///< image size of the study, px
  int scene_width = 0, scene_height = 0;  ///< image size of the scene, px
  std::uint64_t spheres = 0;
  int threads = 0;
  std::string isa;
  double seconds = 0, budget_s = 0;
  double reference_noise = 0, reference_samples = 0, reference_s = 0;
  film::Picture reference;
  std::vector<Point> points;
  std::vector<Slope> slopes;
  std::vector<std::string> left_out;  ///< axes without effect on this scene, and choices that exceed the budget
  std::vector<std::string> warnings;  ///< why times may be wrong
  Recommendation recommendation;
};

/// Measures time and error of the render settings for a scene, and recommends settings for the target noise.
///
/// Renders a reference and each choice twice, with different seeds: an error common to both renders is bias, the rest
/// is noise. Tests the recommendation at full resolution. Choices that exceed the budget are skipped and listed.
///
/// Errors     those of job::run_job; base::Error(kUsage) with the time needed if the budget is too small for a
///            reference and two choices; kStopped
Study run_study(const Request& request);

/// A study as a text table.
std::string study_text(const Study& study);
/// A study as JSON, schema "orrery.study/1", without images.
std::string study_json(const Study& study);
/// A study as a self-contained HTML page.
std::string study_html(const Study& study);

}  // namespace orrery::study
