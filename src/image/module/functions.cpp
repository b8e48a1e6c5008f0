// SPDX-License-Identifier: Apache-2.0
// The module's side: compiled into the module together with the room.
#include "image/module/functions.h"

namespace orrery::image {

extern "C" const void* orrery_image_functions() {
  static constexpr Functions functions{
      jpeg_bytes,     set_threads, read,          read_map_header, read_map,    rewrite_exr,     write_exr,
      write_deep,     write_hdr,   write_encoded, png_bytes,       write_sums,  read_provenance, read_sums,
      verified_stamp, font_file,   draw_text,     font_family,     text_widths, missing_glyphs,
  };
  return &functions;
}

}  // namespace orrery::image
