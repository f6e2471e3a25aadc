#ifndef MESHGROW_SIZED_FACETS_H
#define MESHGROW_SIZED_FACETS_H

#include <cstddef>
#include <vector>

#include "facet.h"
#include "faceted_source.h"

namespace meshgrow {

/// A facet with the size stored on it and the slope at which that size grows (growth_law.h).
struct SizedFacet {
  Facet facet;
  double start_size = 0.0;  ///< S0 > 0, model units
  double slope = 0.0;       ///< α in [0, 1)

  friend bool operator==(const SizedFacet& a, const SizedFacet& b) {
    return a.facet == b.facet && a.start_size == b.start_size && a.slope == b.slope;
  }

  /// S0 + α · distance: the size that this facet alone asks for at p.
  double size_at(const Vec3& p) const { return start_size + slope * distance(facet, p); }
};

using SizedFacets = std::vector<SizedFacet>;

/// How a quadrilateral element is sized (DESIGN.md, section 2).
enum class QuadSize {
  triangles,  ///< each of its two triangles by its own three sides, the diagonal included (the
              ///< paper)
  sides       ///< both triangles by the mean of the quad's four sides
};

/// Length of a segment.
double segment_size(const Vec3& a, const Vec3& b);

/// Mean length of the three sides (paper, section 3).
double triangle_size(const Vec3& a, const Vec3& b, const Vec3& c);

/// What `append_facet` leaves out: collapsed elements and elements with a coordinate that is not
/// finite.
struct DroppedFacets {
  std::size_t zero_size = 0;
  std::size_t not_finite = 0;

  DroppedFacets& operator+=(const DroppedFacets& more) {
    zero_size += more.zero_size;
    not_finite += more.not_finite;
    return *this;
  }
};

/// Appends the facet unless its start size is not positive or something in it is not finite, which
/// is counted in `dropped`.
void append_facet(const Facet& facet, double start_size, double slope, SizedFacets& facets,
                  DroppedFacets& dropped);

/// The two triangles of a quad, split along the diagonal from its first to its third corner.
std::array<Facet, 2> split_quad(const std::array<Vec3, 4>& quad);

}  // namespace meshgrow

#endif
