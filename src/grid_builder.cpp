#include "grid_builder.h"

#include <algorithm>
#include <cmath>

#include "parallel.h"

namespace meshgrow {

namespace {

/// So many open cells are enough to keep all threads busy to the end.
constexpr std::size_t open_cells_wanted = 512;

/// Taken off the tolerance: rounding of corner values, and of what is proven about them, to float.
/// Relative to 1 + t.
constexpr double rounding_reserve = 1.2e-5;

constexpr std::size_t nodes_of_block = 8;

/// Sizes that float holds with all its digits.
bool fits_float(double size) { return size > 1e-37 && size < 1e37; }

std::array<GridCell, 8> children_of(const GridCell& cell, const Lattice& lattice) {
  std::array<GridCell, 8> children;
  for (int child = 0; child < 8; ++child) {
    children[child] = child_cell(cell, child, lattice);
  }
  return children;
}

}  // namespace

GridBuilder::GridBuilder(const FacetTree& tree, const GridCube& cube, double size_limit,
                         const GridOptions& options)
    : tree_(tree),
      cube_(cube),
      size_limit_(size_limit),
      options_(options),
      tolerance_(options.tolerance - rounding_reserve * (1.0 + options.tolerance)),
      max_cells_(options.max_cells > 0 ? options.max_cells : default_max_cells()) {
  classifiers_.resize(
      static_cast<std::size_t>(options.threads > 0 ? options.threads : default_threads()));
}

CellClassifier& GridBuilder::own_classifier(int thread) {
  std::unique_ptr<CellClassifier>& own = classifiers_.at(static_cast<std::size_t>(thread));
  if (!own) {
    own =
        std::make_unique<CellClassifier>(tree_, cube_, size_limit_, tolerance_,
                                         static_cast<std::size_t>(options_.facets_per_exact_leaf));
  }
  return *own;
}

GridNodes GridBuilder::build() {
  if (!fits(max_grid_depth)) {
    // Whether the cells up to some depth fit depends on no thread, and so neither does the result.
    is_limited_ = true;
    int deep_enough = 0;
    for (int too_deep = max_grid_depth; too_deep - deep_enough > 1;) {
      const int between = (deep_enough + too_deep) / 2;
      (fits(between) ? deep_enough : too_deep) = between;
    }
    // A single cell fits: the entries that one may keep count as less than the fewest allowed.
    if (max_depth_ != deep_enough) {
      fits(deep_enough);
    }
  }
  tell(1.0);
  return std::move(nodes_);
}

/// The fraction never becomes smaller, although a grid with too many cells is begun anew.
void GridBuilder::tell(double finished) {
  told_ = std::max(told_, finished);
  if (options_.progress) {
    options_.progress(told_);
  }
}

/// Builds `nodes_` with cells of at most this depth; false if they are too many.
bool GridBuilder::fits(int max_depth) try {
  nodes_ = Nodes();
  max_depth_ = max_depth;
  budget_ = std::make_unique<CellBudget>(max_cells_);
  const std::vector<OpenCell> open = build_top();
  std::vector<Nodes> parts(open.size());
  std::vector<NodeCode> roots(open.size());
  parallel_for(
      open.size(), options_.threads,
      [&](std::size_t i) {
        roots[i] =
            build_subtree(open[i].cell, open[i].ruling, *open[i].candidates, open[i].whereabouts,
                          own_classifier(omp_get_thread_num()), parts[i]);
      },
      [&](std::size_t done) {
        if (done < open.size()) {
          tell(static_cast<double>(done) / static_cast<double>(open.size()));
        }
      });
  join(open, roots, parts);
  return true;
} catch (const CellBudget::Exceeded&) {
  nodes_ = Nodes();
  return false;
}

void GridBuilder::join(const std::vector<OpenCell>& open, const std::vector<NodeCode>& roots,
                       std::vector<Nodes>& parts) {
  const auto reserve = [&](auto member) {
    std::size_t size = (nodes_.*member).size() + 1;
    for (const Nodes& part : parts) {
      size += (part.*member).size();
    }
    (nodes_.*member).reserve(size);
  };
  reserve(&Nodes::blocks);
  reserve(&Nodes::corners);
  reserve(&Nodes::exact_begin);
  reserve(&Nodes::exact_entries);
  for (std::size_t i = 0; i < open.size(); ++i) {
    append_subtree(parts[i], roots[i], open[i]);
    parts[i] = Nodes();
  }
  nodes_.exact_begin.push_back(static_cast<std::uint32_t>(nodes_.exact_entries.size()));
}

std::vector<GridBuilder::OpenCell> GridBuilder::build_top() {
  OpenCell root;
  root.candidates = std::make_shared<CellCandidates>(1, FacetTree::root);

  // Block 0 stands above the root: its first child is the root's own place.
  Nodes& nodes = nodes_;
  nodes.blocks.emplace_back();
  for (int i = 0; i < 8; ++i) {
    if (!tree_.is_near_enough_for_float(cube_.at(root.cell.corner(i)))) {
      set_code(root, grid_node(NodeKind::tree, 0));
      return {};
    }
  }
  root.ruling = own_classifier(0).smallest(root.cell.centre(cube_));
  for (int i = 0; i < 8; ++i) {
    root.cell.corner_values[i] = own_classifier(0).smallest(cube_.at(root.cell.corner(i))).size;
  }
  root.whereabouts = of_root(root.cell);
  std::vector<OpenCell> open{root};
  while (!open.empty() && open.size() < open_cells_wanted && open.front().cell.depth < max_depth_) {
    struct Classified {
      Verdict verdict;
      Nodes leaf;  ///< that one only
      NodeCode code;
      CellClassifier::Split split;
      std::array<GridCell, 8> children;
      std::array<Whereabouts, 8> places;
    };
    std::vector<Classified> classified(open.size());
    parallel_for(open.size(), options_.threads, [&](std::size_t i) {
      CellClassifier& own = own_classifier(omp_get_thread_num());
      Classified& result = classified[i];
      if (open[i].whereabouts.place == Whereabouts::Place::outside) {
        result.verdict = Verdict::keep_facets;
        result.code = grid_node(NodeKind::tree, 0);
        return;
      }
      result.verdict = own.classify(open[i].cell, open[i].ruling, *open[i].candidates);
      if (result.verdict == Verdict::split) {
        result.split = own.split(open[i].cell);
        result.children = children_of(open[i].cell, result.split.lattice);
        result.places = of_children(result.children, open[i].whereabouts);
      } else {
        result.code = append_leaf(result.verdict, open[i].cell, own, result.leaf);
      }
    });
    std::vector<OpenCell> next;
    for (std::size_t i = 0; i < open.size(); ++i) {
      const Classified& result = classified[i];
      if (result.verdict != Verdict::split) {
        append_subtree(result.leaf, result.code, open[i]);
        continue;
      }
      const std::size_t block = append_block(nodes);
      set_code(open[i], grid_node(NodeKind::block, block));
      const auto candidates = std::make_shared<CellCandidates>(result.split.candidates);
      for (int child = 0; child < 8; ++child) {
        next.push_back({result.children[child], result.split.ruling[child], candidates, block,
                        child, result.places[child]});
      }
    }
    open = std::move(next);
  }
  return open;
}

/// Within the cell, and in no plane in which a boundary is likely to lie.
Vec3 GridBuilder::point_of_reference(const GridCell& cell) const {
  return cube_.at(cell.lowest) + cell.half_edge(cube_) * Vec3(0.9743, 1.0467, 1.0271);
}

GridBuilder::Whereabouts GridBuilder::of_root(const GridCell& root) const {
  if (!options_.region) {
    return {};
  }
  const Vec3 point = point_of_reference(root);
  return {Whereabouts::Place::boundary, point, options_.region->encloses(point)};
}

/// Cells that the boundary does not touch are inside or outside as a whole, and so are neighbours
/// of them: one point tells for all.
std::array<GridBuilder::Whereabouts, 8> GridBuilder::of_children(
    const std::array<GridCell, 8>& children, const Whereabouts& parent) const {
  std::array<Whereabouts, 8> result;
  result.fill(parent);
  if (parent.place != Whereabouts::Place::boundary) {
    return result;
  }
  unsigned untouched = 0;
  for (int i = 0; i < 8; ++i) {
    const double radius = std::sqrt(3.0) * children[i].half_edge(cube_);
    untouched |= options_.region->touches(children[i].centre(cube_), radius) ? 0u : 1u << i;
  }
  Whereabouts nearest = parent;
  for (unsigned open = untouched; open != 0;) {
    int first = 0;
    while ((open >> first & 1) == 0) {
      ++first;
    }
    nearest.known_point = point_of_reference(children[first]);
    nearest.known_is_inside = parent.known_is_inside !=
                              options_.region->separates(parent.known_point, nearest.known_point);
    // Neighbours differ in one bit.
    unsigned connected = 1u << first;
    for (int step = 0; step < 7; ++step) {
      for (int i = 0; i < 8; ++i) {
        if (connected >> i & 1) {
          connected |= (1u << (i ^ 1) | 1u << (i ^ 2) | 1u << (i ^ 4)) & open;
        }
      }
    }
    for (int i = 0; i < 8; ++i) {
      if (connected >> i & 1) {
        result[i].place =
            nearest.known_is_inside ? Whereabouts::Place::inside : Whereabouts::Place::outside;
      }
    }
    open &= ~connected;
  }
  for (Whereabouts& child : result) {
    child.known_point = nearest.known_point;
    child.known_is_inside = nearest.known_is_inside;
  }
  return result;
}

GridBuilder::NodeCode GridBuilder::build_subtree(const GridCell& cell,
                                                 const FacetTree::Smallest& ruling,
                                                 const CellCandidates& candidates,
                                                 Whereabouts whereabouts,
                                                 CellClassifier& classifier, Nodes& nodes) const {
  nodes.depth = std::max(nodes.depth, cell.depth);
  if (whereabouts.place == Whereabouts::Place::outside) {
    return grid_node(NodeKind::tree, 0);
  }
  const Verdict verdict = classifier.classify(cell, ruling, candidates);
  if (verdict != Verdict::split) {
    return append_leaf(verdict, cell, classifier, nodes);
  }
  if (cell.depth == max_depth_) {
    return append_undecided(cell, ruling, nodes);
  }
  const CellClassifier::Split split = classifier.split(cell);
  const std::size_t block = append_block(nodes);
  const std::array<GridCell, 8> children = children_of(cell, split.lattice);
  const std::array<Whereabouts, 8> places = of_children(children, whereabouts);
  for (int child = 0; child < 8; ++child) {
    const NodeCode code = build_subtree(children[child], split.ruling[child], split.candidates,
                                        places[child], classifier, nodes);
    nodes.blocks[block][child] = code;
  }
  return grid_node(NodeKind::block, block);
}

std::size_t GridBuilder::append_block(Nodes& nodes) const {
  budget_->spend(nodes_of_block);
  nodes.blocks.emplace_back();
  return nodes.blocks.size() - 1;
}

/// Answered by the tree. Between exact values at the corners of a cell of edge s, interpolation is
/// off by (√3/2) α s at most.
GridBuilder::NodeCode GridBuilder::append_undecided(const GridCell& cell,
                                                    const FacetTree::Smallest& ruling,
                                                    Nodes& nodes) const {
  const double change = std::sqrt(3.0) * cell.half_edge(cube_) * tree_.largest_slope();
  const double least = std::max(tree_.smallest_start_size(), ruling.size - change);
  nodes.undecided_tolerance = std::max(nodes.undecided_tolerance, change / least);
  return grid_node(NodeKind::tree, 0);
}

GridBuilder::NodeCode GridBuilder::append_leaf(Verdict verdict, const GridCell& cell,
                                               const CellClassifier& classifier,
                                               Nodes& nodes) const {
  nodes.depth = std::max(nodes.depth, cell.depth);
  if (verdict == Verdict::interpolate) {
    if (!std::all_of(cell.corner_values.begin(), cell.corner_values.end(), fits_float)) {
      return grid_node(NodeKind::tree, 0);
    }
    GridCorners values;
    std::transform(cell.corner_values.begin(), cell.corner_values.end(), values.begin(),
                   [&](double value) { return static_cast<float>(value * classifier.scale()); });
    nodes.corners.push_back(values);
    return grid_node(NodeKind::interpolated, nodes.corners.size() - 1);
  }
  budget_->spend(classifier.leaf_entries().size() * sizeof(simd::NodeEntry) / bytes_per_cell);
  nodes.exact_begin.push_back(static_cast<std::uint32_t>(nodes.exact_entries.size()));
  nodes.exact_entries.insert(nodes.exact_entries.end(), classifier.leaf_entries().begin(),
                             classifier.leaf_entries().end());
  return grid_node(NodeKind::exact, nodes.exact_begin.size() - 1);
}

void GridBuilder::append_subtree(const Nodes& part, NodeCode part_root, const OpenCell& place) {
  Nodes& nodes = nodes_;
  const std::size_t first_block = nodes.blocks.size();
  const std::size_t first_corners = nodes.corners.size();
  const std::size_t first_exact = nodes.exact_begin.size();
  const std::size_t first_entry = nodes.exact_entries.size();
  const auto moved = [&](NodeCode code) {
    const std::uint32_t index = index_of(code);
    switch (kind_of(code)) {
      case NodeKind::block:
        return grid_node(NodeKind::block, first_block + index);
      case NodeKind::interpolated:
        return grid_node(NodeKind::interpolated, first_corners + index);
      case NodeKind::exact:
        return grid_node(NodeKind::exact, first_exact + index);
      default:
        return code;
    }
  };
  for (auto block : part.blocks) {
    std::transform(block.begin(), block.end(), block.begin(), moved);
    nodes.blocks.push_back(block);
  }
  nodes.corners.insert(nodes.corners.end(), part.corners.begin(), part.corners.end());
  for (const std::uint32_t begin : part.exact_begin) {
    nodes.exact_begin.push_back(static_cast<std::uint32_t>(first_entry + begin));
  }
  nodes.exact_entries.insert(nodes.exact_entries.end(), part.exact_entries.begin(),
                             part.exact_entries.end());
  nodes.depth = std::max(nodes.depth, part.depth);
  nodes.undecided_tolerance = std::max(nodes.undecided_tolerance, part.undecided_tolerance);
  set_code(place, moved(part_root));
}

void GridBuilder::set_code(const OpenCell& place, NodeCode code) {
  nodes_.blocks[place.block][place.child] = code;
}

}  // namespace meshgrow
