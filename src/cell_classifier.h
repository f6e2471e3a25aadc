#ifndef MESHGROW_CELL_CLASSIFIER_H
#define MESHGROW_CELL_CLASSIFIER_H

#include <cstdint>
#include <vector>

#include "facet_tree.h"
#include "grid_cell.h"

namespace meshgrow {

/// Decides whether a cell of the background grid may be a leaf, and which facets its children need.
///
/// Each facet's size h_f = S0 + α · distance is convex, so its tangent plane T_f at the cell's
/// centre is a lower bound of it everywhere. Linear functions are reproduced by trilinear
/// interpolation, whose weights are not negative; hence an order between T_f and other values at
/// the eight corners holds in the whole cell. Three proofs rest on that, with g the facet that
/// rules at the centre:
///
/// - f never rules in the cell if T_f ≥ h_g at the corners (h_f ≥ T_f ≥ interpolated h_g ≥ h_g);
/// - the interpolant u of the exact corner values stays below (1 + t) h_f if (1 + t) T_f ≥ u at the
///   corners;
/// - h ≤ (1 + t) u if h_g ≤ (1 + t) u at the corners (h ≤ h_g ≤ interpolated h_g).
///
/// Beside them the Lipschitz bound |u − h| ≤ (√3/2) α s for a cell of edge s, which ends refinement
/// whatever the facets are. Uses scratch memory: one object per thread.
class CellClassifier {
 public:
  enum class Verdict { interpolate, keep_facets, split };

  CellClassifier(const FacetTree& tree, double size_limit, double tolerance,
                 std::size_t facets_per_exact_leaf);

  /// `candidates`: every facet of the tree that can rule somewhere in the cell.
  Verdict classify(const GridCell& cell, const std::vector<std::uint32_t>& candidates);

  /// After classify: the candidates that can still rule in the cell.
  const std::vector<std::uint32_t>& ruling_facets() const { return ruling_; }

  /// After a verdict keep_facets: facets whose minimum is within (1 + t) of the field in the cell.
  const std::vector<std::uint32_t>& leaf_facets() const { return leaf_facets_; }

  /// After classify: exact sizes at the corners of the cell's children.
  const Lattice& lattice(const GridCell& cell);

 private:
  struct Tangent {
    double at_centre = 0.0;
    Vec3 slope_times_half_edge = Vec3::Zero();

    double at_corner(int i) const {
      return at_centre + (i & 1 ? slope_times_half_edge.x() : -slope_times_half_edge.x()) +
             (i & 2 ? slope_times_half_edge.y() : -slope_times_half_edge.y()) +
             (i & 4 ? slope_times_half_edge.z() : -slope_times_half_edge.z());
    }
    double smallest() const { return at_centre - slope_times_half_edge.cwiseAbs().sum(); }
  };

  void compute_tangents(const GridCell& cell, const std::vector<std::uint32_t>& candidates);
  void drop_never_ruling(const std::vector<std::uint32_t>& candidates);
  bool bounded_by_lipschitz(const GridCell& cell) const;
  bool never_too_coarse(const GridCell& cell) const;
  bool not_much_too_fine(const GridCell& cell);
  bool few_facets_suffice();

  /// The exact size at p, whose place in the cell is `local`, in half edges from the centre.
  double size_by_ruling_facets(const Vec3& p, const Vec3& local) const;

  const FacetTree& tree_;
  double size_limit_;
  double tolerance_;
  std::size_t facets_per_exact_leaf_;

  std::vector<Tangent> tangents_;
  std::vector<std::uint32_t> ruling_;
  std::vector<Tangent> ruling_tangents_;
  std::vector<std::uint32_t> leaf_facets_;
  /// First among the candidates, then, once some are dropped, among the ruling facets.
  std::int64_t best_ = -1;              ///< candidate that rules at the centre; -1: the size limit
  std::array<double, 8> best_corners_;  ///< its sizes at the corners: upper bounds of the field
  Lattice lattice_;
  bool lattice_known_ = false;
};

}  // namespace meshgrow

#endif
