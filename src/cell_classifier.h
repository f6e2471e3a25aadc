#ifndef MESHGROW_CELL_CLASSIFIER_H
#define MESHGROW_CELL_CLASSIFIER_H

#include <cstdint>
#include <vector>

#include "facet_tree.h"
#include "grid_cell.h"

namespace meshgrow {

/// Parts of the tree: every facet that can rule in a cell is below them.
using CellCandidates = std::vector<simd::NodeEntry>;

/// Decides whether a cell of the background grid may be a leaf, and what its children need to know.
///
/// The size S0 + α · distance from a facet is convex, so its tangent plane T_f at the cell's centre
/// is a lower bound of it everywhere; so is that of a box of facets, with the smallest start size
/// in it. Linear functions are reproduced by trilinear interpolation, whose weights are not
/// negative; hence an order between T_f and other values at the eight corners holds in the whole
/// cell. Three proofs rest on that, with g the facet that rules at the centre:
///
/// - f never rules in the cell if T_f ≥ h_g at the corners (h_f ≥ T_f ≥ interpolated h_g ≥ h_g);
/// - the interpolant u of values at the corners stays below (1 + t) h_f if (1 + t) T_f ≥ u at the
///   corners. Exact values may be too large by (1 + t)² even so: they are made smaller as needed;
/// - h ≤ (1 + 2t) u if h_g ≤ (1 + 2t) u at the corners (h ≤ h_g ≤ interpolated h_g).
///
/// The size limit is convex as well and may stand for h_g, but at all corners: the smaller of the
/// two at each corner would prove nothing, as their minimum is not convex.
///
/// Beside them the Lipschitz bound |u − h| ≤ (√3/2) α s for a cell of edge s, which ends refinement
/// whatever the facets are. Boxes are descended into only as far as they do not decide. Uses
/// scratch memory: one object per thread.
class CellClassifier {
 public:
  enum class Verdict { interpolate, keep_facets, split };

  CellClassifier(const FacetTree& tree, const GridCube& cube, double size_limit, double tolerance,
                 std::size_t facets_per_exact_leaf);

  /// `ruling`: the smallest size at the cell's centre; no facet: the size limit.
  Verdict classify(const GridCell& cell, const FacetTree::Smallest& ruling,
                   const CellCandidates& candidates);

  /// After a verdict interpolate: what the corner values are to be multiplied by, at most 1.
  double scale() const { return scale_; }

  /// After a verdict keep_facets: the minimum of the facets below them, and of the size limit, is
  /// within (1 + t) of the field in the cell.
  const std::vector<simd::NodeEntry>& leaf_entries() const { return leaf_entries_; }

  /// What the children of a cell need.
  struct Split {
    CellCandidates candidates;
    Lattice lattice;  ///< exact sizes at their corners
    std::array<FacetTree::Smallest, 8> ruling;
  };

  /// After a verdict split, above the greatest depth.
  const Split& split(const GridCell& cell);

  /// Exact size, without a cell around the point.
  FacetTree::Smallest smallest(const Vec3& p) const;

 private:
  FacetTree::Smallest known_at(const Vec3& p) const;
  FacetTree::Entries children_entries() const {
    return {split_.candidates.data(), static_cast<int>(split_.candidates.size())};
  }
  void find_ruling_corners();
  /// What the facet that rules at the centre gives: an upper bound of the field.
  double ruling_size(const LatticePlace& place) const;
  void find_lattice_sizes(const GridCell& cell, const int* points, int count);
  bool bounded_by_lipschitz(const GridCell& cell) const;
  bool never_too_coarse(const GridCell& cell);
  bool not_much_too_fine(const GridCell& cell);
  bool few_facets_suffice(const GridCell& cell);
  void find_ruling_entries(const GridCell& cell);
  simd::Survivors survivors_below(double factor, std::vector<simd::NodeEntry>& room) const;
  bool collect(simd::Survivors& query, std::vector<simd::NodeEntry>& entries) const;

  const FacetTree& tree_;
  GridCube cube_;
  double size_limit_;
  double tolerance_;
  std::size_t facets_per_exact_leaf_;

  const CellCandidates* candidates_ = nullptr;
  FacetTree::Smallest ruling_;            ///< at the centre; no facet: the size limit
  std::array<double, 8> ruling_corners_;  ///< its sizes at the corners, whatever the limit
  simd::CellCorners kernel_cell_;
  double scale_ = 1.0;
  std::vector<simd::NodeEntry> leaf_entries_;
  bool entries_known_ = false;
  Split split_;

  /// Sizes at places of the lattice that neighbouring cells ask for again.
  struct Known {
    std::uint64_t key = ~0ull;
    double size = 0.0;
  };
  Known& known_size(const LatticePlace& place);
  std::vector<Known> known_;
};

}  // namespace meshgrow

#endif
