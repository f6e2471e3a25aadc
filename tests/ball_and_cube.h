#ifndef MESHGROW_TESTS_BALL_AND_CUBE_H
#define MESHGROW_TESTS_BALL_AND_CUBE_H

#include "size_function.h"
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

/// The mesh of the ball's surface grows into the ball.
inline SizeFunction mesh_in_ball(double growth_rate, double size_limit) {
  SizeFunction function;
  function.kind = Kind::mesh;
  function.sources = {surface};
  function.attachments = {volume};
  function.growth_rate = growth_rate;
  function.size_limit = size_limit;
  return function;
}

/// The size 0.1 on the cube's surface grows into the cube.
inline SizeFunction fixed_in_cube(double growth_rate, double size_limit) {
  SizeFunction function = mesh_in_ball(growth_rate, size_limit);
  function.kind = Kind::fixed;
  function.start_size = 0.1;
  function.sources = {other_surface};
  function.attachments = {other_volume};
  return function;
}

}  // namespace meshgrow::test

#endif
