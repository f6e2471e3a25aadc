#include "start_sizes/wall_meetings.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "node_numbers.h"

namespace meshgrow {

namespace {

using Nodes = std::array<std::uint32_t, 3>;  ///< of a wall; the last one repeated for a segment

std::vector<Nodes> number_nodes(const std::vector<Wall>& walls) {
  NodeNumbers numbers;
  std::vector<Nodes> nodes;
  nodes.reserve(walls.size());
  for (const Wall& wall : walls) {
    const auto& [a, b, c] = wall.facet.corners;
    const std::uint32_t first = numbers.of(a);
    const std::uint32_t second = numbers.of(b);
    nodes.push_back({first, second, wall.facet.corner_count == 3 ? numbers.of(c) : second});
  }
  return nodes;
}

/// A node, or a side, of a wall.
struct Part {
  NodePair nodes;
  std::uint32_t wall;

  friend bool operator<(const Part& a, const Part& b) {
    return std::tie(a.nodes, a.wall) < std::tie(b.nodes, b.wall);
  }
};

/// Calls visit(first, last) for the parts of each place, which must be sorted.
template <typename Visit>
void for_each_place(const std::vector<Part>& parts, Visit visit) {
  for (auto first = parts.begin(); first != parts.end();) {
    const auto last = std::find_if(first, parts.end(),
                                   [&](const Part& part) { return part.nodes != first->nodes; });
    visit(first, last);
    first = last;
  }
}

std::vector<Part> nodes_of(const std::vector<Wall>& walls, const std::vector<Nodes>& nodes) {
  std::vector<Part> parts;
  for (std::uint32_t wall = 0; wall < walls.size(); ++wall) {
    for (int i = 0; i < walls[wall].facet.corner_count; ++i) {
      parts.push_back({{nodes[wall][i], nodes[wall][i]}, wall});
    }
  }
  std::sort(parts.begin(), parts.end());
  return parts;
}

/// Sides across which a patch goes on: of a triangle its sides, of a segment its ends.
std::vector<Part> links_of(const std::vector<Wall>& walls, const std::vector<Nodes>& nodes) {
  if (walls.front().facet.corner_count == 2) {
    return nodes_of(walls, nodes);
  }
  std::vector<Part> parts;
  for (std::uint32_t wall = 0; wall < walls.size(); ++wall) {
    for (int i = 0; i < 3; ++i) {
      parts.push_back({node_pair(nodes[wall][i], nodes[wall][(i + 1) % 3]), wall});
    }
  }
  std::sort(parts.begin(), parts.end());
  return parts;
}

/// Whether some part of the wall lies in front of the other.
bool in_front(const Wall& wall, const Wall& other, const Vec3& common) {
  double height = 0.0;
  double size = 0.0;
  for (const Vec3& corner : wall.facet.corners) {
    height = std::max(height, other.inward.dot(corner - common));
    size = std::max(size, (corner - common).norm());
  }
  return height > 1e-6 * size;
}

bool region_is_between(const Wall& a, const Wall& b, const Vec3& common) {
  return in_front(a, b, common) && in_front(b, a, common);
}

/// What a wall shares with another that it has a node in common with: a side or this node.
NodePair shared_part(const Nodes& a, const Nodes& b, std::uint32_t node) {
  for (const std::uint32_t other : a) {
    if (other != node && std::find(b.begin(), b.end(), other) != b.end()) {
      return node_pair(node, other);
    }
  }
  return {node, node};
}

struct MeetingWalls {
  NodePair place;
  std::array<std::uint32_t, 2> walls;
};

std::vector<MeetingWalls> meeting_walls(const std::vector<Wall>& walls,
                                        const std::vector<Nodes>& nodes) {
  std::vector<MeetingWalls> result;
  for_each_place(nodes_of(walls, nodes), [&](auto first, auto last) {
    const std::uint32_t node = first->nodes[0];
    const auto& corners = walls[first->wall].facet.corners;
    const auto& of_wall = nodes[first->wall];
    const Vec3 common = corners[std::find(of_wall.begin(), of_wall.end(), node) - of_wall.begin()];
    for (auto a = first; a != last; ++a) {
      for (auto b = std::next(a); b != last; ++b) {
        if (normals_oppose(walls[a->wall].inward, walls[b->wall].inward) &&
            region_is_between(walls[a->wall], walls[b->wall], common)) {
          const NodePair place = shared_part(nodes[a->wall], nodes[b->wall], node);
          result.push_back({place, {a->wall, b->wall}});
        }
      }
    }
  });
  return result;
}

/// Union-find.
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }

  std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i) {
      i = parent_[i] = parent_[parent_[i]];
    }
    return i;
  }

  void unite(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t root_a = root(a);
    const std::uint32_t root_b = root(b);
    parent_[std::max(root_a, root_b)] = std::min(root_a, root_b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

std::vector<std::uint32_t> smooth_patches(const std::vector<Wall>& walls,
                                          const std::vector<Nodes>& nodes) {
  Sets sets(walls.size());
  for_each_place(links_of(walls, nodes), [&](auto first, auto last) {
    for (auto a = first; a != last; ++a) {
      for (auto b = std::next(a); b != last; ++b) {
        if (walls[a->wall].inward.dot(walls[b->wall].inward) >= cosine_of_opposing) {
          sets.unite(a->wall, b->wall);
        }
      }
    }
  });
  std::vector<std::uint32_t> patches;
  patches.reserve(walls.size());
  for (std::uint32_t wall = 0; wall < walls.size(); ++wall) {
    patches.push_back(sets.root(wall));
  }
  return patches;
}

}  // namespace

WallMeetings::WallMeetings(const std::vector<Wall>& walls) : places_(SizedFacets()) {
  if (walls.empty()) {
    return;
  }
  const std::vector<Nodes> nodes = number_nodes(walls);
  const std::vector<MeetingWalls> meetings = meeting_walls(walls, nodes);
  if (meetings.empty()) {
    return;
  }
  patch_of_ = smooth_patches(walls, nodes);
  std::map<std::pair<NodePair, std::array<std::uint32_t, 2>>, std::uint32_t> different;
  for (const MeetingWalls& meeting : meetings) {
    const auto [a, b] = meeting.walls;
    const auto patches = std::minmax(patch_of_[a], patch_of_[b]);
    different.insert({{meeting.place, {patches.first, patches.second}}, a});
  }
  SizedFacets places;
  std::vector<std::array<std::uint32_t, 2>> patches_at;
  for (const auto& [place, wall] : different) {
    const auto corner = [&, of_wall = wall](std::uint32_t node) {
      const auto i = std::find(nodes[of_wall].begin(), nodes[of_wall].end(), node);
      return walls[of_wall].facet.corners[i - nodes[of_wall].begin()];
    };
    places.push_back({Facet::segment(corner(place.first[0]), corner(place.first[1])), 0.0, 1.0});
    patches_at.push_back(place.second);
  }
  places_ = FacetTree(std::move(places));
  for (std::size_t i = 0; i < patches_at.size(); ++i) {
    patches_at_.push_back(patches_at[places_.original_index(i)]);
  }
}

std::vector<WallMeetings::Meeting> WallMeetings::near(std::size_t wall, const Vec3& p,
                                                      double within) const {
  std::vector<Meeting> found;
  if (empty()) {
    return found;
  }
  const std::uint32_t patch = patch_of_[wall];
  const auto other = [&](std::uint32_t place) {
    const auto& [a, b] = patches_at_[place];
    return a == patch ? b : a;
  };
  const auto is_new = [&](std::uint32_t place) {
    const auto& [a, b] = patches_at_[place];
    return (a == patch || b == patch) &&
           std::none_of(found.begin(), found.end(),
                        [&](const Meeting& meeting) { return meeting.patch == other(place); });
  };
  const StoredArray<SizedFacet>& places = places_.facets();
  for (;;) {
    const FacetTree::Closest closest = places_.closest_facet(p, within, [&](std::uint32_t i) {
      return is_new(i) ? distance(places[i].facet, p) : FacetTree::infinity;
    });
    if (closest.facet == places.size()) {
      return found;
    }
    found.push_back(
        {other(static_cast<std::uint32_t>(closest.facet)), places[closest.facet].facet});
  }
}

}  // namespace meshgrow
