#include "cell_classifier.h"

#include <algorithm>
#include <cfloat>
#include <cmath>

namespace meshgrow {

namespace {

/// Taken off where float has to prove something: rounding of sizes and of tangent planes.
constexpr double rounding = 4e-6;

/// Nodes longer than so many edges of the cell are replaced by their children.
constexpr double open_edges = 1.0;

/// Of what a cell hands its children; if there are more, it hands on what it has itself.
constexpr int max_entries = 2048;

/// Below this depth exact leaves may keep more and more facets: hundreds in the same place would
/// ask for cells beyond number.
constexpr int deep = 10;

/// Of an exact leaf.
constexpr int max_leaf_entries = 32;

constexpr std::size_t known_sizes = 1 << 14;
constexpr int known_sizes_shift = 64 - 14;

constexpr int lattice_centre = 13;

/// Places of a lattice that are neither its centre nor a corner of the cell.
constexpr std::array<int, 18> between_corners = {1,  3,  4,  5,  7,  9,  10, 11, 12,
                                                 14, 15, 16, 17, 19, 21, 22, 23, 25};

/// Never 0: what is infinitely large, times 0, is no number. Sizes so large are above those of all
/// facets, in units of the tree, by far.
float as_reciprocal(double size) {
  return static_cast<float>(
      std::clamp(1.0 / size, static_cast<double>(FLT_MIN), static_cast<double>(FLT_MAX)));
}

}  // namespace

CellClassifier::CellClassifier(const FacetTree& tree, const GridCube& cube, double size_limit,
                               double tolerance, std::size_t facets_per_exact_leaf)
    : tree_(tree),
      cube_(cube),
      size_limit_(size_limit),
      tolerance_(tolerance),
      facets_per_exact_leaf_(facets_per_exact_leaf),
      known_(known_sizes) {}

CellClassifier::Verdict CellClassifier::classify(const GridCell& cell,
                                                 const FacetTree::Smallest& ruling,
                                                 const CellCandidates& candidates) {
  candidates_ = &candidates;
  ruling_ = ruling;
  entries_known_ = false;
  scale_ = 1.0;
  if (bounded_by_lipschitz(cell)) {
    return Verdict::interpolate;
  }
  kernel_cell_.half_edge = static_cast<float>(cell.half_edge(cube_) / tree_.unit());
  const Vec3 place = (cell.centre(cube_) - tree_.centre()) / tree_.unit();
  std::copy(place.data(), place.data() + 3, kernel_cell_.centre);
  find_ruling_corners();
  if (never_too_coarse(cell) && not_much_too_fine(cell)) {
    return Verdict::interpolate;
  }
  return few_facets_suffice(cell) ? Verdict::keep_facets : Verdict::split;
}

FacetTree::Smallest CellClassifier::smallest(const Vec3& p) const {
  return tree_.smallest(p, FacetTree::Entries(), {size_limit_, FacetTree::Smallest::no_facet});
}

/// A good guess to begin a search with: the facet that rules at the cell's centre.
FacetTree::Smallest CellClassifier::known_at(const Vec3& p) const {
  if (ruling_.facet != FacetTree::Smallest::no_facet) {
    const double size = tree_.facets()[ruling_.facet].size_at(p);
    if (size < size_limit_) {
      return {size, ruling_.facet};
    }
  }
  return {size_limit_, FacetTree::Smallest::no_facet};
}

bool CellClassifier::bounded_by_lipschitz(const GridCell& cell) const {
  const double change = std::sqrt(3.0) * cell.half_edge(cube_) * tree_.largest_slope();
  return change <= tolerance_ * (ruling_.size - change);
}

bool CellClassifier::never_too_coarse(const GridCell& cell) {
  simd::LeastRatio query;
  query.cell = kernel_cell_;
  for (int i = 0; i < 8; ++i) {
    query.cell.reciprocals[i] = as_reciprocal(cell.corner_values[i] / tree_.unit());
  }
  const double kept = 1.0 / (1.0 + tolerance_);
  query.ratio = static_cast<float>(kept);
  query.enough = static_cast<float>(kept * kept);
  const CellCandidates& entries = *candidates_;
  simd::tree_kernels().least_ratio(tree_.view(), entries.data(), static_cast<int>(entries.size()),
                                   query);
  if (query.ratio < static_cast<float>(kept)) {
    scale_ = query.ratio * (1.0 + tolerance_) * (1.0 - rounding);
  }
  return query.ratio >= query.enough;
}

bool CellClassifier::not_much_too_fine(const GridCell& cell) {
  // One of the two at all corners: the smaller one of both is not convex.
  bool proven_by_ruling = true;
  bool proven_by_limit = true;
  for (int i = 0; i < 8; ++i) {
    const double enough = (1.0 + 2.0 * tolerance_) * scale_ * cell.corner_values[i];
    proven_by_ruling = proven_by_ruling && ruling_corners_[i] <= enough;
    proven_by_limit = proven_by_limit && size_limit_ <= enough;
  }
  const bool proven = proven_by_ruling || proven_by_limit;
  if (proven || cell.depth == max_grid_depth) {
    return proven;
  }
  const auto fine_enough = [&](double exact, int i) {
    const double interpolated =
        trilinear(cell.corner_values, 0.5 * (i % 3), 0.5 * (i / 3 % 3), 0.5 * (i / 9));
    return (1.0 - tolerance_) * exact <= scale_ * interpolated;
  };
  if (!fine_enough(ruling_.size, lattice_centre)) {
    return false;
  }
  // What the facet that rules at the centre allows is allowed all the more by the field.
  std::array<int, between_corners.size()> doubtful;
  int doubtful_count = 0;
  for (const int i : between_corners) {
    if (!fine_enough(ruling_size(lattice_place(cell, i)), i)) {
      doubtful[doubtful_count++] = i;
    }
  }
  find_lattice_sizes(cell, doubtful.data(), doubtful_count);
  return std::all_of(doubtful.begin(), doubtful.begin() + doubtful_count,
                     [&](int i) { return fine_enough(split_.lattice[i], i); });
}

void CellClassifier::find_ruling_corners() {
  ruling_corners_.fill(size_limit_);
  if (ruling_.facet == FacetTree::Smallest::no_facet) {
    return;
  }
  alignas(32) std::array<float, 8> sizes;
  simd::tree_kernels().corner_sizes(tree_.block_of(ruling_.facet),
                                    static_cast<int>(ruling_.facet % simd::lanes), kernel_cell_,
                                    sizes.data());
  for (int i = 0; i < 8; ++i) {
    ruling_corners_[i] = sizes[i] * tree_.unit();
  }
}

double CellClassifier::ruling_size(const LatticePlace& place) const {
  return known_at(cube_.at(place)).size;
}

bool CellClassifier::few_facets_suffice(const GridCell& cell) {
  leaf_entries_.clear();
  if (facets_per_exact_leaf_ == 0) {
    return false;
  }
  leaf_entries_.resize(max_leaf_entries);
  simd::Survivors query = survivors_below(1.0 / (1.0 + tolerance_), leaf_entries_);
  query.open_edge = 0.0f;
  query.open_blocks = true;
  query.most_facets = static_cast<std::uint32_t>(facets_per_exact_leaf_)
                      << std::clamp(cell.depth - deep, 0, 8);
  if (!collect(query, leaf_entries_)) {
    return false;
  }
  // The others are only good enough beside the facet that rules at the centre, which may not need
  // to be there by the same measure.
  if (ruling_.facet != FacetTree::Smallest::no_facet) {
    const simd::NodeEntry own = tree_.entry_of(ruling_.facet);
    const auto same_node =
        std::find_if(leaf_entries_.begin(), leaf_entries_.end(),
                     [own](simd::NodeEntry entry) { return entry >> 8 == own >> 8; });
    if (same_node == leaf_entries_.end()) {
      leaf_entries_.push_back(own);
    } else {
      *same_node |= own;
    }
  }
  return true;
}

void CellClassifier::find_ruling_entries(const GridCell& cell) {
  if (entries_known_) {
    return;
  }
  entries_known_ = true;
  CellCandidates& kept = split_.candidates;
  kept.resize(max_entries);
  simd::Survivors query = survivors_below(1.0 + rounding, kept);
  query.open_edge = static_cast<float>(open_edges * 2.0 * cell.half_edge(cube_) / tree_.unit());
  query.open_blocks = false;
  query.most_facets = ~0u;
  if (!collect(query, kept)) {
    kept = *candidates_;
  }
}

/// Of what may be below the sizes that the ruling facet gives, times `factor`; there is room for as
/// many entries as `room` has.
simd::Survivors CellClassifier::survivors_below(double factor,
                                                std::vector<simd::NodeEntry>& room) const {
  simd::Survivors query;
  query.cell = kernel_cell_;
  double largest = 0.0;
  for (int i = 0; i < 8; ++i) {
    const double size = ruling_corners_[i] * factor / tree_.unit();
    query.cell.reciprocals[i] = as_reciprocal(size);
    largest = std::max(largest, size);
  }
  largest = std::min(largest, size_limit_ * factor / tree_.unit());
  query.largest = static_cast<float>(largest * (1.0 + rounding));
  query.entries = room.data();
  query.capacity = static_cast<int>(room.size());
  return query;
}

/// Fills the room that the query was made with; false if there are too many.
bool CellClassifier::collect(simd::Survivors& query, std::vector<simd::NodeEntry>& entries) const {
  if (!simd::tree_kernels().survivors(tree_.view(), candidates_->data(),
                                      static_cast<int>(candidates_->size()), query)) {
    return false;
  }
  entries.resize(static_cast<std::size_t>(query.count));
  return true;
}

/// Asks for what is not known yet all at once.
void CellClassifier::find_lattice_sizes(const GridCell& cell, const int* points, int count) {
  std::array<int, 27> asked;
  std::array<Vec3, 27> places;
  std::array<FacetTree::Smallest, 27> found;
  std::size_t asked_count = 0;
  for (int k = 0; k < count; ++k) {
    const LatticePlace place = lattice_place(cell, points[k]);
    const Known& known = known_size(place);
    if (known.key == place.key()) {
      split_.lattice[points[k]] = known.size;
    } else {
      places[asked_count] = cube_.at(place);
      found[asked_count] = known_at(places[asked_count]);
      asked[asked_count++] = points[k];
    }
  }
  if (asked_count == 0) {
    return;
  }
  find_ruling_entries(cell);
  tree_.smallest(
      places.data(), asked_count, [this](std::size_t) { return children_entries(); }, found.data());
  for (std::size_t k = 0; k < asked_count; ++k) {
    split_.lattice[asked[k]] = found[k].size;
    const LatticePlace place = lattice_place(cell, asked[k]);
    known_size(place) = {place.key(), found[k].size};
  }
}

CellClassifier::Known& CellClassifier::known_size(const LatticePlace& place) {
  return known_[(place.key() * 0x9E3779B97F4A7C15ull) >> known_sizes_shift];
}

const CellClassifier::Split& CellClassifier::split(const GridCell& cell) {
  find_ruling_entries(cell);
  find_lattice_sizes(cell, between_corners.data(), static_cast<int>(between_corners.size()));
  split_.lattice[lattice_centre] = ruling_.size;
  for (int corner = 0; corner < 8; ++corner) {
    split_.lattice[lattice_index_of_corner(corner)] = cell.corner_values[corner];
  }
  std::array<Vec3, 8> centres;
  for (int child = 0; child < 8; ++child) {
    centres[child] = child_cell(cell, child, split_.lattice).centre(cube_);
    split_.ruling[child] = known_at(centres[child]);
  }
  tree_.smallest(
      centres.data(), 8, [this](std::size_t) { return children_entries(); }, split_.ruling.data());
  return split_;
}

}  // namespace meshgrow
