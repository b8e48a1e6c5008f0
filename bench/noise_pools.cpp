// SPDX-License-Identifier: Apache-2.0
// Simulates --noise on recorded samples, which is much faster than rendering: the same rule, with samples
// drawn at random from those that were recorded for each pixel, whose mean is exactly known. bench_noise_guarantee
// renders instead, also with Sobol points.
//
//   bench_noise_pools [--seeds 100] [--noise 0.3,0.1,0.03] [--width 32] [--samples 4096] [--most 100000]
//                     [--set ordinary|committed|hard|held-out] [--scene NAME]
//
// Prints a line per scene and target: true error / target, samples per pixel, and the bias of the image's mean light
// with its standard error. "not reached" counts runs that need more than --most samples per pixel, or report pixels
// whose noise cannot be estimated. Exit status 1 if fewer than 98 % of the other runs are within 1.1 times the target,
// or one exceeds 1.3 times.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "film/display_error.h"
#include "film/picture.h"
#include "kernel/pixel_sum.h"
#include "noise_scenes.h"
#include "render/allocation.h"
#include "render/emitter_coverage.h"
#include "render/pixel_noise.h"
#include "render/render.h"
#include "render/result.h"
#include "render/settings.h"
#include "render/tiles.h"

namespace orrery::bench {
namespace {

struct Options {
  int seeds = 100, width = 32, samples = 4096;
  double most = 100000;
  std::vector<double> noise;
  std::vector<std::string> sets, scenes;
};

Options parse(int argc, char** argv) {
  Options o;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (i + 1 == argc) throw std::runtime_error("unknown option, or its value is missing: " + word);
    const std::string value = argv[++i];
    if (word == "--seeds") {
      o.seeds = std::atoi(value.c_str());
    } else if (word == "--width") {
      o.width = std::atoi(value.c_str());
    } else if (word == "--samples") {
      o.samples = std::atoi(value.c_str());
    } else if (word == "--most") {
      o.most = std::atof(value.c_str());
    } else if (word == "--noise") {
      for (const std::string& v : split(value)) o.noise.push_back(std::atof(v.c_str()));
    } else if (word == "--set") {
      o.sets.push_back(value);
    } else if (word == "--scene") {
      o.scenes.push_back(value);
    } else {
      throw std::runtime_error("unknown option: " + word);
    }
  }
  if (o.noise.empty()) o.noise = {0.3, 0.1, 0.03};
  if (o.sets.empty()) o.sets = {"committed", "hard", "held-out"};
  return o;
}

/// Samples of every pixel.
class Pool {
 public:
  struct Sample {
    float rgb[3];
  };

  Pool(NoiseScene scene, const Options& o) : width_(o.width), height_(o.width * 9 / 16) {
    const auto compiled = [&](int side) {
      for (scene::Scene* const s : {&scene.opening, scene.closing ? &*scene.closing : nullptr}) {
        if (s == nullptr) continue;
        s->image = {side * width_, side * height_};
        s->render.sampler = scene::Sampler::kIndependent;
        s->render.samples = 1;
        s->render.caustics = false;  // the rule is tested with light that is hard to find
      }
      return compile::compile(scene.opening, scene.closing ? &*scene.closing : nullptr);
    };
    const compile::CompiledScene small = compiled(1);
    const auto accel = render::build(small, 1, {});
    emitters_ = render::emitter_coverage(small.view(), {accel->tracer(), small.precision}, width_, height_);
    // The samples of a pixel are pixels of a larger image.
    const int side = std::max(1, static_cast<int>(std::sqrt(o.samples)));
    count_ = static_cast<std::size_t>(side * side);
    samples_.resize(count_ * pixels());
    const film::Picture picture = render::render(compiled(side), {}).picture;
    std::vector<std::size_t> filled(pixels());
    for (int y = 0; y < side * height_; ++y) {
      for (int x = 0; x < side * width_; ++x) {
        const auto i = static_cast<std::size_t>(y / side * width_ + x / side);
        const auto at =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(side * width_) + static_cast<std::size_t>(x);
        Sample& sample = samples_[i * count_ + filled[i]++];
        for (std::size_t c = 0; c < 3; ++c) sample.rgb[c] = picture.planes[c].values[at];
      }
    }
    mean_.resize(pixels());
    for (std::size_t k = 0; k < samples_.size(); ++k)
      for (std::size_t c = 0; c < 3; ++c)
        mean_[k / count_][c] += static_cast<double>(samples_[k].rgb[c]) / static_cast<double>(count_);
  }

  int width() const { return width_; }
  int height() const { return height_; }
  std::size_t pixels() const { return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_); }
  const std::vector<render::EmitterCoverage>& emitters() const { return emitters_; }
  const Sample& sample(std::size_t pixel, std::uint32_t random) const {
    return samples_[pixel * count_ + (std::uint64_t{random} * count_ >> 32)];
  }
  const std::array<double, 3>& mean(std::size_t pixel) const { return mean_[pixel]; }

 private:
  int width_, height_;
  std::size_t count_;  ///< samples per pixel
  std::vector<Sample> samples_;
  std::vector<std::array<double, 3>> mean_;
  std::vector<render::EmitterCoverage> emitters_;
};

/// One image, rendered until the rule ends it.
struct Run {
  bool reached = false;
  double ratio = 0;    ///< true error / target
  double samples = 0;  ///< per pixel
  double light = 0;    ///< mean over pixels and channels
};

Run simulate(const Pool& pool, double noise, unsigned seed, double most) {
  struct Halves {
    double rgb[2][3] = {};
    float largest = 0;
  };
  render::TilePool threads(1);
  render::PixelStatistics s(pool.width(), pool.height());
  s.emitters = pool.emitters();
  std::vector<Halves> sums(pool.pixels());
  std::vector<std::uint32_t> goals(pool.pixels(), 8);
  std::mt19937 random(seed);
  Run out;
  for (;;) {
    double samples = 0;
    for (std::size_t i = 0; i < goals.size(); ++i) {
      Halves& h = sums[i];
      for (std::uint32_t k = s.samples[i]; k < goals[i]; ++k) {
        for (auto& half : h.rgb) {
          const Pool::Sample& sample = pool.sample(i, static_cast<std::uint32_t>(random()));
          for (int c = 0; c < 3; ++c) half[c] += static_cast<double>(sample.rgb[c]);
          h.largest = std::max(h.largest, std::abs(sample.rgb[0] + sample.rgb[1] + sample.rgb[2]));
        }
      }
      kernel::PixelSum halves[2];
      for (std::size_t k = 0; k < 2; ++k) {
        for (std::size_t c = 0; c < 3; ++c) halves[k].rgb[c] = kernel::to_fixed_point(h.rgb[k][c]);
        halves[k].weight = goals[i];
      }
      s.set(i, goals[i], halves[0], halves[1], h.largest);
      samples += 2.0 * goals[i];
    }
    out.samples = samples / static_cast<double>(goals.size());
    const double upper = render::estimate_noise(s, threads).upper();
    const render::UnreliablePixels unreliable =
        render::find_unreliable_pixels(s, threads, render::tolerated_error(upper, noise * noise));
    out.reached = upper <= noise * noise && unreliable.count == 0;
    if (out.reached || out.samples > most) break;
    render::IterationGoal goal;
    goal.error_ratio = std::min(noise * noise / upper, 1.0);
    goal.max_per_pixel = 1u << 30;
    goal.affordable = ~std::uint64_t{0};
    const auto selection =
        render::choose_pixels(s.samples, render::errors_of_one_sample(s, threads), unreliable.of_pixel, goal);
    if (!selection.any) break;
    for (std::size_t i = 0; i < goals.size(); ++i)
      if (selection.chosen[i]) goals[i] *= 2;
  }
  double error = 0;
  for (std::size_t i = 0; i < goals.size(); ++i) {
    double squares = 0, light = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double value = (sums[i].rgb[0][c] + sums[i].rgb[1][c]) / (2.0 * goals[i]), truth = pool.mean(i)[c];
      squares += (value - truth) * (value - truth);
      light += truth;
      out.light += value / static_cast<double>(3 * goals.size());
    }
    error += film::display_error_squared(squares, light);
  }
  out.ratio = std::sqrt(error / static_cast<double>(goals.size())) / noise;
  return out;
}

void measure(const NoiseCase& c, const Options& o, NoiseScore& score) {
  const Pool pool(c.scene(), o);
  double truth = 0;
  for (std::size_t i = 0; i < pool.pixels(); ++i)
    for (const double v : pool.mean(i)) truth += v / static_cast<double>(3 * pool.pixels());
  for (const double noise : o.noise) {
    std::vector<double> ratios;
    int not_reached = 0;
    double samples = 0, bias = 0, squares = 0;
    for (int seed = 1; seed <= o.seeds && not_reached < 3; ++seed) {
      const Run run = simulate(pool, noise, static_cast<unsigned>(seed), o.most);
      if (!run.reached) {
        ++not_reached;
        continue;
      }
      ratios.push_back(run.ratio);
      samples += run.samples;
      bias += run.light / truth - 1;
      squares += (run.light / truth - 1) * (run.light / truth - 1);
    }
    std::printf("%-26s %5g   ", c.name.c_str(), noise);
    if (ratios.empty()) {
      score.not_reached += not_reached;
      std::printf("not reached with %g samples per pixel\n", o.most);
      break;
    }
    const auto runs = static_cast<double>(ratios.size());
    score.add(ratios, not_reached);
    bias /= runs;
    const double error = std::sqrt(std::max(squares / runs - bias * bias, 0.0) / std::max(runs - 1, 1.0));
    std::printf("  %8.0f   %+.1e +- %.0e\n", samples / runs, bias, error);
    std::fflush(stdout);
  }
}

int run(int argc, char** argv) {
  const Options o = parse(argc, argv);
  std::printf("%-26s %5s   true error / target: median, maximum; above 1.1, above 1.3; samples; bias\n", "scene",
              "noise");
  NoiseScore score;
  for (const std::string& set : o.sets) {
    for (const NoiseCase& c : scenes_of(set))
      if (o.scenes.empty() || std::find(o.scenes.begin(), o.scenes.end(), c.name) != o.scenes.end())
        measure(c, o, score);
  }
  return score.report();
}

}  // namespace
}  // namespace orrery::bench

int main(int argc, char** argv) {
  try {
    return orrery::bench::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_noise_pools: %s\n", error.what());
    return 2;
  }
}
