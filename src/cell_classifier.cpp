#include "cell_classifier.h"

#include <algorithm>
#include <cmath>

namespace meshgrow {

namespace {

/// Up to so many facets it is cheaper to look at the tangent plane of each than to descend the
/// tree.
constexpr std::size_t direct_evaluation_limit = 2048;

/// Below this distance the direction to a facet is mostly rounding, of the cell's size or, far from
/// the origin, of the coordinates themselves.
double smallest_direction(const GridCell& cell) {
  return std::max(1e-6 * cell.half_edge, 1e-9 * cell.centre.cwiseAbs().maxCoeff());
}

}  // namespace

CellClassifier::CellClassifier(const FacetTree& tree, double size_limit, double tolerance,
                               std::size_t facets_per_exact_leaf)
    : tree_(tree),
      size_limit_(size_limit),
      tolerance_(tolerance),
      facets_per_exact_leaf_(facets_per_exact_leaf) {}

CellClassifier::Verdict CellClassifier::classify(const GridCell& cell,
                                                 const std::vector<std::uint32_t>& candidates) {
  lattice_known_ = false;
  compute_tangents(cell, candidates);
  drop_never_ruling(candidates);
  if (bounded_by_lipschitz(cell)) {
    return Verdict::interpolate;
  }
  if (never_too_coarse(cell) && not_much_too_fine(cell)) {
    return Verdict::interpolate;
  }
  return few_facets_suffice() ? Verdict::keep_facets : Verdict::split;
}

void CellClassifier::compute_tangents(const GridCell& cell,
                                      const std::vector<std::uint32_t>& candidates) {
  const SizedFacets& facets = tree_.facets();
  tangents_.resize(candidates.size());
  best_ = -1;
  const double too_near = smallest_direction(cell);
  double best_size = size_limit_;
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    const SizedFacet& facet = facets[candidates[k]];
    const Vec3 away = cell.centre - closest_point(facet.facet, cell.centre);
    const double distance = away.norm();
    const double size = facet.start_size + facet.slope * distance;
    if (distance > too_near) {
      tangents_[k] = {size, (facet.slope * cell.half_edge / distance) * away};
    } else {
      tangents_[k] = {facet.start_size, Vec3::Zero()};  // no direction, but a bound all the same
    }
    if (size < best_size) {
      best_size = size;
      best_ = static_cast<std::int64_t>(k);
    }
  }
  for (int i = 0; i < 8; ++i) {
    best_corners_[i] = best_ < 0 ? size_limit_ : facets[candidates[best_]].size_at(cell.corner(i));
  }
}

void CellClassifier::drop_never_ruling(const std::vector<std::uint32_t>& candidates) {
  ruling_.clear();
  ruling_tangents_.clear();
  const double highest = *std::max_element(best_corners_.begin(), best_corners_.end());
  const std::int64_t best_candidate = best_;
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    const Tangent& tangent = tangents_[k];
    if (static_cast<std::int64_t>(k) != best_candidate) {
      const double start_size = tree_.facets()[candidates[k]].start_size;
      bool never_rules = std::max(start_size, tangent.smallest()) >= highest;
      for (int i = 0; i < 8 && !never_rules; ++i) {
        if (tangent.at_corner(i) < best_corners_[i]) {
          break;
        }
        never_rules = i == 7;
      }
      if (never_rules) {
        continue;
      }
    } else {
      best_ = static_cast<std::int64_t>(ruling_.size());
    }
    ruling_.push_back(candidates[k]);
    ruling_tangents_.push_back(tangent);
  }
}

bool CellClassifier::bounded_by_lipschitz(const GridCell& cell) const {
  double steepest = 0.0;
  double smallest = size_limit_;
  for (std::size_t k = 0; k < ruling_.size(); ++k) {
    const SizedFacet& facet = tree_.facets()[ruling_[k]];
    steepest = std::max(steepest, facet.slope);
    smallest = std::min(smallest, std::max(facet.start_size, ruling_tangents_[k].smallest()));
  }
  return std::sqrt(3.0) * cell.half_edge * steepest <= tolerance_ * smallest;
}

bool CellClassifier::never_too_coarse(const GridCell& cell) const {
  for (const Tangent& tangent : ruling_tangents_) {
    for (int i = 0; i < 8; ++i) {
      if ((1.0 + tolerance_) * tangent.at_corner(i) < cell.corner_values[i]) {
        return false;
      }
    }
  }
  return true;
}

bool CellClassifier::not_much_too_fine(const GridCell& cell) {
  bool proven = true;
  for (int i = 0; i < 8; ++i) {
    proven = proven && best_corners_[i] <= (1.0 + tolerance_) * cell.corner_values[i];
  }
  if (proven) {
    return true;
  }
  const Lattice& exact = lattice(cell);
  for (int i = 0; i < 27; ++i) {
    const double interpolated =
        trilinear(cell.corner_values, 0.5 * (i % 3), 0.5 * (i / 3 % 3), 0.5 * (i / 9));
    if (exact[i] > (1.0 + tolerance_) * interpolated) {
      return false;
    }
  }
  return true;
}

bool CellClassifier::few_facets_suffice() {
  leaf_facets_.clear();
  for (std::size_t k = 0; k < ruling_.size(); ++k) {
    bool needed = static_cast<std::int64_t>(k) == best_;
    for (int i = 0; i < 8 && !needed; ++i) {
      needed = (1.0 + tolerance_) * ruling_tangents_[k].at_corner(i) < best_corners_[i];
    }
    if (needed) {
      if (leaf_facets_.size() == facets_per_exact_leaf_) {
        return false;
      }
      leaf_facets_.push_back(ruling_[k]);
    }
  }
  return true;
}

double CellClassifier::size_by_ruling_facets(const Vec3& p, const Vec3& local) const {
  double size = size_limit_;
  const auto ask = [&](std::size_t k) {
    size = std::min(size, tree_.facets()[ruling_[k]].size_at(p));
  };
  if (best_ >= 0) {
    ask(static_cast<std::size_t>(best_));
  }
  for (std::size_t k = 0; k < ruling_.size(); ++k) {
    const Tangent& tangent = ruling_tangents_[k];
    if (tangent.at_centre + tangent.slope_times_half_edge.dot(local) < size) {
      ask(k);
    }
  }
  return size;
}

const Lattice& CellClassifier::lattice(const GridCell& cell) {
  if (lattice_known_) {
    return lattice_;
  }
  const bool direct = ruling_.size() <= direct_evaluation_limit;
  for (int i = 0; i < 27; ++i) {
    if (i % 3 == 1 || i / 3 % 3 == 1 || i / 9 == 1) {
      const Vec3 p = lattice_point(cell, i);
      lattice_[i] = direct ? size_by_ruling_facets(p, Vec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1))
                           : tree_.size(p, size_limit_);
    }
  }
  for (int corner = 0; corner < 8; ++corner) {
    lattice_[lattice_index_of_corner(corner)] = cell.corner_values[corner];
  }
  lattice_known_ = true;
  return lattice_;
}

}  // namespace meshgrow
