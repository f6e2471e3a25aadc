#ifndef MESHGROW_GRID_BUILDER_H
#define MESHGROW_GRID_BUILDER_H

#include <array>
#include <memory>
#include <vector>

#include "background_grid.h"
#include "cell_budget.h"
#include "cell_classifier.h"

namespace meshgrow {

/// Builds the octree of a BackgroundGrid: the topmost levels breadth-first, then the subtrees below
/// them in parallel, joined in a fixed order. Every decision depends on its cell alone, so the
/// result is the same to the bit for any number of threads.
class GridBuilder {
 public:
  GridBuilder(const FacetTree& tree, const GridCube& cube, double size_limit,
              const GridOptions& options);

  /// Refines as deep as needed; if that takes too many cells, as deep as max_cells() allow.
  GridNodes build();

  std::size_t max_cells() const { return max_cells_; }
  /// Whether the grid that was built is less deep than it should be.
  bool is_limited() const { return is_limited_; }

 private:
  using NodeCode = GridNodeCode;
  using NodeKind = GridNodeKind;
  using Nodes = GridNodes;
  using Verdict = CellClassifier::Verdict;

  /// Where a cell is against the region in which sizes are asked for.
  struct Whereabouts {
    enum class Place { boundary, inside, outside };
    Place place = Place::inside;
    /// For what is on the boundary: a point nearby, and whether it is inside.
    Vec3 known_point = Vec3::Zero();
    bool known_is_inside = true;
  };

  /// A cell still to be classified, and the place in `blocks` that waits for its code.
  struct OpenCell {
    GridCell cell;
    FacetTree::Smallest ruling;
    std::shared_ptr<const CellCandidates> candidates;
    std::size_t block = 0;
    int child = 0;
    Whereabouts whereabouts;
  };

  /// `thread`: its number in the team that works on this grid; who calls may be one of others.
  CellClassifier& own_classifier(int thread);
  bool fits(int max_depth);
  void tell(double finished);
  void join(const std::vector<OpenCell>& open, const std::vector<NodeCode>& roots,
            std::vector<Nodes>& parts);
  std::vector<OpenCell> build_top();
  NodeCode build_subtree(const GridCell& cell, const FacetTree::Smallest& ruling,
                         const CellCandidates& candidates, Whereabouts whereabouts,
                         CellClassifier& classifier, Nodes& nodes) const;
  Whereabouts of_root(const GridCell& root) const;
  std::array<Whereabouts, 8> of_children(const std::array<GridCell, 8>& children,
                                         const Whereabouts& parent) const;
  Vec3 point_of_reference(const GridCell& cell) const;
  NodeCode append_leaf(Verdict verdict, const GridCell& cell, const CellClassifier& classifier,
                       Nodes& nodes) const;
  NodeCode append_undecided(const GridCell& cell, const FacetTree::Smallest& ruling,
                            Nodes& nodes) const;
  std::size_t append_block(Nodes& nodes) const;
  void append_subtree(const Nodes& part, NodeCode part_root, const OpenCell& place);
  void set_code(const OpenCell& place, NodeCode code);

  const FacetTree& tree_;
  const GridCube& cube_;
  double size_limit_;
  const GridOptions& options_;
  Nodes nodes_;
  double tolerance_;
  std::size_t max_cells_;
  int max_depth_ = max_grid_depth;
  bool is_limited_ = false;
  double told_ = 0.0;
  std::unique_ptr<CellBudget> budget_;
  std::vector<std::unique_ptr<CellClassifier>> classifiers_;  ///< one a thread
};

}  // namespace meshgrow

#endif
