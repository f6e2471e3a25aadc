#include "sized_facets.h"

#include <cmath>

namespace meshgrow {

double segment_size(const Vec3& a, const Vec3& b) { return (b - a).norm(); }

double triangle_size(const Vec3& a, const Vec3& b, const Vec3& c) {
  return ((b - a).norm() + (c - b).norm() + (a - c).norm()) / 3.0;
}

void append_facet(const Facet& facet, double start_size, double slope, SizedFacets& facets,
                  DroppedFacets& dropped) {
  bool finite = std::isfinite(start_size);
  for (const Vec3& corner : facet.corners) {
    finite = finite && corner.allFinite();
  }
  if (!finite) {
    ++dropped.not_finite;
  } else if (!(start_size > 0.0)) {
    ++dropped.zero_size;
  } else {
    facets.push_back({facet, start_size, slope});
  }
}

std::array<Facet, 2> split_quad(const std::array<Vec3, 4>& quad) {
  return {Facet::triangle(quad[0], quad[1], quad[2]), Facet::triangle(quad[0], quad[2], quad[3])};
}

}  // namespace meshgrow
