#include "start_sizes/curvature_start_sizes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "discrete_curvature.h"

namespace meshgrow {

namespace {

/// The curvatures that are known, completed by those of the facets.
template <typename Pieces, typename FromFacets>
std::vector<double> completed(std::vector<double> known, const Pieces& pieces,
                              FromFacets from_facets) {
  known.resize(pieces.size(), std::numeric_limits<double>::quiet_NaN());
  const auto is_unknown = [](double value) { return !std::isfinite(value); };
  if (std::any_of(known.begin(), known.end(), is_unknown)) {
    const std::vector<double> measured = from_facets(pieces);
    for (std::size_t i = 0; i < known.size(); ++i) {
      known[i] = is_unknown(known[i]) ? measured[i] : known[i];
    }
  }
  return known;
}

}  // namespace

double curvature_start_size(double curvature, double angle) {
  const double half_angle = 0.5 * angle * std::acos(-1.0) / 180.0;
  return 2.0 * std::sin(half_angle) / curvature;
}

DroppedFacets append_curvature_start_sizes(const FacetedSource& source,
                                           const CurvatureParameters& parameters, double slope,
                                           SizedFacets& facets) {
  DroppedFacets dropped;
  const auto append = [&](const Facet& facet, double curvature) {
    const double size = curvature_start_size(curvature, parameters.angle);
    if (!(size >= parameters.size_limit)) {
      append_facet(facet, std::max(size, parameters.min_size), slope, facets, dropped);
    }
  };
  const std::vector<double> of_segments =
      completed(source.segment_curvatures, source.segments, segment_curvatures);
  for (std::size_t i = 0; i < source.segments.size(); ++i) {
    append(Facet::segment(source.segments[i][0], source.segments[i][1]), of_segments[i]);
  }
  std::vector<std::array<Vec3, 3>> triangles = source.triangles;
  for (const auto& quad : source.quads) {
    for (const Facet& half : split_quad(quad)) {
      triangles.push_back(half.corners);
    }
  }
  const std::vector<double> of_triangles =
      completed(source.triangle_curvatures, triangles, triangle_curvatures);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    append(Facet::triangle(triangles[i][0], triangles[i][1], triangles[i][2]), of_triangles[i]);
  }
  return dropped;
}

}  // namespace meshgrow
