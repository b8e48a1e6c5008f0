// SPDX-License-Identifier: Apache-2.0
// The program's side of the module: forwards the room's functions to the module and loads it on the first call.
// Commands without image I/O do not load OpenImageIO and its libraries.
#include <cstdint>

#include "base/module.h"
#include "image/format.h"
#include "image/header.h"
#include "image/module/functions.h"

namespace orrery::image {
namespace {

const Functions& module() {
  static const Functions& functions = *static_cast<const Functions*>(base::load_module("image"));
  return functions;
}

}  // namespace

std::string jpeg_bytes(int width_px, int height_px, const std::uint8_t* codes, int quality) {
  return module().jpeg_bytes(width_px, height_px, codes, quality);
}

void set_threads(int count) { module().set_threads(count); }

film::Picture read(const std::filesystem::path& file, Parts parts, std::uint64_t memory_limit) {
  return module().read(file, parts, memory_limit);
}

MapHeader read_map_header(const std::filesystem::path& file, MapFormats formats) {
  return module().read_map_header(file, formats);
}

void read_map(const std::filesystem::path& file, const std::function<void(int row, float* rgb)>& take,
              MapFormats formats) {
  module().read_map(file, take, formats);
}

RewriteReport rewrite_exr(const std::filesystem::path& input, const std::filesystem::path& output,
                          const EditPlanes& edit) {
  return module().rewrite_exr(input, output, edit);
}

WriteReport write_exr(const std::filesystem::path& file, const film::Picture& picture, const Header& header,
                      const ExrOptions& options) {
  return module().write_exr(file, picture, header, options);
}

void write_deep(const std::filesystem::path& file, const film::DeepPicture& deep, const film::Picture& flat,
                const Header& header) {
  module().write_deep(file, deep, flat, header);
}

WriteReport write_hdr(const std::filesystem::path& file, const film::Picture& picture) {
  return module().write_hdr(file, picture);
}

void write_encoded(const std::filesystem::path& file, const film::EncodedPicture& picture, const std::string& software,
                   const std::string& stamp) {
  module().write_encoded(file, picture, software, stamp);
}

std::string png_bytes(const film::EncodedPicture& picture, int compression) {
  return module().png_bytes(picture, compression);
}

void write_sums(const std::filesystem::path& file, const film::Picture& preview, const Header& header,
                const Provenance& provenance, const film::Sums& sums) {
  module().write_sums(file, preview, header, provenance, sums);
}

Provenance read_provenance(const std::filesystem::path& file) { return module().read_provenance(file); }

SumsFile read_sums(const std::filesystem::path& file, int width_px, int height_px,
                   const std::function<void(const Provenance&)>& check) {
  return module().read_sums(file, width_px, height_px, check);
}

std::string verified_stamp(const std::filesystem::path& file) { return module().verified_stamp(file); }

std::filesystem::path font_file(const std::string& font) { return module().font_file(font); }

void draw_text(const TextLine& line, const std::filesystem::path& font, int width, int height,
               std::vector<float>& coverage) {
  module().draw_text(line, font, width, height, coverage);
}

std::string font_family(const std::filesystem::path& font) { return module().font_family(font); }

std::vector<double> text_widths(const std::vector<std::string>& lines, double size_px,
                                const std::filesystem::path& font) {
  return module().text_widths(lines, size_px, font);
}

std::string missing_glyphs(const std::string& text, const std::filesystem::path& font) {
  return module().missing_glyphs(text, font);
}

}  // namespace orrery::image
