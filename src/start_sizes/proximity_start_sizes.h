#ifndef MESHGROW_START_SIZES_PROXIMITY_START_SIZES_H
#define MESHGROW_START_SIZES_PROXIMITY_START_SIZES_H

#include <set>
#include <vector>

#include "entity.h"
#include "facet_origins.h"
#include "region_walls.h"
#include "sized_facets.h"

namespace meshgrow {

struct ProximityParameters {
  double cells_per_gap = 3.0;  ///< elements across a gap, > 0, need not be whole
  double growth_rate = 1.2;
  double size_limit = 0.0;  ///< model units; gaps that ask for more make no facet
  double min_size = 0.0;    ///< model units; gaps that ask for less are ignored
  int threads = 0;          ///< 0: default_threads()
};

/// Start size on both sides of a gap of this width, so that `cells` elements fit into it while they
/// grow from both sides to the middle: the count is the integral of 1 / S(R) across the gap, so
/// S0 = α·gap / (2 (exp(α·cells/2) − 1)), and gap / cells for a growth rate of 1.
double gap_start_size(double gap, double cells, double growth_rate);

/// Initialization of a proximity size function (paper, section 3) in one region: each wall of one
/// of the `sources` gets the start size for the gap between it and the wall opposite, through the
/// region. Walls are cut into pieces as small as the gap varies, at most as long as the size limit.
/// Appends to `facets`, and to `origins` of which entities they are.
///
/// The gap at a point of a wall is the smaller one of the distance along its normal to the first
/// wall met (in volumes), and of the distance to the closest wall that is seen within 45° of the
/// normal, to 1 % (gap_finder.h); in both cases the two normals must oppose each other within 45°.
/// Across a round bore that is the chord at 22.5°, 8 % less than the diameter.
///
/// Where opposing walls meet (share a node or a side, with the region between them), they and what
/// goes on smoothly from them make no gap closer than the size limit to that place: a wedge has
/// none near its tip, however fine or coarse its facets are. The result does not depend on the
/// number of threads.
void append_proximity_start_sizes(const std::vector<Wall>& walls, const std::set<Entity>& sources,
                                  const ProximityParameters& parameters, SizedFacets& facets,
                                  FacetOrigins* origins = nullptr);

}  // namespace meshgrow

#endif
