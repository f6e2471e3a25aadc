#ifndef MESHGROW_GEOMETRY_SAMPLER_H
#define MESHGROW_GEOMETRY_SAMPLER_H

#include "faceted_source.h"
#include "topology.h"

namespace meshgrow {

/// Pieces of an entity made from its geometry, for sources that have no mesh. Only reads the model.
///
/// A point gives itself, a curve segments along its parametrisation, a surface triangles of its
/// parametrisation within the trimming curves together with segments along those curves, a volume
/// the pieces of its faces. Pieces lie within a tenth of `resolution` (model units) of the entity
/// where the depth of refinement allows it; along trimming curves of a surface, gaps of up to half
/// a resolution may stay open between triangles and segments.
///
/// Throws Error for an entity without parametrisation (a discrete one without a mesh).
FacetedSource sample_geometry(const Entity& entity, const Topology& topology, double resolution);

}  // namespace meshgrow

#endif
