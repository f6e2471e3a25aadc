#include "start_sizes/mesh_start_sizes.h"

namespace meshgrow {

namespace {

double mean_of_sides(const Facet& triangle) {
  return triangle_size(triangle.corners[0], triangle.corners[1], triangle.corners[2]);
}

double mean_of_sides(const std::array<Vec3, 4>& quad) {
  double sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    sum += segment_size(quad[i], quad[(i + 1) % 4]);
  }
  return sum / 4.0;
}

}  // namespace

DroppedFacets append_mesh_start_sizes(const FacetedSource& source, QuadSize quad_size, double slope,
                                      SizedFacets& facets) {
  DroppedFacets dropped;
  for (const auto& [a, b] : source.segments) {
    append_facet(Facet::segment(a, b), segment_size(a, b), slope, facets, dropped);
  }
  for (const auto& [a, b, c] : source.triangles) {
    const Facet triangle = Facet::triangle(a, b, c);
    append_facet(triangle, mean_of_sides(triangle), slope, facets, dropped);
  }
  for (const auto& quad : source.quads) {
    for (const Facet& half : split_quad(quad)) {
      const double size = quad_size == QuadSize::sides ? mean_of_sides(quad) : mean_of_sides(half);
      append_facet(half, size, slope, facets, dropped);
    }
  }
  return dropped;
}

}  // namespace meshgrow
