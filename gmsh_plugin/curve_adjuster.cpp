#include "curve_adjuster.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "gmsh_api.h"
#include "model_reader.h"

namespace meshgrow {

namespace {

/// Rounds of meshing again after which a curve counts as one that does not follow its sizes.
constexpr int most_rounds = 24;

int interval_count(const Entity& curve) {
  int count = 0;
  for (const gmsh::Elements& block : gmsh::elements(curve)) {
    count += static_cast<int>(block.tags.size());
  }
  return count;
}

/// Searches the factor on the sizes of one curve that gives it the wanted number of intervals.
class FactorSearch {
 public:
  /// `count`: as it was meshed by sizes that a factor of 1 gives but for rounding.
  FactorSearch(int wanted, int count) : wanted_(wanted), first_count_(count) { rescale(count); }

  double factor() const { return factor_; }
  int wanted() const { return wanted_; }
  int first_count() const { return first_count_; }
  /// Whether the number changed at all under factors far from 1.
  bool follows() const { return follows_; }

  /// Chooses the next factor after the present one gave `count` intervals.
  void next(int count) {
    follows_ = follows_ || count != first_count_;
    (count > wanted_ ? too_small_ : too_large_) = factor_;
    if (too_small_ > 0.0 && too_large_ > 0.0) {
      factor_ = std::sqrt(too_small_ * too_large_);
    } else {
      rescale(count);
    }
  }

 private:
  /// Gmsh rounds up: a curve of n intervals asks for n − 1/2 on average.
  void rescale(int count) { factor_ *= (count - 0.5) / (wanted_ - 0.5); }

  int wanted_;
  int first_count_;
  double factor_ = 1.0;
  double too_small_ = 0.0;
  double too_large_ = 0.0;
  bool follows_ = false;
};

/// The curves in batches whose curves share no end, so that each end belongs to one factor.
std::vector<std::vector<Entity>> without_common_ends(const std::map<Entity, FactorSearch>& searches,
                                                     const Topology& topology) {
  std::vector<std::vector<Entity>> batches;
  std::vector<std::set<Entity>> ends;
  for (const auto& [curve, search] : searches) {
    const std::vector<Entity>& own = topology.lower(curve);
    std::size_t i = 0;
    while (i < batches.size() && std::any_of(own.begin(), own.end(), [&](const Entity& end) {
             return ends[i].count(end) > 0;
           })) {
      ++i;
    }
    if (i == batches.size()) {
      batches.emplace_back();
      ends.emplace_back();
    }
    batches[i].push_back(curve);
    ends[i].insert(own.begin(), own.end());
  }
  return batches;
}

}  // namespace

CurveAdjuster::CurveAdjuster(const Topology& topology, const MeshConstraints& constraints)
    : topology_(topology), constraints_(constraints) {
  const bool equal_triangles =
      !constraints.mapped_surfaces.empty() && gmsh::option_or("Mesh.TransfiniteTri", 0.0) != 0.0;
  for (const MappedSurface& mapped : constraints_.mapped_surfaces) {
    if (topology.contains(mapped.surface) && !gmsh::has_elements(mapped.surface)) {
      for (OppositeSides& pair : opposite_sides(mapped, topology, equal_triangles)) {
        sides_.push_back(std::move(pair));
      }
    }
  }
}

std::vector<std::vector<Entity>> CurveAdjuster::connected_curves() const {
  std::map<Entity, std::set<Entity>> neighbours;
  for (const OppositeSides& pair : sides_) {
    std::vector<Entity> curves = pair.first;
    curves.insert(curves.end(), pair.second.begin(), pair.second.end());
    for (const Entity& curve : curves) {
      neighbours[curve].insert(curves.begin(), curves.end());
    }
  }
  std::vector<std::vector<Entity>> result;
  std::set<Entity> visited;
  for (const auto& [start, around] : neighbours) {
    std::vector<Entity> open{start};
    std::vector<Entity> connected;
    while (!open.empty()) {
      const Entity curve = open.back();
      open.pop_back();
      if (visited.insert(curve).second) {
        connected.push_back(curve);
        open.insert(open.end(), neighbours[curve].begin(), neighbours[curve].end());
      }
    }
    if (connected.size() > 1) {
      result.push_back(std::move(connected));
    }
  }
  return result;
}

std::map<Entity, CurveIntervals> CurveAdjuster::intervals_now(const std::set<Entity>& stage) const {
  const bool recombination = gmsh::option("Mesh.RecombinationAlgorithm") != 0.0;
  const bool recombine_all = gmsh::option("Mesh.RecombineAll") != 0.0;
  std::set<Entity> beside_recombined;
  for (const Entity& surface : topology_.entities(2)) {
    if (recombination && (recombine_all || constraints_.recombined_surfaces.count(surface) > 0)) {
      const std::vector<Entity>& curves = topology_.lower(surface);
      beside_recombined.insert(curves.begin(), curves.end());
    }
  }
  std::map<Entity, CurveIntervals> result;
  for (const OppositeSides& pair : sides_) {
    for (const std::vector<Entity>* side : {&pair.first, &pair.second, &pair.instead}) {
      for (const Entity& curve : *side) {
        const auto prescribed = constraints_.prescribed_intervals.find(curve);
        const bool is_prescribed = prescribed != constraints_.prescribed_intervals.end();
        const int count = interval_count(curve);
        CurveIntervals intervals;
        // Gmsh gives curves beside recombined surfaces even numbers, but for short ones and where
        // it drops points that are too near; one that is prescribed for an arc, which the .geo text
        // leaves out, shows by not following its sizes.
        intervals.even = !is_prescribed && beside_recombined.count(curve) > 0 && count % 2 == 0;
        intervals.fixed = is_prescribed || (count > 0 && stage.count(curve) == 0);
        intervals.count = count > 0 ? count : is_prescribed ? prescribed->second : 1;
        result[curve] = intervals;
      }
    }
  }
  return result;
}

std::vector<Entity> CurveAdjuster::adjust(const std::vector<Entity>& stage,
                                          const MeshAgain& mesh_again) const {
  const std::set<Entity> stage_set(stage.begin(), stage.end());
  std::map<Entity, CurveIntervals> intervals = intervals_now(stage_set);
  std::set<Entity> meshed_again;
  // Each round ends with all numbers as wanted, or with a curve known not to follow.
  while (true) {
    const std::map<Entity, int> wanted = match_intervals(sides_, intervals);
    std::map<Entity, FactorSearch> searches;
    std::map<Entity, SizeAnswers::Scale> scales;
    for (const auto& [curve, count] : wanted) {
      const int present = interval_count(curve);
      if (stage_set.count(curve) > 0 && present > 0 && present != count) {
        searches.emplace(curve, FactorSearch(count, present));
        scales[curve].mesh =
            read_entity_mesh(curve, NodeCoordinates(topology_.closure({curve}))).segments;
      }
    }
    for (int round = 0; round < most_rounds && !searches.empty(); ++round) {
      for (const std::vector<Entity>& curves : without_common_ends(searches, topology_)) {
        std::map<Entity, SizeAnswers::Scale> present;
        for (const Entity& curve : curves) {
          present[curve] = scales[curve];
          present[curve].factor = searches.at(curve).factor();
          // In Gmsh 4.8 the ends alone tell the size there.
          for (const Entity& end : topology_.lower(curve)) {
            present[end] = present[curve];
          }
        }
        mesh_again(curves, std::move(present));
        meshed_again.insert(curves.begin(), curves.end());
      }
      for (auto entry = searches.begin(); entry != searches.end();) {
        const int count = interval_count(entry->first);
        if (count == entry->second.wanted()) {
          entry = searches.erase(entry);
        } else {
          entry->second.next(count);
          ++entry;
        }
      }
    }
    if (searches.empty()) {
      return {meshed_again.begin(), meshed_again.end()};
    }
    for (const auto& [curve, search] : searches) {
      // Sizes do not rule this curve, or rule it in steps of two.
      CurveIntervals& known = intervals[curve];
      if (search.follows() && !known.even) {
        known.even = true;
      } else {
        known.fixed = true;
        known.count = interval_count(curve);
      }
    }
  }
}

}  // namespace meshgrow
