// SPDX-License-Identifier: Apache-2.0
#include "image/read.h"

#include <OpenImageIO/imageio.h>

#include <fstream>

#include "base/error.h"

namespace orrery::image {

film::Picture read(const std::filesystem::path& file) {
  if (!std::ifstream(file))
    throw base::Error(base::ErrorKind::kMissingInput, "cannot open " + file.string());
  const auto fail = [&](const std::string& reason) {
    throw base::Error(base::ErrorKind::kBadData, file.string() + " cannot be read as a picture: " + reason);
  };
  const auto in = OIIO::ImageInput::open(file.string());
  if (!in) fail(OIIO::geterror());
  const OIIO::ImageSpec spec = in->spec();
  const std::size_t pixels = static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height);
  const auto channels = static_cast<std::size_t>(spec.nchannels);
  std::vector<float> values(pixels * channels);
  if (!in->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, values.data())) fail(in->geterror());
  film::Picture picture;
  picture.width = spec.width;
  picture.height = spec.height;
  for (std::size_t c = 0; c < channels; ++c) {
    film::Plane plane{spec.channelnames[c], std::vector<float>(pixels)};
    for (std::size_t i = 0; i < pixels; ++i) plane.values[i] = values[i * channels + c];
    picture.planes.push_back(std::move(plane));
  }
  return picture;
}

}  // namespace orrery::image
