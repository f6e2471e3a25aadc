#ifndef MESHGROW_SOURCE_FACETS_H
#define MESHGROW_SOURCE_FACETS_H

#include <map>
#include <set>

#include "faceted_source.h"
#include "model_reader.h"
#include "shape_pieces.h"
#include "shape_sampler.h"
#include "size_field.h"

namespace meshgrow {

/// The pieces of sources of curvature and proximity size functions: the elements of their mesh
/// where there is one, else facets made from the geometry (shape_sampler.h). Only reads the current
/// model.
class SourceFacets {
 public:
  SourceFacets(const Topology& topology, const NodeCoordinates& nodes);

  /// A curve or surface with the curvatures of its geometry at each piece. Pieces made for the
  /// purpose turn by a third of `angle` at most and are so small that the curvature hardly varies
  /// on them wherever it asks for sizes between `min_size` and `size_limit`.
  FacetedSource with_curvature(const Entity& entity, const SizeFunction& function);

  /// The walls of a volume or surface.
  std::vector<Wall> walls(const Entity& region);

 private:
  ShapeSampler& sampler(double max_turn);
  FacetedSource shape(const Entity& entity);
  FacetedSource meshed_with_curvature(const Entity& entity);
  static FacetedSource sampled(const Entity& entity, std::vector<ShapePiece> pieces,
                               const SizeFunction& function);

  const Topology& topology_;
  const NodeCoordinates& nodes_;
  std::map<double, ShapeSampler> samplers_;
  std::map<Entity, FacetedSource> shapes_;
};

}  // namespace meshgrow

#endif
