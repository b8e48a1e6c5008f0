// SPDX-License-Identifier: Apache-2.0
#include "study/biases.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include <fmt/core.h>

#include "compare/color_view.h"
#include "compare/errors.h"
#include "film/display_error.h"
#include "study/study.h"

namespace orrery::study {

namespace {

double value(const compare::ColorView& picture, int channel, std::size_t pixel) {
  return static_cast<double>(picture.channel[channel][pixel]);
}

}  // namespace

film::Picture mean_of(const Pair& pair) {
  film::Picture mean = pair.first;
  for (std::size_t p = 0; p < mean.planes.size(); ++p)
    for (std::size_t i = 0; i < mean.planes[p].values.size(); ++i)
      mean.planes[p].values[i] = mean.planes[p].values[i] / 2 + pair.second.planes[p].values[i] / 2;
  return mean;
}

std::string spread_warning(double first_s, double second_s) {
  constexpr double kLargestSpread = 1.3;
  const auto [least, greatest] = std::minmax(first_s, second_s);
  if (greatest <= kLargestSpread * least) return {};
  return fmt::format("the times of its two renders differ by a factor of {:.1f}; repeat the study on an idle machine",
                     greatest / least);
}

double noise_of_mean(const Pair& pair) {
  const compare::ColorView r = compare::color_of(pair.first), s = compare::color_of(pair.second);
  double sum = 0;
  for (std::size_t i = 0; i < r.pixels(); ++i) {
    double squares = 0, light = 0;
    for (int c = 0; c < 3; ++c) {
      squares += std::pow(value(r, c, i) - value(s, c, i), 2) / 4;
      light += (value(r, c, i) + value(s, c, i)) / 2;
    }
    sum += film::display_error_squared(squares, light);
  }
  return std::sqrt(sum / static_cast<double>(r.pixels()));
}

Errors errors_of(const Pair& choice, const Pair& reference) {
  const compare::ColorView x = compare::color_of(choice.first), y = compare::color_of(choice.second);
  const compare::ColorView r = compare::color_of(reference.first), s = compare::color_of(reference.second);
  double sum = 0, sum_of_squares = 0, sum_of_fourths = 0;
  double noise = 0, excess = 0, all_light = 0;
  for (std::size_t i = 0; i < r.pixels(); ++i) {
    double products = 0, squares = 0, light = 0;
    for (int c = 0; c < 3; ++c) {
      const double a = value(x, c, i), b = value(y, c, i), p = value(r, c, i), q = value(s, c, i);
      products += ((a - p) * (b - q) + (a - q) * (b - p)) / 2;
      squares += (a - b) * (a - b) / 2;
      light += (p + q) / 2;
      excess += (a + b - p - q) / 2;
    }
    all_light += light;
    noise += film::display_error_squared(squares, light);
    const double bias_squared = film::display_error_squared(products, light);
    sum += bias_squared;
    const double square = bias_squared * bias_squared;
    sum_of_squares += square;
    sum_of_fourths += square * square;
  }
  const auto n = static_cast<double>(r.pixels());
  Errors out;
  out.noise = std::sqrt(noise / n);
  out.bias_squared = sum / n;
  // Quotients, because squares of large sums overflow.
  const double effective_count = sum > 0 ? sum_of_squares / (sum_of_fourths / sum_of_squares) : 0;
  if (effective_count >= kMinEffectiveCount) out.bias_chance = std::exp(-sum * sum / sum_of_squares / 2);
  out.energy = all_light != 0 ? excess / all_light : 0;
  return out;
}

void test_bias(std::vector<Point>& points) {
  std::vector<Point*> by_chance;
  for (Point& p : points) {
    p.bias = 0;
    p.error = p.measured.noise;
    by_chance.push_back(&p);
  }
  std::stable_sort(by_chance.begin(), by_chance.end(),
                   [](const Point* a, const Point* b) { return a->measured.bias_chance < b->measured.bias_chance; });
  auto untested = static_cast<double>(points.size());
  for (Point* p : by_chance) {
    if (p->measured.bias_chance * untested-- > compare::kFamilyWiseError) break;
    const double common = std::sqrt(p->measured.bias_squared);
    p->error = std::hypot(p->measured.noise, common);
    if (p->is_shortcut) p->bias = common;
  }
  for (Point& p : points) p.efficiency = 1 / (p.error * p.error * p.seconds);
}

std::vector<Slope> slopes_of(const std::vector<Point>& all) {
  std::vector<Slope> out;
  std::map<std::string, std::vector<const Point*>> lines;
  for (const Point& p : all)
    if ((p.axis == "samples" || p.axis == "sampler") && p.error > 0)
      lines[p.name.substr(p.name.find(' ') + 1)].push_back(&p);
  for (const auto& [name, points] : lines) {
    if (points.size() < 2) continue;
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (const Point* p : points) {
      const double x = std::log(p->samples), y = std::log(p->error);
      n += 1;
      sx += x;
      sy += y;
      sxx += x * x;
      sxy += x * y;
    }
    out.push_back({name, (n * sxy - sx * sy) / (n * sxx - sx * sx)});
  }
  return out;
}

void mark_front(std::vector<Point>& points) {
  for (Point& p : points)
    p.on_front = p.axis != "accelerator" && std::none_of(points.begin(), points.end(), [&](const Point& other) {
                   return other.axis != "accelerator" && other.seconds <= p.seconds && other.error <= p.error &&
                          (other.seconds < p.seconds || other.error < p.error);
                 });
}

}  // namespace orrery::study
