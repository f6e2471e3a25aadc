#ifndef MESHGROW_TESTS_BALL_AND_CUBE_H
#define MESHGROW_TESTS_BALL_AND_CUBE_H

#include "topology.h"

namespace meshgrow::test {

inline const Entity volume = {3, 1};
inline const Entity surface = {2, 1};
inline const Entity other_volume = {3, 2};
inline const Entity other_surface = {2, 2};

/// A ball, volume and surface 1, and a cube beside it, volume and surface 2, that share nothing.
inline Topology ball_and_cube() {
  Topology topology;
  topology.add_entity(surface, {}, Box(Vec3(-1, -1, -1), Vec3(1, 1, 1)));
  topology.add_entity(volume, {surface}, Box(Vec3(-2, -2, -2), Vec3(2, 2, 2)));
  topology.add_entity(other_surface, {}, Box(Vec3(3, 0, 0), Vec3(4, 1, 1)));
  topology.add_entity(other_volume, {other_surface}, Box(Vec3(3, 0, 0), Vec3(4, 1, 1)));
  return topology;
}

}  // namespace meshgrow::test

#endif
