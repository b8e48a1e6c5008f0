// SPDX-License-Identifier: Apache-2.0
#include "image/sums_file.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <new>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "base/error.h"
#include "base/input_file.h"
#include "film/sums.h"
#include "image/exr_spec.h"
#include "image/header.h"
#include "image/library.h"
#include "image/whole_file.h"
#include "math/pixels.h"

namespace orrery::image {
namespace {

using OIIO::ImageInput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

constexpr const char* kSumsName = "orrery.sums";

/// Maximum number of words in a row of the part with the sums.
constexpr int kMaxWordsInRow = 4096;

[[noreturn]] void damaged(const std::filesystem::path& file, const std::string& why) {
  throw base::Error(base::ErrorKind::kBadData,
                    fmt::format("{} is not a usable checkpoint or shard: {}", file.string(), why));
}

std::unique_ptr<ImageInput> open(const std::filesystem::path& file) {
  prepare_library();
  auto in = ImageInput::create("openexr");
  if (!in) throw base::Error(base::ErrorKind::kInternal, "this OpenImageIO cannot read EXR" + OIIO::geterror());
  ImageSpec spec;
  if (!in->open(file.string(), spec)) damaged(file, in->geterror());
  return in;
}

Provenance provenance_of(const ImageInput& in) {
  Provenance out;
  const std::string prefix = kSumsPrefix;
  for (const OIIO::ParamValue& value : in.spec().extra_attribs) {
    const std::string name = value.name().string();
    if (name.starts_with(prefix)) out[name.substr(prefix.size())] = value.get_string();
  }
  return out;
}

}  // namespace

void write_sums(const std::filesystem::path& file, const film::Picture& preview, const Header& header,
                const Provenance& provenance, const film::Sums& sums) {
  Header own = header;
  for (const auto& [name, value] : provenance) own.attributes.push_back({kSumsPrefix + name, value});
  std::vector<std::uint32_t> words = film::to_words(sums);
  const auto row = static_cast<std::size_t>(std::min(preview.width, kMaxWordsInRow));
  words.resize((words.size() + row - 1) / row * row);
  ImageSpec stored(static_cast<int>(row), static_cast<int>(words.size() / row), 1, TypeDesc::UINT32);
  stored.channelnames = {"words"};
  stored.attribute("compression", "rle");  // removes rows of zeros; the other rows are incompressible noise
  stored.attribute("oiio:subimagename", kSumsName);
  stored.full_width = preview.frame_width;
  stored.full_height = preview.frame_height;
  if (preview.pixel_aspect != 1) stored.attribute("PixelAspectRatio", static_cast<float>(preview.pixel_aspect));

  std::vector<const film::Plane*> planes;
  ImageSpec shown(preview.width, preview.height, 4, TypeDesc::HALF);
  add_windows(shown, preview);
  add_header(shown, own);
  shown.channelnames.clear();
  for (const char* name : {"R", "G", "B", "A"}) {
    planes.push_back(preview.find(name));
    shown.channelnames.push_back(name);
  }
  shown.alpha_channel = 3;
  shown.attribute("compression", "zips");
  shown.attribute("oiio:subimagename", "rgba");
  WriteReport ignored;  // the final image gets its own report
  const std::vector<float> pixels = interleaved(preview, planes, {4, kHalfRange}, ignored);
  WholePart shown_part{shown, pixels.data()}, sums_part{stored, words.data()};
  sums_part.type = TypeDesc::UINT32;
  write_whole(file, "openexr", TypeDesc::FLOAT, {shown_part, sums_part}, true);
}

Provenance read_provenance(const std::filesystem::path& file) {
  base::require_readable(file);
  Provenance out = provenance_of(*open(file));
  if (out.empty())
    throw base::Error(
        base::ErrorKind::kBadData,
        file.string() + " is not a checkpoint or shard; --resume, --sample-range A:B and --shard write them");
  return out;
}

SumsFile read_sums(const std::filesystem::path& file, int width_px, int height_px,
                   const std::function<void(const Provenance&)>& check) {
  require_digest(file);
  const auto in = open(file);
  Provenance provenance = provenance_of(*in);
  if (check) check(provenance);
  if (!in->seek_subimage(1, 0)) damaged(file, "it has no sums");
  const ImageSpec spec = in->spec();
  if (spec.nchannels != 1 || spec.format != TypeDesc::UINT32 || spec.width < 1 || spec.height < 1 ||
      spec.width > kMaxWordsInRow)
    damaged(file, "its sums have an unexpected type or size");
  try {
    std::vector<std::uint32_t> words(math::pixel_count(spec.width, spec.height));
    if (!in->read_scanlines(1, 0, spec.y, spec.y + spec.height, 0, 0, 1, TypeDesc::UINT32, words.data()))
      damaged(file, in->geterror());
    return {std::move(provenance), film::from_words(words, width_px, height_px)};
  } catch (const base::Error& error) {
    damaged(file, error.what());
  } catch (const std::bad_alloc&) {
    throw base::Error(base::ErrorKind::kNoMemory,
                      fmt::format("cannot read {}: there is not enough memory for its samples", file.string()));
  } catch (const std::length_error&) {
    damaged(file, "its samples would not fit into any memory");
  }
}

}  // namespace orrery::image
