#include "mapped_surface.h"

#include <algorithm>
#include <optional>

namespace meshgrow {

namespace {

using Side = std::vector<Entity>;

std::set<int> ends(const Entity& curve, const Topology& topology) {
  std::set<int> result;
  for (const Entity& point : topology.lower(curve)) {
    result.insert(point.tag);
  }
  return result;
}

std::optional<int> shared_end(const Entity& a, const Entity& b, const Topology& topology) {
  const std::set<int> of_a = ends(a, topology);
  for (const int point : ends(b, topology)) {
    if (of_a.count(point) > 0) {
      return point;
    }
  }
  return std::nullopt;
}

/// The curves in a row, each with the point where it begins; empty if they make no single loop or
/// pass a point twice.
struct Loop {
  std::vector<Entity> curves;
  std::vector<int> begins;
};

Loop chain(std::vector<Entity> curves, const Topology& topology) {
  Loop loop;
  if (curves.size() < 3) {
    return loop;
  }
  // From the first curve on, each time the next one in Gmsh's order that fits.
  const std::set<int> first_ends = ends(curves[0], topology);
  const std::optional<int> to_last = shared_end(curves[0], curves.back(), topology);
  const int start = to_last ? *to_last : *first_ends.begin();
  int at = start;
  Entity current = curves[0];
  curves.erase(curves.begin());
  while (true) {
    loop.curves.push_back(current);
    loop.begins.push_back(at);
    std::set<int> other = ends(current, topology);
    if (other.size() == 2) {
      other.erase(at);
    }
    at = *other.begin();
    const auto next = std::find_if(curves.begin(), curves.end(), [&](const Entity& curve) {
      return ends(curve, topology).count(at) > 0;
    });
    if (next == curves.end()) {
      break;
    }
    current = *next;
    curves.erase(next);
  }
  const bool is_simple =
      std::set<int>(loop.begins.begin(), loop.begins.end()).size() == loop.begins.size();
  return curves.empty() && at == start && is_simple ? loop : Loop();
}

std::vector<Side> split_at_corners(const Loop& loop, const std::vector<int>& corners) {
  const auto first = std::find(loop.begins.begin(), loop.begins.end(), corners.front());
  if (first == loop.begins.end()) {
    return {};
  }
  const auto offset = static_cast<std::size_t>(first - loop.begins.begin());
  std::vector<Side> sides;
  for (std::size_t i = 0; i < loop.curves.size(); ++i) {
    const std::size_t at = (offset + i) % loop.curves.size();
    if (std::count(corners.begin(), corners.end(), loop.begins[at]) > 0) {
      sides.emplace_back();
    }
    sides.back().push_back(loop.curves[at]);
  }
  return sides.size() == corners.size() ? sides : std::vector<Side>();
}

}  // namespace

bool has_no_length(const Entity& curve, const Topology& topology) {
  const Box& box = topology.box(curve);
  const std::set<int> own_ends = ends(curve, topology);
  if (own_ends.size() != 1 || box.isEmpty()) {
    return false;
  }
  // Of the end, too: the box of the pole of a stretched sphere is where it was before stretching.
  const Box& end = topology.box({0, *own_ends.begin()});
  const double reach = std::max(box.max().norm(), end.isEmpty() ? 0.0 : end.max().norm());
  // Gmsh's boxes are a tolerance of about 1e-7 larger than the entity, times the stretching.
  return box.diagonal().norm() < 1e-6 * (1.0 + reach);
}

std::vector<OppositeSides> opposite_sides(const MappedSurface& mapped, const Topology& topology,
                                          bool equal_triangles) {
  std::vector<Entity> curves;
  std::copy_if(mapped.boundary.begin(), mapped.boundary.end(), std::back_inserter(curves),
               [&](const Entity& curve) { return !has_no_length(curve, topology); });
  std::vector<Side> sides;
  const Loop loop = chain(curves, topology);
  if (!mapped.corners.empty() && !loop.curves.empty()) {
    sides = split_at_corners(loop, mapped.corners);
  } else if (mapped.corners.empty() && loop.curves.size() <= 4) {
    for (const Entity& curve : loop.curves) {
      sides.push_back({curve});
    }
  }
  if (sides.size() == 4) {
    return {{mapped.surface, sides[0], sides[2]}, {mapped.surface, sides[1], sides[3]}};
  }
  if (sides.size() == 3) {
    // Gmsh takes the next corner where it was told none and the first does not do.
    std::vector<OppositeSides> result{
        {mapped.surface, sides[0], sides[2], mapped.corners.empty() ? sides[1] : Side()}};
    if (equal_triangles) {
      result.push_back({mapped.surface, sides[0], sides[1]});
    }
    return result;
  }
  return {};
}

}  // namespace meshgrow
