// SPDX-License-Identifier: Apache-2.0
#include "accel/traversal.h"

#include <gtest/gtest.h>

namespace orrery::accel {
namespace {

/// Traces packets until the choice is made: a ray takes so many seconds.
Traversal chosen(double packet_s, double single_s) {
  TraversalChoice choice(10);
  for (int i = 0; !choice.is_made(); ++i) {
    const int rays = 1 + 3 * i % 16;  // packets are not equally full
    choice.add(1, rays, rays * (choice.next() == Traversal::kPacket ? packet_s : single_s));
  }
  return choice.next();
}

TEST(AccelTraversal, TheFasterOneIsChosen) {
  EXPECT_EQ(chosen(1e-7, 1.1e-7), Traversal::kPacket);
  EXPECT_EQ(chosen(1.1e-7, 1e-7), Traversal::kSingle);
}

TEST(AccelTraversal, BothAreMeasuredInTurns) {
  TraversalChoice choice(11);
  int by_packets = 0;
  for (int i = 0; i < 4; ++i) {  // queries of three packets
    EXPECT_FALSE(choice.is_made());
    by_packets += choice.next() == Traversal::kPacket;
    choice.add(3, 48, 1e-6);
  }
  EXPECT_TRUE(choice.is_made());
  EXPECT_EQ(by_packets, 2);
}

TEST(AccelTraversal, ARequestedOneIsNotMeasured) {
  for (const Traversal traversal : {Traversal::kPacket, Traversal::kSingle}) {
    const ThreadTraversals all(traversal);
    for (const TraversalChoice* choice : {&all.camera, &all.secondary, &all.shadow}) {
      EXPECT_TRUE(choice->is_made());
      EXPECT_EQ(choice->next(), traversal);
    }
  }
}

}  // namespace
}  // namespace orrery::accel
