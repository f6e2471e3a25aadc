#include "start_sizes/proximity_start_sizes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "growth_law.h"
#include "parallel.h"
#include "start_sizes/gap_finder.h"

namespace meshgrow {

namespace {

/// A piece this small against its distance from the nearest wall opposite is measured in its
/// centre.
constexpr double small_piece = 0.25;

/// How much the gaps at the corners and the centre of a larger piece may differ.
constexpr double same_gap = 0.05;

/// Walls this close, in parts of the extent of all, are in contact: as where a ball lies on a
/// plane, which may meet in no node. Any smaller size would be of no use to a mesher.
constexpr double contact = 1e-5;

/// Looked at, of a piece as large as the size limit; what is left then is measured as it is.
constexpr std::size_t most_pieces = 4096;

constexpr std::size_t walls_per_chunk = 256;

struct LongestSide {
  int from = 0;
  double length = 0.0;

  explicit LongestSide(const Facet& piece) {
    for (int i = 0; i < piece.corner_count; ++i) {
      const double side = (piece.corners[(i + 1) % 3] - piece.corners[i]).norm();
      if (side > length) {
        length = side;
        from = i;
      }
    }
  }
};

std::array<Facet, 2> bisect(const Facet& piece) {
  const int i = LongestSide(piece).from;
  const Vec3& a = piece.corners[i];
  const Vec3& b = piece.corners[(i + 1) % 3];
  const Vec3 middle = 0.5 * (a + b);
  if (piece.corner_count == 2) {
    return {Facet::segment(a, middle), Facet::segment(middle, b)};
  }
  const Vec3& c = piece.corners[(i + 2) % 3];
  return {Facet::triangle(a, middle, c), Facet::triangle(middle, b, c)};
}

/// Cuts one wall at a time into pieces with start sizes.
class WallSizer {
 public:
  WallSizer(const GapFinder& finder, const ProximityParameters& parameters, double extent)
      : finder_(finder),
        parameters_(parameters),
        size_of_unit_gap_(gap_start_size(1.0, parameters.cells_per_gap, parameters.growth_rate)),
        reach_(parameters.size_limit / size_of_unit_gap_),
        least_gap_(std::max(parameters.min_size / size_of_unit_gap_, contact * extent)),
        slope_(growth_slope(parameters.growth_rate)) {}

  void append(const Wall& wall, std::size_t index, SizedFacets& facets) const {
    std::vector<Facet> pieces{wall.facet};
    while (!pieces.empty()) {
      const Facet piece = pieces.back();
      pieces.pop_back();
      if (LongestSide(piece).length <= parameters_.size_limit) {
        append_base_piece(piece, index, facets);
      } else if (finder_.is_faced(piece, index, reach_ + piece.radius())) {
        for (const Facet& half : bisect(piece)) {
          pieces.push_back(half);
        }
      }
    }
  }

 private:
  /// Larger pieces first, so that all parts of the wall are served alike.
  void append_base_piece(const Facet& base, std::size_t wall, SizedFacets& facets) const {
    std::vector<Facet> pieces{base};
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const Facet piece = pieces[i];
      if (i >= most_pieces || piece.radius() < small_piece * least_gap_ ||
          !finder_.is_faced(piece, wall, piece.radius() / small_piece)) {
        append_facet(piece, finder_.gap(wall, piece.centroid(), reach_), facets);
        continue;
      }
      const double gap = uniform_gap(piece, wall);
      if (gap < GapFinder::infinity) {
        append_facet(piece, gap, facets);
      } else {
        for (const Facet& half : bisect(piece)) {
          pieces.push_back(half);
        }
      }
    }
  }

  /// The smallest gap of the piece if it has about the same gap everywhere, else infinity.
  double uniform_gap(const Facet& piece, std::size_t wall) const {
    const Vec3 centre = piece.centroid();
    double least = finder_.gap(wall, centre, reach_);
    double largest = least;
    for (int i = 0; i < piece.corner_count && largest <= (1.0 + same_gap) * least; ++i) {
      // Pulled off the corner, which may lie on another wall.
      const Vec3 p = piece.corners[i] + 0.1 * (centre - piece.corners[i]);
      const double gap = finder_.gap(wall, p, reach_);
      least = std::min(least, gap);
      largest = std::max(largest, gap);
    }
    const bool uniform = largest < GapFinder::infinity && largest <= (1.0 + same_gap) * least &&
                         finder_.is_clear(piece, wall, (1.0 - same_gap) * least);
    return uniform ? least : GapFinder::infinity;
  }

  void append_facet(const Facet& piece, double gap, SizedFacets& facets) const {
    const double size = gap * size_of_unit_gap_;
    if (gap >= least_gap_ && size < parameters_.size_limit) {
      facets.push_back({piece, size, slope_});
    }
  }

  const GapFinder& finder_;
  const ProximityParameters& parameters_;
  double size_of_unit_gap_;
  double reach_;      ///< gap whose start size is the size limit
  double least_gap_;  ///< narrower ones are ignored
  double slope_;
};

}  // namespace

double gap_start_size(double gap, double cells, double growth_rate) {
  const double slope = growth_slope(growth_rate);
  return slope > 0.0 ? 0.5 * slope * gap / std::expm1(0.5 * slope * cells) : gap / cells;
}

void append_proximity_start_sizes(const std::vector<Wall>& walls, const std::set<Entity>& sources,
                                  const ProximityParameters& parameters, SizedFacets& facets,
                                  FacetOrigins* origins) {
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    if (sources.count(walls[i].entity) > 0) {
      chosen.push_back(i);
    }
  }
  if (chosen.empty()) {
    return;
  }
  const GapFinder finder(walls, parameters.size_limit);
  Box box;
  for (const Wall& wall : walls) {
    box.extend(wall.facet.box());
  }
  const WallSizer sizer(finder, parameters, box.diagonal().norm());
  struct Chunk {
    SizedFacets facets;
    FacetOrigins origins;
  };
  std::vector<Chunk> found((chosen.size() + walls_per_chunk - 1) / walls_per_chunk);
  parallel_for(found.size(), parameters.threads, [&](std::size_t chunk) {
    const std::size_t first = chunk * walls_per_chunk;
    const std::size_t last = std::min(first + walls_per_chunk, chosen.size());
    for (std::size_t i = first; i < last; ++i) {
      const Wall& wall = walls[chosen[i]];
      found[chunk].origins.begin(found[chunk].facets.size(), wall.entity);
      sizer.append(wall, chosen[i], found[chunk].facets);
    }
  });
  for (const Chunk& chunk : found) {
    if (origins != nullptr) {
      for (const auto& [first, entity] : chunk.origins.stretches()) {
        origins->begin(facets.size() + first, entity);
      }
    }
    facets.insert(facets.end(), chunk.facets.begin(), chunk.facets.end());
  }
}

}  // namespace meshgrow
