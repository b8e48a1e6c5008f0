// SPDX-License-Identifier: Apache-2.0
#include "study/findings.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

namespace orrery::study {

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
