#ifndef MESHGROW_START_SIZES_CURVATURE_START_SIZES_H
#define MESHGROW_START_SIZES_CURVATURE_START_SIZES_H

#include "faceted_source.h"
#include "sized_facets.h"

namespace meshgrow {

struct CurvatureParameters {
  double angle = 18.0;      ///< degrees that an edge of an element may turn by
  double min_size = 0.0;    ///< model units; smaller start sizes become this one
  double size_limit = 0.0;  ///< model units; facets that ask for more are left out
};

/// The edge length that spans `angle` degrees of a circle of this curvature (1 / model units):
/// 2 sin(angle / 2) / curvature, infinite for curvature 0.
double curvature_start_size(double curvature, double angle);

/// Initialization of a curvature size function (paper, section 3): each segment and triangle of the
/// source has the start size of its largest curvature, by the geometry where that is known, else by
/// its neighbours (discrete_curvature.h). Quads count as two triangles. Flat pieces give no facet.
/// Appends to `facets`; thread-safe on different outputs.
DroppedFacets append_curvature_start_sizes(const FacetedSource& source,
                                           const CurvatureParameters& parameters, double slope,
                                           SizedFacets& facets);

}  // namespace meshgrow

#endif
