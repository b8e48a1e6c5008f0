// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "film/picture.h"
#include "image/draw_text.h"
#include "math/vec3.h"

/// What is drawn over an image: text, bars and lines.
namespace orrery::annotation {

using math::Vec3d;

/// A rectangle whose sides may be anywhere between pixels.
struct Box {
  double left, top, right, bottom;  ///< px from the top left
  Vec3d color;                      ///< linear Rec.709
};

/// A rectangle with a gradient.
struct Bar {
  double left, top, right, bottom;  ///< px from the top left
  std::vector<Vec3d> colors;        ///< from the bottom to the top, at equal steps; linear Rec.709
};

/// A drawing over an image.
struct Drawing {
  int width = 0, height = 0;            ///< px
  Vec3d ink{0, 0, 0};                   ///< of lines and text, linear Rec.709
  double outline_px = 0;                ///< width of the outlines; 0: none
  double outline_depth = 0;             ///< as scene::Annotation has it
  bool outline_objects = false;         ///< as scene::Annotation has it
  std::vector<float> lines;             ///< coverage by the outlines, one per pixel; empty: not known yet
  std::vector<Box> boxes;               ///< over the lines, in this order
  std::vector<Bar> bars;                ///< over the boxes
  std::vector<image::TextLine> texts;   ///< over the bars
  std::vector<image::TextLine> labels;  ///< over all, with a contour in the opposite of the ink
  std::filesystem::path font;           ///< file

  bool is_empty() const { return outline_px == 0 && boxes.empty() && bars.empty() && texts.empty() && labels.empty(); }
};

/// Adds the boxes, bars and texts of a part to a drawing, with the part's origin at a point.
void place(const Drawing& part, double x, double y, Drawing& into);

/// Rectangles that contain the boxes, bars and texts of a drawing, one each; not its lines and labels.
///
/// Errors     those of image::text_widths()
std::vector<Box> covered_by(const Drawing& drawing);

/// A drawing as pixels, premultiplied by alpha.
struct Overlay {
  int width = 0, height = 0;  ///< px
  std::vector<float> rgba;    ///< row by row from the top
};

/// Returns the pixels of a drawing.
///
/// `shown`    converts colours from linear Rec.709 to those of the overlay
/// Errors     those of image::draw_text()
Overlay draw(const Drawing& drawing, const std::function<Vec3d(const Vec3d&)>& shown);

/// Returns a hash of an image's stamp and of the drawing over it; the stamp, if the drawing is empty.
std::string stamped(const std::string& stamp, const Drawing& drawing);

/// Puts an overlay of display values, 0..1, over an image of the same size. Keeps alpha unassociated.
void blend(const Overlay& overlay, film::EncodedPicture& picture);

/// Puts a part of one of its rows, from pixel `x` of row `y` on, over 8-bit RGB.
void blend(const Overlay& overlay, int x, int y, std::span<std::uint8_t> rgb);

/// Adds a scene-linear overlay to an image as the layer `annotation`.
void add_layer(const Overlay& overlay, film::Picture& picture);

/// Returns the drawing without its lines as SVG.
///
/// `shown`    converts colours to display values, 0..1
/// `png`      the image below, with the lines; empty: a transparent background
/// Errors     those of image::font_family()
std::string svg(const Drawing& drawing, const std::function<Vec3d(const Vec3d&)>& shown, std::string_view png = {});

}  // namespace orrery::annotation
