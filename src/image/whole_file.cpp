// SPDX-License-Identifier: Apache-2.0
#include "image/whole_file.h"

#include <OpenImageIO/deepdata.h>

#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

#include <fmt/core.h>

#include "base/atomic_file.h"
#include "base/error.h"
#include "image/checked_file.h"
#include "image/digest.h"
#include "image/encode_jpeg.h"
#include "image/library.h"

namespace orrery::image {
namespace {

[[noreturn]] void io_failed(const std::filesystem::path& file, const std::string& reason) {
  throw base::Error(base::ErrorKind::kIo, fmt::format("writing {} failed: {}", file.string(), reason));
}

/// Encodes all parts with OpenImageIO.
///
/// Result     OpenImageIO's error message, or empty. Errors are always fetched, since OpenImageIO prints pending ones.
std::string encode(OIIO::ImageOutput& out, const std::string& name, OIIO::TypeDesc type,
                   const std::vector<WholePart>& parts) {
  const auto error_message = [&](const char* step) {
    const std::string text = out.geterror();
    return text.empty() ? std::string(step) + " failed" : text;
  };
  std::vector<OIIO::ImageSpec> specs;
  for (const WholePart& part : parts) specs.push_back(part.spec);
  const bool opened =
      specs.size() == 1 ? out.open(name, specs[0]) : out.open(name, static_cast<int>(specs.size()), specs.data());
  if (!opened) return error_message("opening");
  std::string first_error;
  for (std::size_t i = 0; i < parts.size() && first_error.empty(); ++i) {
    if (i > 0 && !out.open(name, specs[i], OIIO::ImageOutput::AppendSubimage)) return error_message("opening a part");
    const bool written = parts[i].deep != nullptr ? out.write_deep_image(*parts[i].deep)
                                                  : out.write_image(parts[i].type.value_or(type), parts[i].pixels);
    if (!written) first_error = error_message("encoding");
  }
  if (!out.close() && first_error.empty()) return error_message("closing");
  out.geterror();
  return first_error;
}

/// Decodes the last row of a part; false if that fails.
bool read_end(OIIO::ImageInput& in, int part, const OIIO::ImageSpec& spec) {
  const int end = spec.y + spec.height;
  if (spec.deep) {
    OIIO::DeepData row;
    return in.read_native_deep_scanlines(part, 0, end - 1, end, 0, 0, spec.nchannels, row);
  }
  const int begin = spec.tile_width == 0 ? end - 1 : end - 1 - (spec.height - 1) % spec.tile_height;
  std::vector<float> row(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.nchannels) *
                         static_cast<std::size_t>(end - begin));
  if (spec.tile_width != 0)
    return in.read_tiles(part, 0, spec.x, spec.x + spec.width, begin, end, 0, 1, 0, spec.nchannels,
                         OIIO::TypeDesc::FLOAT, row.data());
  return in.read_scanlines(part, 0, end - 1, end, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, row.data());
}

/// Reopens the file and decodes the last row of every part.
///
/// Result     what is wrong, or empty
std::string read_back(const std::string& name, const std::string& format, const std::vector<WholePart>& parts) {
  const auto in = OIIO::ImageInput::create(format);
  if (!in) return OIIO::geterror();
  OIIO::ImageSpec spec;
  if (!in->open(name, spec)) return "it cannot be read back: " + in->geterror();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const OIIO::ImageSpec& written = parts[i].spec;
    const int part = static_cast<int>(i);
    std::string wrong;
    if (!in->seek_subimage(part, 0)) {
      wrong = "a part cannot be read back";
    } else if (spec = in->spec();
               spec.width != written.width || spec.height != written.height || spec.nchannels != written.nchannels) {
      wrong = "it reads back as a different image";
    } else if (!read_end(*in, part, spec)) {
      wrong = "its last row cannot be read back";
    }
    const std::string reason = in->geterror();
    if (!wrong.empty()) return reason.empty() ? wrong : fmt::format("{}: {}", wrong, reason);
  }
  return {};
}

}  // namespace

void write_whole(const std::filesystem::path& file, const std::string& format, OIIO::TypeDesc type,
                 const std::vector<WholePart>& parts, bool with_digest) {
  prepare_library();
  base::AtomicFile target(file);
  const std::string name = target.temporary().string();
  // Declared before its user: a failed encoder may still write in its destructor.
  CheckedFile bytes(target.temporary());
  std::string message;
  std::unique_ptr<OIIO::ImageOutput> out;
  if (format == "jpeg") {
    message = encode_jpeg(parts.front().spec, static_cast<const std::uint8_t*>(parts.front().pixels), bytes);
  } else {
    out = OIIO::ImageOutput::create(format);
    if (!out || !out->supports("ioproxy"))
      throw base::Error(base::ErrorKind::kInternal,
                        fmt::format("this OpenImageIO cannot write {} files {}", format, OIIO::geterror()));
    out->set_ioproxy(&bytes);
    message = encode(*out, name, type, parts);
  }
  if (const int error = bytes.finish(); error != 0) io_failed(file, std::strerror(error));
  if (!message.empty()) io_failed(file, message);
  if (const std::string wrong = read_back(name, format, parts); !wrong.empty()) io_failed(file, wrong);
  if (with_digest) append_digest(target.temporary(), file);
  target.commit();
}

void leave_out_date(OIIO::ImageSpec& spec) {
  // OpenImageIO adds the date if there is no such attribute, and drops an attribute that is not a string.
  const std::uint8_t no_text = 0;
  spec.attribute("DateTime", OIIO::TypeDesc::UINT8, &no_text);
}

}  // namespace orrery::image
