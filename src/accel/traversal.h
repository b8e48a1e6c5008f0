// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace orrery::accel {

/// How rays traverse the BVH. Hits do not depend on it.
enum class Traversal : std::uint8_t {
  kPacket,  ///< the rays of a packet together, which pays off as long as they visit the same nodes
  kSingle,  ///< each ray separately
};

/// The traversal of one thread's rays of one kind: the faster one. The first queries alternate between the traversals
/// and are timed.
class TraversalChoice {
 public:
  /// `packets`  number of packets that are timed, at least
  explicit TraversalChoice(int packets) noexcept : packets_left_(packets) {}
  /// Chosen without measurements.
  explicit TraversalChoice(Traversal traversal) noexcept : next_(traversal) {}

  bool is_made() const noexcept { return packets_left_ <= 0; }
  /// The traversal of the next query.
  Traversal next() const noexcept { return next_; }
  /// Adds the measurement of a query whose packets were traced by next().
  void add(int packets, int rays, double seconds) noexcept {
    measured_[index(next_)].rays += rays;
    measured_[index(next_)].seconds += seconds;
    packets_left_ -= packets;
    next_ = is_made() ? faster() : next_ == Traversal::kPacket ? Traversal::kSingle : Traversal::kPacket;
  }

 private:
  struct Measured {
    double rays = 0, seconds = 0;
  };
  static int index(Traversal traversal) noexcept { return static_cast<int>(traversal); }
  Traversal faster() const noexcept {
    const Measured &packet = measured_[index(Traversal::kPacket)], &single = measured_[index(Traversal::kSingle)];
    return single.seconds * packet.rays < packet.seconds * single.rays ? Traversal::kSingle : Traversal::kPacket;
  }

  Traversal next_ = Traversal::kPacket;
  int packets_left_ = 0;
  Measured measured_[2];
};

/// The traversals of one thread's rays. Camera rays and secondary rays are measured separately, since the latter visit
/// other nodes than their neighbours; the numbers of packets are those of a few hundred pixels and of a few streams of
/// paths, and take milliseconds.
struct ThreadTraversals {
  ThreadTraversals() = default;
  /// All rays by this traversal, without measurements.
  explicit ThreadTraversals(Traversal traversal) : camera(traversal), secondary(traversal), shadow(traversal) {}

  const void* scene = nullptr;  ///< set by the Accel
  mutable TraversalChoice camera{256}, secondary{1024}, shadow{1024};
};

}  // namespace orrery::accel
