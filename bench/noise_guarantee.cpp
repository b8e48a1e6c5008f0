// SPDX-License-Identifier: Apache-2.0
// Verifies the error guarantee of --noise: the ratio of true error to target, the efficiency relative to uniform
// sampling, and the bias. docs/trade.md describes it.
//
//   bench_noise_guarantee [--seeds 20] [--noise 0.3,0.1,0.03] [--width 64] [--most 4000] [--cache FOLDER]
//                         [--set ordinary|committed|hard|held-out] [--scene NAME] [--sampler NAME] [--halves]
//   bench_noise_guarantee --bias [--seeds 1000] [--noise 0.1] [--width 96] [--scene NAME] [--sampler NAME]
//
// --set, --scene and --sampler can be repeated. Each target is rendered with every seed, and with a few seeds by
// uniform sampling with the same mean sample count. The reference is the mean of two uniform images, whose samples are
// doubled until their error is a fifth of the smallest target, or the limit is reached; their remaining error is
// subtracted.
// --halves renders images as for --denoise, which take fewer samples before the first estimate.
// --cache keeps the references for the next run. Runs that need more than --most samples per pixel, or report pixels
// whose noise cannot be estimated, are counted as "not reached". Exit status 1 if fewer than 98 % of the other true
// errors are within 1.1 times the target, if one exceeds 1.3 times the target, or if a bias is at least three standard
// errors.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "accel/accel.h"
#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "film/display_error.h"
#include "film/picture.h"
#include "noise_scenes.h"
#include "render/render.h"
#include "render/result.h"
#include "render/settings.h"

namespace orrery::bench {
namespace {

struct Options {
  bool bias = false, halves = false;
  int seeds = 0, width = 0, most = 4000;
  std::vector<double> noise;
  std::vector<std::string> sets, scenes, samplers;
  std::filesystem::path cache;
};

Options parse(int argc, char** argv) {
  Options o;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--bias") {
      o.bias = true;
      continue;
    }
    if (word == "--halves") {
      o.halves = true;
      continue;
    }
    if (i + 1 == argc) throw std::runtime_error("unknown option, or its value is missing: " + word);
    const std::string value = argv[++i];
    if (word == "--seeds") {
      o.seeds = std::atoi(value.c_str());
    } else if (word == "--width") {
      o.width = std::atoi(value.c_str());
    } else if (word == "--most") {
      o.most = std::atoi(value.c_str());
    } else if (word == "--noise") {
      for (const std::string& v : split(value)) o.noise.push_back(std::atof(v.c_str()));
    } else if (word == "--cache") {
      o.cache = value;
    } else if (word == "--set") {
      o.sets.push_back(value);
    } else if (word == "--scene") {
      o.scenes.push_back(value);
    } else if (word == "--sampler") {
      o.samplers.push_back(value);
    } else {
      throw std::runtime_error("unknown option: " + word);
    }
  }
  if (o.seeds == 0) o.seeds = o.bias ? 1000 : 20;
  if (o.width == 0) o.width = o.bias ? 96 : 64;
  if (o.noise.empty()) o.noise = o.bias ? std::vector<double>{0.1} : std::vector<double>{0.3, 0.1, 0.03};
  if (o.sets.empty())
    o.sets = o.scenes.empty() ? std::vector<std::string>{"ordinary"}
                              : std::vector<std::string>{"committed", "hard", "held-out"};
  if (o.samplers.empty())
    o.samplers = o.bias ? std::vector<std::string>{"sobol"} : std::vector<std::string>{"sobol", "independent"};
  return o;
}

/// A compiled scene with its BVH, to be rendered with different seeds.
class Subject {
 public:
  Subject(NoiseScene s, const Options& o, const std::string& sampler) : halves_(o.halves) {
    for (scene::Scene* const at : {&s.opening, s.closing ? &*s.closing : nullptr}) {
      if (at == nullptr) continue;
      at->image = {o.width, o.width * 9 / 16};
      at->render.sampler = sampler == "independent" ? scene::Sampler::kIndependent : scene::Sampler::kSobol;
      at->render.caustics = false;  // the rule is tested with light that is hard to find
    }
    compiled_ = compile::compile(s.opening, s.closing ? &*s.closing : nullptr);
    accel_ = render::build(compiled_, render::available_threads());
  }

  std::size_t pixels() const {
    return static_cast<std::size_t>(compiled_.width) * static_cast<std::size_t>(compiled_.height);
  }

  render::Result adaptive(std::uint32_t seed, double noise, int most) {
    render::Settings settings;
    settings.noise = noise;
    settings.layers.halves = halves_;
    return run(seed, most, settings);
  }
  render::Result uniform(std::uint32_t seed, int samples) { return run(seed, samples, {}); }

 private:
  render::Result run(std::uint32_t seed, int samples, render::Settings settings) {
    settings.traversal = accel::Traversal::kPacket;
    compiled_.sampler.seed = seed;
    compiled_.samples = samples;
    return render::render(compiled_, *accel_, settings);
  }

  bool halves_;
  compile::CompiledScene compiled_;
  std::unique_ptr<accel::Accel> accel_;
};

using Values = std::vector<double>;  // the planes R, G, B, one after another

Values values_of(const film::Picture& picture) {
  Values out;
  for (std::size_t c = 0; c < 3; ++c)
    out.insert(out.end(), picture.planes[c].values.begin(), picture.planes[c].values.end());
  return out;
}

double squared_error(const Values& picture, const Values& truth) {
  const std::size_t pixels = truth.size() / 3;
  double sum = 0;
  for (std::size_t i = 0; i < pixels; ++i) {
    double squares = 0, light = 0;
    for (std::size_t at = i; at < truth.size(); at += pixels) {
      squares += (picture[at] - truth[at]) * (picture[at] - truth[at]);
      light += truth[at];
    }
    sum += film::display_error_squared(squares, light);
  }
  return sum / static_cast<double>(pixels);
}

double mean(const std::vector<double>& v) {
  double sum = 0;
  for (const double x : v) sum += x;
  return sum / static_cast<double>(v.size());
}

double standard_error(const std::vector<double>& v) {
  const double m = mean(v);
  double sum = 0;
  for (const double x : v) sum += (x - m) * (x - m);
  return std::sqrt(sum / static_cast<double>(v.size() - 1) / static_cast<double>(v.size()));
}

/// The image without noise, as far as it is known.
struct Reference {
  Values values;
  double squared_error = 0;  ///< expected
};

/// Adds up images with different seeds until the error of their mean is low enough.
Reference render_reference(Subject& subject, double wanted_error) {
  constexpr int kFirst = 1024, kSteps = 8;
  Values halves[2];
  Reference out;
  double weight = 0;
  for (int step = 0; step < kSteps; ++step) {
    const int samples = kFirst << std::max(step - 1, 0);  // doubles the total
    for (std::size_t half = 0; half < 2; ++half) {
      const auto seed = static_cast<std::uint32_t>(200000 + 2 * step + static_cast<int>(half));
      const Values picture = values_of(subject.uniform(seed, samples).picture);
      halves[half].resize(picture.size());
      for (std::size_t i = 0; i < picture.size(); ++i) halves[half][i] += picture[i] * samples;
    }
    weight += samples;
    out.values.resize(halves[0].size());
    for (std::size_t i = 0; i < out.values.size(); ++i) out.values[i] = (halves[0][i] + halves[1][i]) / (2 * weight);
    Values one = halves[0];
    for (double& v : one) v /= weight;
    out.squared_error = squared_error(one, out.values);
    if (out.squared_error <= wanted_error * wanted_error) break;
  }
  return out;
}

/// The reference of a scene, from the cache if there is one.
Reference reference_of(const NoiseCase& c, const Options& o) {
  const auto file = o.cache / (c.name + "-" + std::to_string(o.width) + ".reference");
  Reference out;
  out.values.resize(3 * static_cast<std::size_t>(o.width) * static_cast<std::size_t>(o.width * 9 / 16));
  const auto bytes = static_cast<std::streamsize>(out.values.size() * sizeof(double));
  const auto data = reinterpret_cast<char*>(out.values.data());
  if (!o.cache.empty()) {
    std::ifstream in(file, std::ios::binary);
    if (in.read(reinterpret_cast<char*>(&out.squared_error), sizeof(double)) && in.read(data, bytes)) return out;
  }
  Subject subject(c.scene(), o, "sobol");
  out = render_reference(subject, 0.2 * *std::min_element(o.noise.begin(), o.noise.end()));
  if (!o.cache.empty()) {
    std::ofstream to(file, std::ios::binary);
    to.write(reinterpret_cast<const char*>(&out.squared_error), sizeof(double));
    to.write(reinterpret_cast<const char*>(out.values.data()), bytes);
  }
  return out;
}

/// Measures and prints the errors of one target for one scene and sampler.
///
/// Result     false if no run reached the target
bool measure_errors(const NoiseCase& c, Subject& subject, const std::string& sampler, double noise,
                    const Reference& truth, const Options& o, NoiseScore& score) {
  constexpr int kUniformSeeds = 4;
  std::vector<double> ratios;
  int not_reached = 0;
  double samples = 0, adaptive = 0, uniform = 0;
  for (int seed = 1; seed <= o.seeds && not_reached < 3 + seed / 4; ++seed) {
    const render::Result r = subject.adaptive(static_cast<std::uint32_t>(seed), noise, o.most);
    if (r.statistics.ended_by != "noise" || r.statistics.unreliable_pixels > 0) {
      ++not_reached;
      continue;
    }
    samples += static_cast<double>(r.statistics.paths) / static_cast<double>(subject.pixels());
    const double e = std::max(squared_error(values_of(r.picture), truth.values) - truth.squared_error, 0.0);
    adaptive += e;
    ratios.push_back(std::sqrt(e) / noise);
  }
  std::printf("%-26s %-11s %5g   ", c.name.c_str(), sampler.c_str(), noise);
  if (ratios.empty()) {
    score.not_reached += not_reached;
    std::printf("not reached with %d samples per pixel\n", o.most);
    return false;
  }
  const auto runs = static_cast<double>(ratios.size());
  samples /= runs;
  for (int seed = 1; seed <= kUniformSeeds; ++seed) {
    const Values picture = values_of(
        subject.uniform(static_cast<std::uint32_t>(100000 + seed), static_cast<int>(std::lround(samples))).picture);
    uniform += std::max(squared_error(picture, truth.values) - truth.squared_error, 0.0) / kUniformSeeds;
  }
  score.add(ratios, not_reached);
  std::printf("  %7.0f   %.2f   %.2f\n", samples, uniform > 0 ? adaptive / runs / uniform : 0.0,
              std::sqrt(truth.squared_error) / noise);
  std::fflush(stdout);
  return true;
}

/// Compares the mean radiance of the image over many seeds between adaptive and uniform sampling.
///
/// Result     the difference in standard errors
double measure_bias(const NoiseCase& c, Subject& subject, const std::string& sampler, double noise, const Options& o) {
  const auto light = [](const render::Result& r) { return mean(values_of(r.picture)); };
  std::vector<double> adaptive, uniform;
  double samples = 0;
  for (int seed = 1; seed <= o.seeds; ++seed) {
    const render::Result r = subject.adaptive(static_cast<std::uint32_t>(seed), noise, 1 << 24);
    samples += static_cast<double>(r.statistics.paths) / static_cast<double>(subject.pixels()) / o.seeds;
    adaptive.push_back(light(r));
    // Twice the samples of the adaptive image, so that the uniform mean does not limit the comparison.
    uniform.push_back(light(
        subject.uniform(static_cast<std::uint32_t>(100000 + seed), static_cast<int>(2 * samples * o.seeds / seed))));
  }
  const double off = mean(adaptive) / mean(uniform) - 1;
  const double error = std::hypot(standard_error(adaptive), standard_error(uniform)) / mean(uniform);
  std::printf("%-26s %-11s %5g %8.0f   %+.1e   %.1e   %+.1f\n", c.name.c_str(), sampler.c_str(), noise, samples, off,
              error, off / error);
  std::fflush(stdout);
  return off / error;
}

int run(int argc, char** argv) {
  const Options o = parse(argc, argv);
  const auto is_wanted = [&](const std::string& name) {
    return o.scenes.empty() || std::find(o.scenes.begin(), o.scenes.end(), name) != o.scenes.end();
  };
  if (o.bias) {
    std::printf("%-26s %-11s %5s %8s   %8s   %7s   sigma\n", "scene", "sampler", "noise", "samples", "bias", "+-");
  } else {
    std::printf(
        "%-26s %-11s %5s   true error / target: median, maximum; above 1.1, above 1.3; samples; MSE / uniform MSE; "
        "error of "
        "the reference / target\n",
        "scene", "sampler", "noise");
  }
  NoiseScore score;
  double largest_bias = 0;
  for (const std::string& set : o.sets) {
    for (const NoiseCase& c : scenes_of(set)) {
      if (!is_wanted(c.name)) continue;
      const Reference truth = o.bias ? Reference() : reference_of(c, o);
      for (const std::string& sampler : o.samplers) {
        Subject subject(c.scene(), o, sampler);
        for (const double noise : o.noise) {
          if (o.bias) {
            largest_bias = std::max(largest_bias, std::abs(measure_bias(c, subject, sampler, noise, o)));
          } else if (!measure_errors(c, subject, sampler, noise, truth, o, score)) {
            break;  // smaller targets need even more samples
          }
        }
      }
    }
  }
  if (o.bias) return largest_bias < 3 ? 0 : 1;
  return score.report();
}

}  // namespace
}  // namespace orrery::bench

int main(int argc, char** argv) {
  try {
    return orrery::bench::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_noise_guarantee: %s\n", error.what());
    return 2;
  }
}
