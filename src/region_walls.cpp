#include "region_walls.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <random>
#include <tuple>
#include <utility>

#include "facet_tree.h"
#include "node_numbers.h"

namespace meshgrow {

namespace {

/// A triangle of a face, with the normal of its corners' order.
struct FaceFacet {
  Facet facet;
  Vec3 normal;
  double area = 0.0;  ///< 0, exactly, where the normal means nothing
  Entity face;
  std::array<std::uint32_t, 3> nodes;
};

std::vector<Facet> triangles_of(const FacetedSource& face) {
  std::vector<Facet> triangles;
  for (const auto& [a, b, c] : face.triangles) {
    triangles.push_back(Facet::triangle(a, b, c));
  }
  for (const auto& quad : face.quads) {
    for (const Facet& half : split_quad(quad)) {
      triangles.push_back(half);
    }
  }
  return triangles;
}

/// Appends the facets of a face. Those without area stay, as they hold others together, unless they
/// are a side or a corner only.
void append_facets(const FacetedSource& face, NodeNumbers& numbers,
                   std::vector<FaceFacet>& facets) {
  for (const Facet& facet : triangles_of(face)) {
    const auto& [a, b, c] = facet.corners;
    if (!a.allFinite() || !b.allFinite() || !c.allFinite() || a == b || b == c || c == a) {
      continue;
    }
    const double longest2 =
        std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    const Vec3 doubled = (b - a).cross(c - a);
    const bool has_area = doubled.norm() > 1e-14 * longest2;
    facets.push_back({facet,
                      doubled.normalized(),
                      has_area ? 0.5 * doubled.norm() : 0.0,
                      face.entity,
                      {numbers.of(a), numbers.of(b), numbers.of(c)}});
  }
}

// ==== Orientation within a face

/// A side of a facet; `forward` if the facet runs along it from the smaller node number.
struct Side {
  NodePair nodes;
  std::uint32_t facet;
  bool forward;
};

std::vector<Side> sorted_sides(const std::vector<FaceFacet>& facets, std::uint32_t first,
                               std::uint32_t last) {
  std::vector<Side> sides;
  sides.reserve(3 * static_cast<std::size_t>(last - first));
  for (std::uint32_t i = first; i < last; ++i) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = facets[i].nodes[k];
      const std::uint32_t b = facets[i].nodes[(k + 1) % 3];
      sides.push_back({node_pair(a, b), i, a < b});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.nodes, a.facet) < std::tie(b.nodes, b.facet);
  });
  return sides;
}

/// Calls visit(first, last) for the sides with the same ends.
template <typename Visit>
void for_each_shared_side(const std::vector<Side>& sides, Visit visit) {
  for (auto first = sides.begin(); first != sides.end();) {
    const auto last =
        std::find_if(first, sides.end(), [&](const Side& s) { return s.nodes != first->nodes; });
    visit(first, last);
    first = last;
  }
}

struct Neighbour {
  std::uint32_t facet;
  bool turned;  ///< its corners run the other way round
};

/// Facets of one face that hang together through sides, with the sign that turns their normals to
/// the same side.
struct Sheet {
  std::vector<std::pair<std::uint32_t, double>> facets;
  bool two_sided = true;  ///< false for a Moebius strip and where more than two facets share a side
};

/// The sheets of the face with the facets [first, last).
class SheetFinder {
 public:
  SheetFinder(const std::vector<FaceFacet>& facets, std::uint32_t first, std::uint32_t last)
      : first_(first), neighbours_(last - first), branching_(last - first), sign_(last - first) {
    for_each_shared_side(sorted_sides(facets, first, last), [this](auto begin, auto end) {
      for (auto a = begin; a != end; ++a) {
        branching_[a->facet - first_] = branching_[a->facet - first_] || end - begin > 2;
        for (auto b = begin; b != end; ++b) {
          if (a != b) {
            neighbours_[a->facet - first_].push_back({b->facet, a->forward == b->forward});
          }
        }
      }
    });
  }

  std::vector<Sheet> sheets() {
    std::vector<Sheet> result;
    for (std::uint32_t i = 0; i < sign_.size(); ++i) {
      if (sign_[i] == 0.0) {
        result.push_back(sheet_from(i));
      }
    }
    return result;
  }

 private:
  Sheet sheet_from(std::uint32_t start) {
    Sheet sheet;
    sign_[start] = 1.0;
    sheet.facets.emplace_back(first_ + start, 1.0);
    for (std::size_t next = 0; next < sheet.facets.size(); ++next) {
      const auto [facet, sign] = sheet.facets[next];
      sheet.two_sided = sheet.two_sided && !branching_[facet - first_];
      for (const Neighbour& neighbour : neighbours_[facet - first_]) {
        const double wanted = neighbour.turned ? -sign : sign;
        double& known = sign_[neighbour.facet - first_];
        if (known == 0.0) {
          known = wanted;
          sheet.facets.emplace_back(neighbour.facet, wanted);
        }
        sheet.two_sided = sheet.two_sided && known == wanted;
      }
    }
    return sheet;
  }

  std::uint32_t first_;
  std::vector<std::vector<Neighbour>> neighbours_;
  std::vector<bool> branching_;
  std::vector<double> sign_;  ///< 0: not yet reached
};

// ==== Inside and outside

/// The facets that enclose something: those left when facets with a side of their own are taken
/// away, again and again. So an embedded face, which does not tell inside from outside, is not
/// counted. All facets where nothing would be left: the faces do not fit together then.
std::vector<std::uint32_t> enclosing_facets(const std::vector<FaceFacet>& facets) {
  std::vector<std::array<std::uint32_t, 3>> sides_of(facets.size());
  std::vector<std::vector<std::uint32_t>> facets_at;
  const auto all = sorted_sides(facets, 0, static_cast<std::uint32_t>(facets.size()));
  std::vector<int> sides_known(facets.size(), 0);
  for_each_shared_side(all, [&](auto begin, auto end) {
    const auto side = static_cast<std::uint32_t>(facets_at.size());
    facets_at.emplace_back();
    for (auto s = begin; s != end; ++s) {
      sides_of[s->facet][sides_known[s->facet]++] = side;
      facets_at.back().push_back(s->facet);
    }
  });
  std::vector<std::size_t> uses;
  std::vector<std::uint32_t> loose;
  for (std::uint32_t side = 0; side < facets_at.size(); ++side) {
    uses.push_back(facets_at[side].size());
    if (uses.back() == 1) {
      loose.push_back(side);
    }
  }
  std::vector<bool> taken(facets.size(), false);
  while (!loose.empty()) {
    const std::uint32_t side = loose.back();
    loose.pop_back();
    for (const std::uint32_t facet : facets_at[side]) {
      if (taken[facet]) {
        continue;
      }
      taken[facet] = true;
      for (const std::uint32_t other : sides_of[facet]) {
        if (--uses[other] == 1) {
          loose.push_back(other);
        }
      }
    }
  }
  std::vector<std::uint32_t> left;
  for (std::uint32_t i = 0; i < facets.size(); ++i) {
    if (!taken[i]) {
      left.push_back(i);
    }
  }
  if (left.empty()) {
    for (std::uint32_t i = 0; i < facets.size(); ++i) {
      left.push_back(i);
    }
  }
  return left;
}

SizedFacets sized(const std::vector<FaceFacet>& facets, const std::vector<std::uint32_t>& chosen) {
  SizedFacets result;
  result.reserve(chosen.size());
  for (const std::uint32_t i : chosen) {
    result.push_back({facets[i].facet, 0.0, 1.0});
  }
  return result;
}

/// Tells on which sides of facets the volume lies.
class SideVoter {
 public:
  explicit SideVoter(const std::vector<FaceFacet>& facets)
      : facets_(facets), enclosing_(enclosing_facets(facets)), tree_(sized(facets, enclosing_)) {
    Box box;
    for (const FaceFacet& facet : facets) {
      box.extend(facet.facet.box());
    }
    off_ = 1e-9 * box.diagonal().norm() +
           1e-15 * box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
  }

  /// Whether the volume lies on the side of the sheet that its normals, turned by their signs and
  /// by `side` (1 or −1), look to.
  bool is_inside(const std::vector<std::pair<std::uint32_t, double>>& sheet, double side) const {
    const std::size_t rays_per_facet = (least_rays + sheet.size() - 1) / sheet.size();
    std::size_t rays = 0;
    std::size_t inside = 0;
    for (const auto& [facet, sign] : sheet) {
      for (std::size_t ray = 0; ray < rays_per_facet; ++ray) {
        inside += crossings(facet, side * sign * facets_[facet].normal, rays) % 2;
        ++rays;
      }
    }
    return 2 * inside > rays;
  }

  /// The largest facets of a sheet: enough to vote for it.
  std::vector<std::pair<std::uint32_t, double>> voters(const Sheet& sheet) const {
    auto sorted = sheet.facets;
    const std::size_t count = std::min(least_rays, sorted.size());
    std::partial_sort(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(count),
                      sorted.end(), [this](const auto& a, const auto& b) {
                        const double area_a = facets_[a.first].area;
                        const double area_b = facets_[b.first].area;
                        return area_a != area_b ? area_a > area_b : a.first < b.first;
                      });
    sorted.resize(count);
    return sorted;
  }

 private:
  static constexpr std::size_t least_rays = 9;

  /// Facets met by a ray from the facet's centroid, tilted so that it does not run along others.
  std::size_t crossings(std::uint32_t facet, const Vec3& normal, std::size_t seed) const {
    std::minstd_rand random(static_cast<unsigned>(seed + 1));
    const auto tilt = [&random] { return 0.4 * random() / std::minstd_rand::max() - 0.2; };
    const double x = tilt();
    const double y = tilt();
    const double z = tilt();
    const Vec3 direction = (normal + Vec3(x, y, z)).normalized();
    const Vec3 origin = facets_[facet].facet.centroid() + off_ * normal;
    std::size_t count = 0;
    tree_.first_hit(origin, direction, FacetTree::infinity, [&](std::uint32_t i) {
      count += enclosing_[tree_.original_index(i)] != facet ? 1 : 0;
      return false;  // on to the next
    });
    return count;
  }

  const std::vector<FaceFacet>& facets_;
  std::vector<std::uint32_t> enclosing_;
  FacetTree tree_;
  double off_ = 0.0;  ///< more than the rounding of the coordinates
};

void append_walls(const FaceFacet& facet, const Vec3& normal, bool front, bool back,
                  std::vector<Wall>& walls) {
  if (front) {
    walls.push_back({facet.facet, normal, facet.face});
  }
  if (back) {
    walls.push_back({facet.facet, -normal, facet.face});
  }
}

void append_walls(const std::vector<FaceFacet>& facets, const Sheet& sheet, const SideVoter& voter,
                  std::vector<Wall>& walls) {
  bool front = false;
  bool back = false;
  if (sheet.two_sided) {
    const auto voters = voter.voters(sheet);
    front = voter.is_inside(voters, 1.0);
    back = voter.is_inside(voters, -1.0);
  }
  for (const auto& [facet, sign] : sheet.facets) {
    if (!sheet.two_sided) {
      front = voter.is_inside({{facet, sign}}, 1.0);
      back = voter.is_inside({{facet, sign}}, -1.0);
    }
    if (facets[facet].area > 0.0) {
      append_walls(facets[facet], sign * facets[facet].normal, front, back, walls);
    }
  }
}

}  // namespace

std::vector<Wall> volume_walls(const std::vector<FacetedSource>& faces) {
  NodeNumbers numbers;
  std::vector<FaceFacet> facets;
  std::vector<std::uint32_t> begin_of_face{0};
  for (const FacetedSource& face : faces) {
    append_facets(face, numbers, facets);
    begin_of_face.push_back(static_cast<std::uint32_t>(facets.size()));
  }
  std::vector<Wall> walls;
  if (facets.empty()) {
    return walls;
  }
  const SideVoter voter(facets);
  for (std::size_t face = 0; face < faces.size(); ++face) {
    SheetFinder finder(facets, begin_of_face[face], begin_of_face[face + 1]);
    for (const Sheet& sheet : finder.sheets()) {
      append_walls(facets, sheet, voter, walls);
    }
  }
  return walls;
}

std::vector<Wall> surface_walls(const FacetedSource& surface,
                                const std::vector<FacetedSource>& curves,
                                const std::set<Entity>& seams) {
  NodeNumbers numbers;
  std::map<NodePair, std::vector<Vec3>> third_corners;  ///< of the triangles at a segment
  const auto is_new_segment = [&](const std::array<Vec3, 2>& ends) {
    const NodePair nodes = node_pair(numbers.of(ends[0]), numbers.of(ends[1]));
    return nodes[0] != nodes[1] && third_corners.insert({nodes, {}}).second;
  };
  std::vector<std::pair<Facet, Entity>> segments;
  for (const FacetedSource& curve : curves) {
    for (const std::array<Vec3, 2>& ends : curve.segments) {
      if (seams.count(curve.entity) == 0 && is_new_segment(ends)) {
        segments.emplace_back(Facet::segment(ends[0], ends[1]), curve.entity);
      }
    }
  }
  for (const Facet& triangle : triangles_of(surface)) {
    for (int i = 0; i < 3; ++i) {
      const NodePair nodes =
          node_pair(numbers.of(triangle.corners[i]), numbers.of(triangle.corners[(i + 1) % 3]));
      const auto at = third_corners.find(nodes);
      if (at != third_corners.end()) {
        at->second.push_back(triangle.corners[(i + 2) % 3]);
      }
    }
  }
  std::vector<Wall> walls;
  for (const auto& [segment, curve] : segments) {
    const auto& [a, b, unused] = segment.corners;
    for (const Vec3& third : third_corners[node_pair(numbers.of(a), numbers.of(b))]) {
      const Vec3 along = (b - a).normalized();
      const Vec3 across = (third - a) - along.dot(third - a) * along;
      if (across.norm() > 1e-14 * (third - a).norm()) {
        walls.push_back({segment, across.normalized(), curve});
      }
    }
  }
  return walls;
}

}  // namespace meshgrow
