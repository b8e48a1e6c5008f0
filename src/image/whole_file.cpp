// SPDX-License-Identifier: Apache-2.0
#include "image/whole_file.h"

#include <cstring>
#include <vector>

#include "base/atomic_file.h"
#include "base/error.h"
#include "image/checked_file.h"
#include "image/library.h"

namespace orrery::image {
namespace {

[[noreturn]] void io_failed(const std::filesystem::path& file, const std::string& reason) {
  throw base::Error(base::ErrorKind::kIo, "writing " + file.string() + " failed: " + reason);
}

/// Hands all pixels to OpenImageIO.
///
/// Result     what it complained of, or nothing. Asked for always: what nobody asks for it prints.
std::string encode(OIIO::ImageOutput& out, const std::string& name, const OIIO::ImageSpec& spec, OIIO::TypeDesc type,
                   const void* pixels) {
  const auto complaint = [&](const char* step) {
    const std::string text = out.geterror();
    return text.empty() ? std::string(step) + " failed" : text;
  };
  if (!out.open(name, spec)) return complaint("opening");
  const bool written = out.write_image(type, pixels);
  const std::string write_complaint = written ? "" : complaint("encoding");
  if (!out.close() && written) return complaint("closing");
  out.geterror();
  return write_complaint;
}

/// Opens what was written and decodes its end.
///
/// Result     what is wrong with it, or nothing
std::string read_back(const std::string& name, const std::string& format, const OIIO::ImageSpec& written) {
  const auto in = OIIO::ImageInput::create(format);
  if (!in) return OIIO::geterror();
  OIIO::ImageSpec spec;
  if (!in->open(name, spec)) return "it cannot be read back: " + in->geterror();
  std::string wrong;
  if (spec.width != written.width || spec.height != written.height || spec.nchannels != written.nchannels) {
    wrong = "it reads back as another picture";
  } else {
    std::vector<float> row(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.nchannels));
    if (!in->read_scanline(spec.height - 1 + spec.y, 0, OIIO::TypeDesc::FLOAT, row.data()))
      wrong = "its end cannot be read back";
  }
  const std::string reason = in->geterror();
  return wrong.empty() || reason.empty() ? wrong : wrong + ": " + reason;
}

}  // namespace

void write_whole(const std::filesystem::path& file, const std::string& format, const OIIO::ImageSpec& spec,
                 OIIO::TypeDesc type, const void* pixels) {
  prepare_library();
  base::AtomicFile target(file);
  const std::string name = target.temporary().string();
  // Declared before its user: an encoder that failed may still write while it is destroyed.
  CheckedFile bytes(target.temporary());
  const auto out = OIIO::ImageOutput::create(format);
  if (!out || !out->supports("ioproxy"))
    throw base::Error(base::ErrorKind::kInternal,
                      "this OpenImageIO cannot write " + format + " files " + OIIO::geterror());
  out->set_ioproxy(&bytes);
  const std::string complaint = encode(*out, name, spec, type, pixels);
  if (const int error = bytes.finish(); error != 0) io_failed(file, std::strerror(error));
  if (!complaint.empty()) io_failed(file, complaint);
  if (const std::string wrong = read_back(name, format, spec); !wrong.empty()) io_failed(file, wrong);
  target.commit();
}

void leave_out_date(OIIO::ImageSpec& spec) {
  // It adds the date where there is no attribute of this name, and drops one that is no text.
  const std::uint8_t no_text = 0;
  spec.attribute("DateTime", OIIO::TypeDesc::UINT8, &no_text);
}

}  // namespace orrery::image
