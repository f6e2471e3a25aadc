#include "start_sizes/fixed_start_sizes.h"

namespace meshgrow {

DroppedFacets append_fixed_start_sizes(const FacetedSource& source, double start_size, double slope,
                                       SizedFacets& facets) {
  DroppedFacets dropped;
  for (const Vec3& point : source.points) {
    append_facet(Facet::point(point), start_size, slope, facets, dropped);
  }
  for (const auto& [a, b] : source.segments) {
    append_facet(Facet::segment(a, b), start_size, slope, facets, dropped);
  }
  for (const auto& [a, b, c] : source.triangles) {
    append_facet(Facet::triangle(a, b, c), start_size, slope, facets, dropped);
  }
  for (const auto& quad : source.quads) {
    for (const Facet& half : split_quad(quad)) {
      append_facet(half, start_size, slope, facets, dropped);
    }
  }
  return dropped;
}

}  // namespace meshgrow
