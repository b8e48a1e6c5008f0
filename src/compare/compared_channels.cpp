// SPDX-License-Identifier: Apache-2.0
#include "compare/compare_files.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include <fmt/core.h>

#include "base/error.h"
#include "base/text.h"
#include "film/layers.h"

namespace orrery::compare {
namespace {

/// The layer of a channel, or the channel's name if it has none. Cryptomatte layers lose their two digits.
std::string layer_name(const std::string& channel) {
  std::string name = film::Plane{channel, {}}.layer();
  if (name.empty()) return channel;
  const std::size_t n = name.size();
  if (n > 2 && name.starts_with("Crypto") && std::isdigit(static_cast<unsigned char>(name[n - 1])) != 0 &&
      std::isdigit(static_cast<unsigned char>(name[n - 2])) != 0)
    name.resize(n - 2);
  return name;
}

/// The planes of a Cryptomatte rank.
struct Rank {
  const std::vector<float>*id, *coverage;
};
/// All ranks of a Cryptomatte; empty if the image does not contain it.
std::vector<Rank> ranks_of(const film::Picture& picture, const std::string& layer) {
  std::vector<Rank> ranks;
  for (int pair = 0; pair < 100; ++pair) {
    const std::string name = layer + static_cast<char>('0' + pair / 10) + static_cast<char>('0' + pair % 10);
    for (const auto& [id, coverage] : {std::pair{".R", ".G"}, std::pair{".B", ".A"}}) {
      const film::Plane *ids = picture.find(name + id), *coverages = picture.find(name + coverage);
      if (ids == nullptr || coverages == nullptr) return ranks;
      ranks.push_back({&ids->values, &coverages->values});
    }
  }
  return ranks;
}

/// The fraction of a pixel that belongs to different objects: half the sum of absolute differences in coverage.
float differing_share(const std::vector<Rank>& a, const std::vector<Rank>& b, std::size_t pixel) {
  std::vector<std::pair<float, double>> things = {{0.0f, 0.0}};  // id 0: the background
  const auto add = [&](const std::vector<Rank>& ranks, double sign) {
    double background = 1;
    for (const Rank& rank : ranks) {
      const float id = (*rank.id)[pixel];
      const auto coverage = static_cast<double>((*rank.coverage)[pixel]);
      if (coverage == 0) continue;
      background -= coverage;
      auto thing = std::find_if(things.begin(), things.end(), [id](const auto& t) { return t.first == id; });
      if (thing == things.end()) thing = things.insert(thing, {id, 0.0});
      thing->second += sign * coverage;
    }
    things[0].second += sign * background;
  };
  add(a, 1);
  add(b, -1);
  double sum = 0;
  for (const auto& thing : things) sum += std::abs(thing.second);
  return static_cast<float>(sum / 2);
}

void exclude_misses(ComparedChannels& c) {
  const auto has_no_hit = [](const ColorView& view, std::size_t i) {
    return view.channel[0][i] >= film::kNothingHit || view.channel[1][i] >= film::kNothingHit ||
           view.channel[2][i] >= film::kNothingHit;
  };
  for (std::size_t i = 0; i < c.picture.pixels(); ++i) {
    const bool a = has_no_hit(c.picture, i), b = has_no_hit(c.reference, i);
    if (!a && !b) continue;
    c.excluded.resize(c.picture.pixels());
    c.excluded[i] = true;
    ++c.no_hit;
    c.no_hit_in_one += a != b;
  }
}

}  // namespace

bool is_of_layer(const film::Plane& channel, const std::string& layer) {
  return layer.empty() || channel.name == layer || channel.layer() == layer || layer_name(channel.name) == layer;
}

ComparedChannels compared_channels(const film::Picture& picture, const film::Picture& reference,
                                   const std::string& layer) {
  ComparedChannels out;
  out.picture = out.reference = {picture.width, picture.height, {}};
  const auto add = [&](const film::Plane& plane) {
    const film::Plane* const other = reference.find(plane.name);
    if (out.names.size() == 3 || other == nullptr) return;
    out.picture.channel[out.names.size()] = plane.values.data();
    out.reference.channel[out.names.size()] = other->values.data();
    out.names.push_back(plane.name);
  };
  if (layer.empty()) {
    for (const char* name : {"R", "G", "B"})
      if (const film::Plane* plane = picture.find(name)) add(*plane);
    if (out.names.empty())
      for (const film::Plane& plane : picture.planes)
        if (plane.layer().empty()) add(plane);
  } else {
    for (const film::Plane& plane : picture.planes)
      if (plane.layer() == layer || plane.name == layer) add(plane);
    const std::vector<Rank> a = ranks_of(picture, layer), b = ranks_of(reference, layer);
    if (out.names.empty() && !a.empty() && !b.empty()) {
      out.is_matte = true;
      out.names = {layer};
      out.zeros.resize(out.picture.pixels());
      for (std::size_t i = 0; i < out.zeros.size(); ++i) out.shares.push_back(differing_share(a, b, i));
      out.picture.channel[0] = out.shares.data();
      out.reference.channel[0] = out.zeros.data();
    }
  }
  if (out.names.empty() && layer.empty())
    throw base::Error(base::ErrorKind::kBadData, "the images have no channel in common");
  if (out.names.empty()) {
    std::vector<std::string> channels;
    for (const film::Plane& plane : picture.planes) channels.push_back(plane.name);
    throw base::Error(base::ErrorKind::kBadData, fmt::format("layer {} is not in both images; the first has {}", layer,
                                                             base::joined(layers_of(channels))));
  }
  for (std::size_t c = out.names.size(); c < 3; ++c) {
    out.picture.channel[c] = out.picture.channel[c - 1];
    out.reference.channel[c] = out.reference.channel[c - 1];
  }
  if (!layer.empty()) exclude_misses(out);
  return out;
}

std::vector<std::string> layers_of(const std::vector<std::string>& channels) {
  std::vector<std::string> out;
  for (const std::string& channel : channels)
    if (const std::string name = layer_name(channel); !base::contains(out, name)) out.push_back(name);
  return out;
}

}  // namespace orrery::compare
