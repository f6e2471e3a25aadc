#ifndef MESHGROW_NODE_NUMBERS_H
#define MESHGROW_NODE_NUMBERS_H

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "geometry.h"

namespace meshgrow {

/// Numbers nodes by their coordinates, from 0 on: the same number where all three are equal to the
/// bit (0 and −0 are equal, too).
class NodeNumbers {
 public:
  std::uint32_t of(const Vec3& point) {
    const Vec3 p = point + Vec3::Zero();  // −0 becomes 0
    if (2 * (points_.size() + 1) > slots_.size()) {
      grow();
    }
    const std::size_t slot = find_slot(p);
    if (slots_[slot] == empty) {
      slots_[slot] = static_cast<std::uint32_t>(points_.size());
      points_.push_back(p);
    }
    return slots_[slot];
  }

  std::size_t count() const { return points_.size(); }

 private:
  static constexpr std::uint32_t empty = 0xFFFFFFFFu;

  static std::uint64_t hash(const Vec3& p) {
    std::uint64_t hash = 0;
    for (int axis = 0; axis < 3; ++axis) {
      std::uint64_t bits = 0;
      std::memcpy(&bits, &p[axis], sizeof bits);
      hash = (hash ^ bits) * 0x9E3779B97F4A7C15u;
      hash ^= hash >> 29;
    }
    return hash;
  }

  /// Of the point itself, or the one where it belongs. (Open addressing: half as long as a map.)
  std::size_t find_slot(const Vec3& p) const {
    std::size_t slot = hash(p) & (slots_.size() - 1);
    while (slots_[slot] != empty &&
           // To the bit, also for what is not a number. NOLINTNEXTLINE(*-memory-comparison)
           std::memcmp(points_[slots_[slot]].data(), p.data(), 3 * sizeof(double)) != 0) {
      slot = (slot + 1) & (slots_.size() - 1);
    }
    return slot;
  }

  void grow() {
    slots_.assign(std::max<std::size_t>(16, 2 * slots_.size()), empty);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      slots_[find_slot(points_[i])] = static_cast<std::uint32_t>(i);
    }
  }

  std::vector<Vec3> points_;
  std::vector<std::uint32_t> slots_;
};

/// The two ends of a side, the smaller node number first.
using NodePair = std::array<std::uint32_t, 2>;

inline NodePair node_pair(std::uint32_t a, std::uint32_t b) {
  return a < b ? NodePair{a, b} : NodePair{b, a};
}

}  // namespace meshgrow

#endif
