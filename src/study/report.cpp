// SPDX-License-Identifier: Apache-2.0
// Output of a study: text, JSON and a self-contained HTML page.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include <nlohmann/json.hpp>

#include "base/temp_dir.h"
#include "base/text.h"
#include "compare/color_view.h"
#include "compare/errors.h"
#include "display/develop.h"
#include "display/settings.h"
#include "image/write.h"
#include "study/study.h"

namespace orrery::study {

extern const char* const kReportPage;  // report_page.cpp.in

namespace {

using base::append;
using nlohmann::json;

/// Maximum width of the images on the page, px; keeps a page with twenty images within a few megabytes.
constexpr int kShownWidth = 480;

json number(double v) { return std::isfinite(v) ? json(v) : json(nullptr); }

json study_object(const Study& s) {
  json points = json::array(), files = json::array(), slopes = json::array(), features = json::array();
  for (const Point& p : s.points)
    points.push_back({{"axis", p.axis},
                      {"name", p.name},
                      {"flags", p.flags},
                      {"samples", p.samples},
                      {"seconds", p.seconds},
                      {"error", number(p.error)},
                      {"bias", number(p.bias)},
                      {"noise", number(p.noise)},
                      {"energy", number(p.energy)},
                      {"efficiency", number(p.efficiency)},
                      {"memory_bytes", p.memory},
                      {"is_shortcut", p.is_shortcut},
                      {"on_front", p.on_front}});
  for (const FilePoint& f : s.files)
    files.push_back(
        {{"name", f.name}, {"flags", f.flags}, {"bytes", f.bytes}, {"write_s", f.write_s}, {"error", number(f.error)}});
  for (const Slope& l : s.slopes) slopes.push_back({{"name", l.name}, {"slope", number(l.slope)}});
  for (const auto& f : s.features)
    features.push_back({{"name", f.name}, {"required", f.required}, {"saves", f.required ? json() : number(f.saves)}});
  const Recommendation& r = s.recommendation;
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
          {"points", points},
          {"files", files},
          {"slopes", slopes},
          {"left_out", s.left_out},
          {"features", features},
          {"recommendation",
           {{"words", r.words},
            {"command", r.command},
            {"noise", number(r.noise)},
            {"bias", number(r.bias)},
            {"samples", number(r.samples)},
            {"seconds", number(r.seconds)},
            {"baseline_seconds", number(r.baseline_seconds)}}}};
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
  std::string codes(const film::Picture& picture) const { return address(compare::encoded(picture)); }
  /// Sets the exposure for bright images: if the mean of green is above 1, brings it to 0.4.
  void expose(const film::Picture& picture) {
    double sum = 0;
    for (const float v : picture.planes[1].values) sum += static_cast<double>(v);
    const double mean = sum / static_cast<double>(picture.planes[1].values.size());
    if (mean > 1) exposure_ = std::log2(0.4 / mean);
  }

 private:
  std::string address(const film::EncodedPicture& picture) const {
    const std::filesystem::path file = folder_.path() / "picture.jpg";
    image::write_encoded(file, picture, "");
    std::ifstream in(file, std::ios::binary);
    return "data:image/jpeg;base64," + base::base64(std::string(std::istreambuf_iterator<char>(in), {}));
  }

  base::TempDir folder_;
  double exposure_ = 0;
};

}  // namespace

std::string study_json(const Study& study) {
  return study_object(study).dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

std::string study_text(const Study& s) {
  std::string out;
  base::append(out, "%s, %d x %d of %d x %d pixels, %d threads, %s, %.0f s of %.0f s\n", s.scene.c_str(), s.width,
               s.height, s.scene_width, s.scene_height, s.threads, s.isa.c_str(), s.seconds, s.budget_s);
  base::append(out, "reference   %.0f samples per pixel, noise %.2g %%\n\n", s.reference_samples,
               s.reference_noise * 100);
  base::append(out, "%-12s %-22s %9s %9s %9s %9s %9s %9s %10s\n", "axis", "choice", "samples", "seconds", "error %",
               "bias %", "noise %", "energy %", "efficiency");
  for (const Point& p : s.points)
    base::append(out, "%-12s %-22s %9.1f %9.3f %9.3f %9.3f %9.3f %+9.3f %10.4g%s\n", p.axis.c_str(), p.name.c_str(),
                 p.samples, p.seconds, p.error * 100, p.bias * 100, p.noise * 100, p.energy * 100, p.efficiency,
                 p.on_front ? " *" : "");
  out += "* Pareto front: no other choice is both faster and more accurate\n\n";
  for (const Slope& l : s.slopes)
    base::append(out, "error of %s is proportional to samples^%.2f\n", l.name.c_str(), l.slope);
  base::append(out, "\n%-14s %12s %9s %9s\n", "file", "size", "write s", "error %");
  for (const FilePoint& f : s.files)
    base::append(out, "%-14s %12s %9.3f %9.4f\n", f.name.c_str(), base::bytes_text(f.bytes).c_str(), f.write_s,
                 f.error * 100);
  out += '\n';
  for (const auto& f : s.features) {
    if (f.required) {
      base::append(out, "feature     %s: required by this scene\n", f.name.c_str());
    } else {
      base::append(out, "feature     %s: not required, omitting it saves %.1f %% of the time\n", f.name.c_str(),
                   f.saves * 100);
    }
  }
  for (const std::string& text : s.left_out) base::append(out, "left out    %s\n", text.c_str());
  base::append(out, "\n%s\n  %s\n", s.recommendation.words.c_str(), s.recommendation.command.c_str());
  return out;
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
  std::string text = data.dump(-1, ' ', true, json::error_handler_t::replace);
  for (std::size_t at = 0; (at = text.find("</", at)) != std::string::npos;) text.replace(at, 2, "<\\/");
  std::string page = kReportPage;
  const std::string mark = "{{DATA}}";
  page.replace(page.find(mark), mark.size(), text);
  return page;
}

}  // namespace orrery::study
