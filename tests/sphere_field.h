#ifndef MESHGROW_TESTS_SPHERE_FIELD_H
#define MESHGROW_TESTS_SPHERE_FIELD_H

#include <cstddef>

#include "graded_sphere.h"
#include "size_field.h"

namespace meshgrow::test {

/// Sizes that grow from a unit sphere of so many triangles, surface 1, into volume 1 around it,
/// with a grid unless the evaluator is exact.
inline SizeField sphere_field(std::size_t facets, Evaluator evaluator = Evaluator::automatic) {
  Topology topology;
  topology.add_entity({2, 1}, {}, Box(Vec3(-1, -1, -1), Vec3(1, 1, 1)));
  topology.add_entity({3, 1}, {{2, 1}}, Box(Vec3(-2, -2, -2), Vec3(2, 2, 2)));
  FieldOptions options;
  options.evaluator = evaluator;
  SizeField field(topology, options);
  SizeFunction function;
  function.sources = {{2, 1}};
  function.attachments = {{3, 1}};
  function.size_limit = 1.0;
  field.add(function);
  FacetedSource source;
  source.entity = {2, 1};
  source.triangles = graded_sphere(facets, 20.0);
  field.set_sources(0, {source});
  field.build_grids();
  return field;
}

}  // namespace meshgrow::test

#endif
