// SPDX-License-Identifier: Apache-2.0
#include "study/paired_errors.h"

#include <algorithm>
#include <cmath>

#include "film/display_error.h"
#include "metrics/color_view.h"

namespace orrery::study {

Errors errors_of(const film::Picture& a, const film::Picture& b, const film::Picture& reference,
                 double reference_noise) {
  const metrics::ColorView x = metrics::color_of(a), y = metrics::color_of(b), r = metrics::color_of(reference);
  double together = 0, apart = 0, excess = 0, light = 0;
  for (std::size_t i = 0; i < r.pixels(); ++i) {
    double products = 0, squares = 0, sum = 0;
    for (int c = 0; c < 3; ++c) {
      const double truth = static_cast<double>(r.channel[c][i]);
      const double dx = static_cast<double>(x.channel[c][i]) - truth, dy = static_cast<double>(y.channel[c][i]) - truth;
      products += dx * dy;
      squares += (dx - dy) * (dx - dy) / 2;
      sum += truth;
      excess += (dx + dy) / 2;
    }
    light += sum;
    together += film::display_error_squared(products, sum);
    apart += film::display_error_squared(squares, sum);
  }
  const auto n = static_cast<double>(r.pixels());
  Errors out;
  const double bias2 = std::max(0.0, together / n - reference_noise * reference_noise);
  // The estimate of a bias that is none scatters by about this; what is below is not told as one.
  const double scatter = apart / n / std::sqrt(n) * 3 + reference_noise * reference_noise * 0.3;
  out.bias = bias2 > scatter ? std::sqrt(bias2) : 0;
  out.noise = std::sqrt(apart / n);
  out.error = std::sqrt(out.noise * out.noise + out.bias * out.bias);
  out.energy = light != 0 ? excess / light : 0;
  return out;
}

}  // namespace orrery::study
