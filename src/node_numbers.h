#ifndef MESHGROW_NODE_NUMBERS_H
#define MESHGROW_NODE_NUMBERS_H

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <unordered_map>

#include "geometry.h"

namespace meshgrow {

/// Numbers nodes by their coordinates, from 0 on: the same number where all three are equal to the
/// bit (0 and −0 are equal, too).
class NodeNumbers {
 public:
  std::uint32_t of(const Vec3& p) {
    return numbers_.emplace(p, static_cast<std::uint32_t>(numbers_.size())).first->second;
  }

  std::size_t count() const { return numbers_.size(); }

 private:
  struct Hash {
    std::size_t operator()(const Vec3& p) const {
      std::uint64_t hash = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const double coordinate = p[axis] + 0.0;  // −0 becomes 0
        std::uint64_t bits = 0;
        std::memcpy(&bits, &coordinate, sizeof bits);
        hash = (hash ^ bits) * 0x9E3779B97F4A7C15u;
        hash ^= hash >> 29;
      }
      return hash;
    }
  };

  std::unordered_map<Vec3, std::uint32_t, Hash> numbers_;
};

/// The two ends of a side, the smaller node number first.
using NodePair = std::array<std::uint32_t, 2>;

inline NodePair node_pair(std::uint32_t a, std::uint32_t b) {
  return a < b ? NodePair{a, b} : NodePair{b, a};
}

}  // namespace meshgrow

#endif
