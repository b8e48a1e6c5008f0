// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/draw_text.h"
#include "image/library.h"
#include "image/read.h"
#include "image/rewrite.h"
#include "image/sums_file.h"
#include "image/write.h"

namespace orrery::image {

/// The public functions of this room that need OpenImageIO. They are in a module that the program loads on the first
/// call.
struct Functions {
  decltype(&image::jpeg_bytes) jpeg_bytes;
  decltype(&image::set_threads) set_threads;
  decltype(&image::read) read;
  decltype(&image::read_map_header) read_map_header;
  decltype(&image::read_map) read_map;
  decltype(&image::rewrite_exr) rewrite_exr;
  decltype(&image::write_exr) write_exr;
  decltype(&image::write_deep) write_deep;
  decltype(&image::write_hdr) write_hdr;
  decltype(&image::write_encoded) write_encoded;
  decltype(&image::png_bytes) png_bytes;
  decltype(&image::write_sums) write_sums;
  decltype(&image::read_provenance) read_provenance;
  decltype(&image::read_sums) read_sums;
  decltype(&image::verified_stamp) verified_stamp;
  decltype(&image::font_file) font_file;
  decltype(&image::draw_text) draw_text;
  decltype(&image::font_family) font_family;
  decltype(&image::text_widths) text_widths;
  decltype(&image::missing_glyphs) missing_glyphs;
};

}  // namespace orrery::image
