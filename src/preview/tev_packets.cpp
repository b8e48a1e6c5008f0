// SPDX-License-Identifier: Apache-2.0
#include "preview/tev_packets.h"

#include <bit>
#include <cstdint>

namespace orrery::preview {
namespace {

constexpr char kCreateImage = 4, kUpdateImageV3 = 6;
constexpr const char* kChannels[] = {"R", "G", "B"};
constexpr std::int32_t kChannelCount = 3;

/// A packet: its length in bytes, including these four, its type and its payload; numbers are little-endian.
class Packet {
 public:
  explicit Packet(char type) : bytes_(4, '\0') { bytes_ += type; }

  void add(bool flag) { bytes_ += flag ? '\1' : '\0'; }
  void add(const std::string& text) { bytes_.append(text.c_str(), text.size() + 1); }
  void add(std::int32_t number) { add_bytes(static_cast<std::uint32_t>(number), 4); }
  void add(std::int64_t number) { add_bytes(static_cast<std::uint64_t>(number), 8); }
  void add(const std::vector<float>& values) {
    if constexpr (std::endian::native == std::endian::little) {
      bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
    } else {
      for (const float v : values) add_bytes(std::bit_cast<std::uint32_t>(v), 4);
    }
  }
  void add_channels() {
    for (const char* const name : kChannels) add(std::string(name));
  }
  void reserve(std::size_t size) { bytes_.reserve(size); }

  std::string finished() {
    for (std::size_t i = 0; i < 4; ++i) bytes_[i] = static_cast<char>(bytes_.size() >> (8 * i) & 0xff);
    return std::move(bytes_);
  }

 private:
  void add_bytes(std::uint64_t number, int count) {
    for (int i = 0; i < count; ++i) bytes_ += static_cast<char>(number >> (8 * i) & 0xff);
  }

  std::string bytes_;
};

}  // namespace

std::string tev_create(const std::string& name, int width, int height, bool grabs_focus) {
  Packet packet(kCreateImage);
  packet.add(grabs_focus);
  packet.add(name);
  packet.add(static_cast<std::int32_t>(width));
  packet.add(static_cast<std::int32_t>(height));
  packet.add(kChannelCount);
  packet.add_channels();
  return packet.finished();
}

std::string tev_update(const std::string& name, int x, int y, int width, int height, const std::vector<float>& rgb) {
  constexpr std::size_t kHeader = 128;
  Packet packet(kUpdateImageV3);
  packet.reserve(kHeader + name.size() + rgb.size() * sizeof(float));
  packet.add(false);  // does not grab the focus
  packet.add(name);
  packet.add(kChannelCount);
  packet.add_channels();
  for (const int number : {x, y, width, height}) packet.add(static_cast<std::int32_t>(number));
  for (std::int64_t offset = 0; offset < kChannelCount; ++offset) packet.add(offset);
  for (int channel = 0; channel < kChannelCount; ++channel) packet.add(std::int64_t{kChannelCount});  // stride
  packet.add(rgb);
  return packet.finished();
}

}  // namespace orrery::preview
