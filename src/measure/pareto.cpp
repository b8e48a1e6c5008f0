// SPDX-License-Identifier: Apache-2.0
#include "measure/pareto.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "measure/study.h"

namespace orrery::measure {

void test_bias(std::vector<Point>& points) {
  std::vector<Point*> by_chance;
  for (Point& p : points) {
    p.bias = 0;
    p.error = p.noise;
    by_chance.push_back(&p);
  }
  std::stable_sort(by_chance.begin(), by_chance.end(),
                   [](const Point* a, const Point* b) { return a->bias_chance < b->bias_chance; });
  auto untested = static_cast<double>(points.size());
  for (Point* p : by_chance) {
    if (p->bias_chance * untested-- > kFamilyWiseError) break;
    const double common = std::sqrt(p->bias_squared);
    p->error = std::hypot(p->noise, common);
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

}  // namespace orrery::measure
