// SPDX-License-Identifier: Apache-2.0
// Verifies the error guarantee of --noise: the ratio of true error to target, the efficiency relative to uniform
// sampling, and the bias. docs/trade.md describes it.
//
//   bench_noise_guarantee [--seeds 20] [--noise 0.3,0.1,0.03] [--width 64] [--most 4000]
//                         [--scene NAME] [--sampler NAME]
//   bench_noise_guarantee --bias [--seeds 1000] [--noise 0.1] [--width 96] [--scene NAME] [--sampler NAME]
//
// --scene and --sampler can be repeated. Each target is rendered with every seed, and again with uniform sampling and
// the same mean sample count. The reference is the mean of all uniform images of a scene; its error is subtracted. A
// target that needs more than --most samples per pixel is reported and skipped. Exit status 1 if fewer than 95 % of the
// true errors are within 1.1 times the target, if one exceeds 1.3 times the target, or if a bias is at least three
// standard errors.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
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
#include "format/read_scene.h"
#include "load/load_scene.h"
#include "render/render.h"
#include "render/result.h"
#include "render/settings.h"
#include "support/room.h"

namespace orrery::bench {
namespace {

struct Case {
  std::string name;
  std::function<scene::Scene()> scene;
};

/// A dim room with a mirror ball between camera and wall. The ball reflects the gaps behind the camera as small bright
/// spots, each in one pixel of some hundreds.
scene::Scene room_with_mirror() {
  scene::Scene s = test::room(3.7, 5, 64, 36);
  s.materials.push_back({"mirror", scene::Metal{{0.9, 0.9, 0.9}, 0}});
  s.spheres.push_back({{0.15, 0.1, -0.7}, 0.3, 1, ""});
  return s;
}

std::vector<Case> cases() {
  const std::filesystem::path folder = ORRERY_SCENES;
  const auto file = [&](const char* name) {
    return Case{std::filesystem::path(name).stem().string(), [path = folder / name] {
                  load::SceneRequest request;
                  request.source.file = path;
                  return load::read_with_data(request).scene;
                }};
  };
  const auto room = [](const char* name, double radius, double sky) {
    return Case{name, [=] { return test::room(radius, sky, 64, 36); }};
  };
  return {file("trade/contrast.toml"),
          file("trade/glass.toml"),
          file("trade/defocus.toml"),
          file("book/final.toml"),
          file("extremes/bubble-in-glass-in-water.toml"),
          file("extremes/far-from-home.toml"),
          file("extremes/huge-ground.toml"),
          file("extremes/telescope.toml"),
          file("light/caustic.toml"),
          file("light/three-point.toml"),
          file("light/thousand-lamps.toml"),
          file("light/grey-and-chrome.toml"),
          file("light/eclipse-ground.toml"),
          file("light/eclipse-space.toml"),
          file("next-week/07-lamp.toml"),
          {"mirror", room_with_mirror},
          room("room 3.7, sky 5", 3.7, 5),
          room("room 3.8, sky 50", 3.8, 50),
          room("room 3.88, sky 500", 3.88, 500),
          room("room 3.9, sky 500", 3.9, 500),
          room("room 3.95, sky 50", 3.95, 50)};
}

struct Options {
  bool bias = false;
  int seeds = 0, width = 0, most = 4000;
  std::vector<double> noise;
  std::vector<std::string> scenes, samplers;
};

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> out(1);
  for (const char c : text) {
    if (c == ',') {
      out.emplace_back();
    } else {
      out.back() += c;
    }
  }
  return out;
}

Options parse(int argc, char** argv) {
  Options o;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--bias") {
      o.bias = true;
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
  if (o.samplers.empty())
    o.samplers = o.bias ? std::vector<std::string>{"sobol"} : std::vector<std::string>{"sobol", "independent"};
  return o;
}

/// A compiled scene with its BVH, to be rendered with different seeds.
class Subject {
 public:
  Subject(scene::Scene s, const Options& o, const std::string& sampler) {
    s.image.width = o.width;
    s.image.height = o.width * 9 / 16;
    s.render.sampler = sampler == "independent" ? scene::Sampler::kIndependent : scene::Sampler::kSobol;
    compiled_ = compile::compile(s);
    accel_ = render::build(compiled_, render::available_threads());
  }

  std::size_t pixels() const {
    return static_cast<std::size_t>(compiled_.width) * static_cast<std::size_t>(compiled_.height);
  }

  render::Result adaptive(std::uint32_t seed, double noise, int most) {
    render::Settings settings;
    settings.sampling.noise = noise;
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

struct Score {
  int runs = 0, above = 0, far_above = 0;
};

/// Measures and prints the errors of all targets for one scene and sampler.
void measure_errors(const Case& c, const std::string& sampler, const Options& o, Score& score) {
  struct Target {
    double noise = 0, samples = 0;
    int uniform_samples = 0;
    std::vector<Values> adaptive, uniform;
    std::vector<double> reported;
  };
  Subject subject(c.scene(), o, sampler);
  std::vector<Target> targets;
  for (const double noise : o.noise) {
    Target t;
    t.noise = noise;
    bool is_within = true;
    for (int seed = 1; seed <= o.seeds && is_within; ++seed) {
      const render::Result r = subject.adaptive(static_cast<std::uint32_t>(seed), noise, o.most);
      is_within = r.statistics.ended_by == "noise";
      t.samples += static_cast<double>(r.statistics.paths) / static_cast<double>(subject.pixels()) / o.seeds;
      t.adaptive.push_back(values_of(r.picture));
      t.reported.push_back(*r.statistics.noise);
    }
    if (!is_within) {
      std::printf("%-26s %-11s %5g   needs more than %d samples per pixel\n", c.name.c_str(), sampler.c_str(), noise,
                  o.most);
      continue;
    }
    t.uniform_samples = static_cast<int>(std::lround(t.samples));
    for (int seed = 1; seed <= o.seeds; ++seed)
      t.uniform.push_back(
          values_of(subject.uniform(static_cast<std::uint32_t>(100000 + seed), t.uniform_samples).picture));
    targets.push_back(std::move(t));
  }
  if (targets.empty()) return;

  Values truth(3 * subject.pixels());
  double weights = 0;
  for (const Target& t : targets) {
    for (const Values& picture : t.uniform)
      for (std::size_t i = 0; i < truth.size(); ++i) truth[i] += picture[i] * t.uniform_samples;
    weights += static_cast<double>(t.uniform_samples) * o.seeds;
  }
  for (double& v : truth) v /= weights;

  for (const Target& t : targets) {
    // These images are part of the reference, which reduces their measured error by a known factor.
    const double part = t.uniform_samples / weights;
    std::vector<double> uniform, ratios;
    for (const Values& picture : t.uniform) uniform.push_back(squared_error(picture, truth) / (1 - part));
    const double of_truth = mean(uniform) * part;
    double adaptive = 0;
    for (const Values& picture : t.adaptive) {
      const double e = std::max(squared_error(picture, truth) - of_truth, 0.0);
      adaptive += e / o.seeds;
      ratios.push_back(std::sqrt(e) / t.noise);
    }
    std::sort(ratios.begin(), ratios.end());
    const std::size_t tail = ratios.size() / 20;
    const auto above = std::count_if(ratios.begin(), ratios.end(), [](double r) { return r > 1.1; });
    score.runs += o.seeds;
    score.above += static_cast<int>(above);
    score.far_above += static_cast<int>(std::count_if(ratios.begin(), ratios.end(), [](double r) { return r > 1.3; }));
    std::printf("%-26s %-11s %5g   %.2f [%.2f - %.2f] %.2f %6td %9.0f   %.2f\n", c.name.c_str(), sampler.c_str(),
                t.noise, ratios[ratios.size() / 2], ratios[tail], ratios[ratios.size() - 1 - tail], ratios.back(),
                above, t.samples, mean(uniform) > 0 ? adaptive / mean(uniform) : 0.0);
    std::fflush(stdout);
  }
}

/// Compares the mean radiance of the image over many seeds between adaptive and uniform sampling.
///
/// Result     the difference in standard errors
double measure_bias(const Case& c, const std::string& sampler, double noise, const Options& o) {
  Subject subject(c.scene(), o, sampler);
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
        "%-26s %-11s %5s   true error / target: median [5 - 95 %%] maximum; above 1.1; samples; MSE / uniform MSE\n",
        "scene", "sampler", "noise");
  }
  Score score;
  double largest_bias = 0;
  for (const Case& c : cases()) {
    if (!is_wanted(c.name)) continue;
    for (const std::string& sampler : o.samplers) {
      if (!o.bias) {
        measure_errors(c, sampler, o, score);
        continue;
      }
      for (const double noise : o.noise)
        largest_bias = std::max(largest_bias, std::abs(measure_bias(c, sampler, noise, o)));
    }
  }
  if (o.bias) return largest_bias < 3 ? 0 : 1;
  std::printf("%d runs: %d above 1.1, %d above 1.3 times the target\n", score.runs, score.above, score.far_above);
  return score.above * 20 <= score.runs && score.far_above == 0 ? 0 : 1;
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
