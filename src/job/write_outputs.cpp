// SPDX-License-Identifier: Apache-2.0
#include "job/write_outputs.h"

#include <utility>

#include "annotation/annotate.h"
#include "base/atomic_file.h"
#include "base/error.h"
#include "image/format.h"
#include "image/header.h"

namespace orrery::job {

film::EncodedPicture develop_annotated(const film::Picture& picture, const annotation::Drawing& drawing,
                                       const display::Settings& settings, int bits, display::Alpha alpha) {
  film::EncodedPicture out = display::develop(picture, settings, bits, alpha);
  if (!drawing.is_empty()) annotation::blend(annotation::draw(drawing, annotation::shown_by(settings)), out);
  return out;
}

void DisplayWriter::write(const std::filesystem::path& file, const std::string& software, const std::string& stamp,
                          double dpi) {
  const bool keeps_alpha = picture_.is_transparent && image::holds_alpha(image::format_of(file));
  const display::Alpha alpha = keeps_alpha ? display::Alpha::kStraight : display::Alpha::kOverBlack;
  if (image::format_of(file) == image::Format::kSvg) return write_svg(file, alpha);
  std::optional<film::EncodedPicture>& developed = keeps_alpha ? with_alpha_ : over_black_;
  if (!developed) developed = develop_annotated(picture_, drawing_, settings_, bits_, alpha);
  developed->dpi = dpi;
  image::write_encoded(file, *developed, software, stamp);
}

/// Outlines are pixels, like the image; text, bars and boxes are elements that an editor can change.
void DisplayWriter::write_svg(const std::filesystem::path& file, display::Alpha alpha) const {
  annotation::Drawing drawing = drawing_;
  drawing.width = picture_.width;
  drawing.height = picture_.height;
  annotation::Drawing outlines;
  outlines.width = drawing.width;
  outlines.height = drawing.height;
  outlines.ink = drawing.ink;
  outlines.outline_px = drawing.outline_px;
  outlines.lines = std::move(drawing.lines);
  const std::string png =
      image::png_bytes(develop_annotated(picture_, outlines, settings_, 8, alpha), image::kCompressed);
  base::write_text_file(file, annotation::svg(drawing, annotation::shown_by(settings_), png));
}

image::WriteReport write_outputs(const Outputs& outputs, const display::Settings& display,
                                 const display::Choice& choice, const film::Picture& picture,
                                 const image::Header& header, const annotation::Drawing& drawing) {
  DisplayWriter developed(picture, display, outputs.bits != 0 ? outputs.bits : choice.default_bits(), drawing);
  image::WriteReport report;
  const auto add = [&](const image::WriteReport& one) {
    report.clamped += one.clamped;
    report.not_finite += one.not_finite;
  };
  std::vector<base::Error> errors;
  for (const auto& [output, format] : outputs.images) {
    try {
      if (image::is_display_format(format))
        developed.write(output, header.software, header.stamp, header.dpi);
      else
        add(format == image::Format::kHdr ? image::write_hdr(output, picture)
                                          : image::write_exr(output, picture, header, outputs.exr));
    } catch (const base::Error& error) {
      errors.push_back(error);
    }
  }
  if (errors.empty()) return report;
  std::string text = errors.front().what();
  for (std::size_t i = 1; i < errors.size(); ++i) text += std::string("; ") + errors[i].what();
  throw base::Error(errors.front().kind(), text);
}

}  // namespace orrery::job
