// SPDX-License-Identifier: Apache-2.0
#include "preview/tev_packets.h"

#include <gtest/gtest.h>

#include "support/tev_server.h"

namespace orrery::preview {
namespace {

TEST(PreviewTevPackets, CreateHasTheBytesOfTheProtocol) {
  const std::string packet = tev_create("ab", 3, 258, true);
  const std::string want(
      "\x1b\0\0\0\x04\x01"
      "ab\0"
      "\x03\0\0\0"
      "\x02\x01\0\0"
      "\x03\0\0\0"
      "R\0G\0B\0",
      27);
  EXPECT_EQ(packet, want);
}

TEST(PreviewTevPackets, UpdatesFillTheImage) {
  test::TevReader reader;
  const auto add = [&](const std::string& packet) {
    for (const char c : packet) reader.add(&c, 1);  // arrives in pieces
  };
  add(tev_create("image", 4, 3, false));
  add(tev_update("image", 1, 1, 2, 2, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, -0.5f}));
  const test::TevImage& image = reader.images.at("image");
  EXPECT_EQ(image.channels, (std::vector<std::string>{"R", "G", "B"}));
  std::vector<float> want(36, 0.0f);
  for (std::size_t i = 0; i < 6; ++i) want[15 + i] = static_cast<float>(i + 1);
  for (std::size_t i = 0; i < 6; ++i) want[27 + i] = static_cast<float>(i + 7);
  want[32] = -0.5f;
  EXPECT_EQ(image.values, want);
}

}  // namespace
}  // namespace orrery::preview
