// SPDX-License-Identifier: Apache-2.0
// Output of a study: text, JSON and a self-contained HTML page.
#include <cmath>
#include <cstdint>

#include <nlohmann/json.hpp>

#include <fmt/core.h>

#include "base/text.h"
#include "compare/color_view.h"
#include "compare/errors.h"
#include "display/develop.h"
#include "display/settings.h"
#include "image/write.h"
#include "job/report_text.h"
#include "study/study.h"

namespace orrery::study {

extern const char* const kReportPage;  // report_page.cpp.in

using nlohmann::json;

// Called by the JSON library.

static void to_json(json& out, const Point& p) {
  const Errors& e = p.measured;
  out = {{"axis", p.axis},           {"name", p.name},
         {"flags", p.flags},         {"samples", p.samples},
         {"seconds", p.seconds},     {"error", p.error},
         {"bias", p.bias},           {"noise", e.noise},
         {"energy", e.energy},       {"efficiency", p.efficiency},
         {"memory_bytes", p.memory}, {"is_shortcut", p.is_shortcut},
         {"on_front", p.on_front}};
}

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Slope, name, slope)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Recommendation, words, command, noise, bias, samples, seconds, baseline_seconds)

namespace {

/// Maximum width of the images on the page, px; keeps a page with twenty images within a few megabytes.
constexpr int kShownWidth = 480;

json study_object(const Study& s) {
  return {{"schema", "orrery.study/1"},
          {"version", s.version},
          {"scene", s.scene},
          {"scene_hash", s.scene_hash},
          {"scene_width", s.scene_width},
          {"scene_height", s.scene_height},
          {"width", s.width},
          {"height", s.height},
          {"spheres", s.spheres},
          {"threads", s.threads},
          {"isa", s.isa},
          {"seconds", s.seconds},
          {"budget_s", s.budget_s},
          {"reference", {{"noise", s.reference_noise}, {"samples", s.reference_samples}, {"seconds", s.reference_s}}},
          {"points", s.points},
          {"slopes", s.slopes},
          {"left_out", s.left_out},
          {"warnings", s.warnings},
          {"recommendation", s.recommendation}};
}

/// Downsamples an image to at most kShownWidth by averaging square blocks of pixels.
film::Picture downsampled(const film::Picture& from) {
  const int step = (from.width + kShownWidth - 1) / kShownWidth;
  if (step <= 1) return from;
  film::Picture out;
  out.width = from.width / step;
  out.height = from.height / step;
  for (const film::Plane& plane : from.planes) {
    film::Plane small{plane.name, {}};
    for (int y = 0; y < out.height; ++y) {
      for (int x = 0; x < out.width; ++x) {
        float sum = 0;
        for (int dy = 0; dy < step; ++dy)
          for (int dx = 0; dx < step; ++dx)
            sum += plane.values[static_cast<std::size_t>((y * step + dy) * from.width + x * step + dx)];
        small.values.push_back(sum / static_cast<float>(step * step));
      }
    }
    out.planes.push_back(std::move(small));
  }
  return out;
}

/// Encodes images as data URLs.
class Encoder {
 public:
  std::string shown(const film::Picture& picture) const {
    display::Settings settings;
    settings.exposure = exposure_;
    return address(display::develop(downsampled(picture), settings, 8));
  }
  /// For images that are already display-encoded, such as false colours.
  static std::string codes(const film::Picture& picture) { return address(compare::encoded(picture)); }
  /// Sets the exposure for bright images: if the mean of green is above 1, brings it to 0.4.
  void expose(const film::Picture& picture) {
    double sum = 0;
    for (const float v : picture.planes[1].values) sum += static_cast<double>(v);
    const double mean = sum / static_cast<double>(picture.planes[1].values.size());
    if (mean > 1) exposure_ = std::log2(0.4 / mean);
  }

 private:
  static std::string address(const film::EncodedPicture& picture) {
    const std::vector<std::uint8_t> codes(picture.values.begin(), picture.values.end());
    return "data:image/jpeg;base64," +
           base::base64(image::jpeg_bytes(picture.width, picture.height, codes.data(), image::kJpegQuality));
  }

  double exposure_ = 0;
};

}  // namespace

std::string study_json(const Study& study) { return job::json_text(study_object(study)); }

std::string study_text(const Study& s) {
  std::string out = fmt::format(
      "{}, {} x {} of {} x {} pixels, {}, {}, {:.0f} s of {:.0f} s\n", s.scene, s.width, s.height, s.scene_width,
      s.scene_height, base::counted(static_cast<std::uint64_t>(s.threads), "thread"), s.isa, s.seconds, s.budget_s);
  job::add_row(out, "reference", "{:.0f} samples per pixel, noise {:.2g} %\n", s.reference_samples,
               s.reference_noise * 100);
  out += fmt::format("{:12} {:22} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>10}\n", "axis", "choice", "samples", "seconds",
                     "error %", "bias %", "noise %", "energy %", "efficiency");
  for (const Point& p : s.points)
    out += fmt::format("{:12} {:22} {:9.1f} {:9.3f} {:9.3f} {:9.3f} {:9.3f} {:+9.3f} {:10.4g}{}\n", p.axis, p.name,
                       p.samples, p.seconds, p.error * 100, p.bias * 100, p.measured.noise * 100,
                       p.measured.energy * 100, p.efficiency, p.on_front ? " *" : "");
  out += "* Pareto front: no other choice is both faster and more accurate\n\n";
  for (const Slope& l : s.slopes)
    out += fmt::format("error of {} is proportional to samples^{:.2f}\n", l.name, l.slope);
  out += '\n';
  for (const std::string& text : s.left_out) job::add_row(out, "left out", "{}", text);
  for (const std::string& text : s.warnings) job::add_row(out, "warning", "{}", text);
  return out + fmt::format("\n{}\n  {}\n", s.recommendation.words, s.recommendation.command);
}

std::string study_html(const Study& study) {
  json data = study_object(study);
  Encoder encode;
  encode.expose(study.reference);
  data["reference"]["picture"] = encode.shown(study.reference);
  const compare::ColorView truth = compare::color_of(study.reference);
  for (std::size_t i = 0; i < study.points.size(); ++i) {
    const Point& p = study.points[i];
    data["points"][i]["picture"] = encode.shown(p.picture);
    const compare::Map map = compare::display_error_map(compare::color_of(p.picture), truth);
    data["points"][i]["heat"] = encode.codes(downsampled(compare::false_color(map, compare::kFalseColorMax)));
  }
  // The text must not contain the end tag of its script element.
  const std::string text = base::replaced(data.dump(-1, ' ', true, json::error_handler_t::replace), "</", "<\\/");
  return base::replaced(kReportPage, "{{DATA}}", text);
}

}  // namespace orrery::study
