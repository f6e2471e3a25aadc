#include "start_sizes/gap_finder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace meshgrow {

namespace {

SizedFacets facets_of(const std::vector<Wall>& walls) {
  SizedFacets facets;
  facets.reserve(walls.size());
  for (const Wall& wall : walls) {
    facets.push_back({wall.facet, 0.0, 1.0});
  }
  return facets;
}

Vec3 mean_normal(const std::vector<Wall>& walls, const std::vector<std::uint32_t>& members) {
  Vec3 sum = Vec3::Zero();
  for (const std::uint32_t member : members) {
    sum += walls[member].inward;
  }
  return sum.normalized();
}

SizedFacets turned_facets(const std::vector<Wall>& walls, const std::vector<std::uint32_t>& members,
                          const Eigen::Matrix3d& frame, const Vec3& origin) {
  SizedFacets facets;
  facets.reserve(members.size());
  for (const std::uint32_t member : members) {
    Facet facet = walls[member].facet;
    for (Vec3& corner : facet.corners) {
      corner = frame * (corner - origin);
    }
    facets.push_back({facet, 0.0, 1.0});
  }
  return facets;
}

constexpr std::size_t direction_count = 54;

/// Which axis the normal is along, which way, and which ninth of that side of a cube it pierces: 0
/// to 53. Normals along an axis are in the middle of a ninth, lest rounding should part them.
std::size_t direction_of(const Vec3& normal) {
  int axis = 0;
  const double along = normal.cwiseAbs().maxCoeff(&axis);
  int direction = 2 * axis + (normal[axis] < 0.0 ? 1 : 0);
  for (const int other : {(axis + 1) % 3, (axis + 2) % 3}) {
    const double across = normal[other] / along;
    direction = 3 * direction + (across < -1.0 / 3.0 ? 0 : across > 1.0 / 3.0 ? 2 : 1);
  }
  return static_cast<std::size_t>(direction);
}

/// Whether one of the normals in the box may oppose the normal.
bool may_oppose(const Vec3& normal, const Box& normals) {
  const double least = normal.dot(normals.center()) - 0.5 * normal.cwiseAbs().dot(normals.sizes());
  return least <= -cosine_of_opposing + 1e-6;
}

/// Whether a way to a point of a ball, from outside, may be square to a wall with one of the
/// normals in the box.
bool may_be_square(const Vec3& way_to_centre, double radius, const Box& normals) {
  const double distance = way_to_centre.norm();
  if (radius > 0.5 * distance) {
    return true;
  }
  // As unit vectors, ways differ by 2 sin(asin(r / d) / 2) at most, which is below 1.04 r / d.
  const double spread = 1.04 * radius / distance + 0.5 * normals.diagonal().norm();
  return -way_to_centre.dot(normals.center()) + (spread + 1e-9) * distance >=
         GapFinder::cosine_of_square * distance;
}

/// Heights of a facet's corners above a plane.
struct Heights {
  double lowest = FacetTree::infinity;
  double highest = -FacetTree::infinity;

  Heights(const Facet& facet, const Vec3& origin, const Vec3& normal) {
    for (int i = 0; i < facet.corner_count; ++i) {
      const double height = normal.dot(facet.corners[i] - origin);
      lowest = std::min(lowest, height);
      highest = std::max(highest, height);
    }
  }
};

/// A segment this close to the way from one point to another, against the length of the way, hides
/// one from the other.
constexpr double close_to_sight = 1e-6;

/// Whether the facet comes close to the way from p to q, away from its ends.
bool crosses(const Facet& segment, const Vec3& p, const Vec3& q) {
  constexpr double close = close_to_sight;
  const Vec3 way = q - p;
  const Vec3 along = segment.corners[1] - segment.corners[0];
  const Vec3 between = segment.corners[0] - p;
  // The point of the segment where the lines are closest, then the nearest point on the way to it.
  const double way2 = way.squaredNorm();
  const double product = way.dot(along);
  const double determinant = way2 * along.squaredNorm() - product * product;
  const double t = determinant > 0.0
                       ? (product * way.dot(between) - way2 * along.dot(between)) / determinant
                       : 0.0;
  for (const double on_segment : {std::clamp(t, 0.0, 1.0), 0.0, 1.0}) {
    const Vec3 x = between + on_segment * along;
    const double on_way = way.dot(x) / way2;
    if (on_way > close && on_way < 1.0 - close &&
        (x - on_way * way).squaredNorm() <= close * close * way2) {
      return true;
    }
  }
  return false;
}

}  // namespace

/// A ball in which points of a wall look along its normal.
struct GapFinder::Place {
  Vec3 normal;
  Vec3 centre;
  double radius;
  /// Only what is so far away, and seen by a way square to it, is looked for.
  double nearest = 0.0;
  bool is_square = false;

  /// Distance from the centre to the box, or infinity if no point of the ball sees any point of the
  /// box within 45° of the normal.
  double distance_to(const Box& box) const {
    const double distance = box.exteriorDistance(centre);
    const double highest =
        normal.dot(box.center() - centre) + 0.5 * normal.cwiseAbs().dot(box.sizes());
    return highest > 0.0 && highest >= 0.999 * cosine_of_opposing * (distance - radius) ? distance
                                                                                        : infinity;
  }
};

/// A piece of a wall, and what it touches as a whole.
struct GapFinder::View {
  const Facet& piece;
  Place place;
  Meetings meetings;
};

/// A wall opposite, and its point closest to the one that looks.
struct GapFinder::Opposite {
  std::size_t wall;
  Vec3 closest;
  double distance;
};

GapFinder::Bundle::Bundle(const std::vector<Wall>& walls, const std::vector<std::uint32_t>& members,
                          const Vec3& origin)
    : axis(mean_normal(walls, members)),
      frame(Eigen::Quaterniond::FromTwoVectors(axis, Vec3::UnitZ()).toRotationMatrix()),
      tree(turned_facets(walls, members, frame, origin)) {
  for (std::size_t i = 0; i < members.size(); ++i) {
    wall_of.push_back(members[tree.original_index(i)]);
    inward.push_back(walls[wall_of.back()].inward);
  }
  normals = tree.node_values<Box>([this](std::size_t i) { return Box(inward[i]); },
                                  [](Box& box, const Box& other) { box.extend(other); });
}

GapFinder::GapFinder(const std::vector<Wall>& walls, double touching_scale)
    : walls_(walls), touching_scale_(touching_scale), tree_(facets_of(walls)), meetings_(walls) {
  if (walls.empty()) {
    return;
  }
  std::array<std::vector<std::uint32_t>, direction_count> members;
  Box box;
  for (std::uint32_t i = 0; i < walls.size(); ++i) {
    members[direction_of(walls[i].inward)].push_back(i);
    box.extend(walls[i].facet.box());
    inward_.push_back(walls[tree_.original_index(i)].inward);
  }
  centre_ = box.center();
  size_ = box.diagonal().norm();
  zero_ = 1e-9 * size_ + 1e-15 * box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
  for (const std::vector<std::uint32_t>& bundle : members) {
    if (!bundle.empty()) {
      bundles_.emplace_back(walls, bundle, centre_);
    }
  }
}

/// The least of value(opposite), if it is below `within`, over all walls that oppose the normal,
/// lie in front and are nearer to the centre than `within` and than the least value so far.
template <typename Value>
double GapFinder::least_opposing(const Place& place, double within, Value value) const {
  // The walls straight opposite first: what they give leaves little to be looked at elsewhere.
  std::array<std::pair<double, const Bundle*>, direction_count> order;
  std::size_t count = 0;
  for (const Bundle& bundle : bundles_) {
    if (may_oppose(place.normal, bundle.normals.front())) {
      order[count++] = {place.normal.dot(bundle.axis), &bundle};
    }
  }
  std::sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count));
  double least = within;
  for (std::size_t i = 0; i < count; ++i) {
    least = least_opposing(*order[i].second, place, least, value);
  }
  return least < within ? least : infinity;
}

template <typename Value>
double GapFinder::least_opposing(const Bundle& bundle, const Place& place, double within,
                                 const Value& value) const {
  const Place turned{bundle.frame * place.normal, bundle.frame * (place.centre - centre_),
                     place.radius};
  const StoredArray<SizedFacet>& facets = bundle.tree.facets();
  double least = within;
  bundle.tree.closest_facet(
      within,
      [&](std::size_t node, const Box& box) {
        if (!may_oppose(place.normal, bundle.normals[node])) {
          return infinity;
        }
        const Vec3 way = box.center() - turned.centre;
        if ((way.cwiseAbs() + 0.5 * box.sizes()).norm() < place.nearest ||
            (place.is_square && !may_be_square(bundle.frame.transpose() * way,
                                               0.5 * box.sizes().norm(), bundle.normals[node]))) {
          return infinity;
        }
        return turned.distance_to(box);
      },
      [&](std::uint32_t i) {
        if (!normals_oppose(place.normal, bundle.inward[i])) {
          return infinity;
        }
        const Vec3 way = closest_point(facets[i].facet, turned.centre) - turned.centre;
        const double distance = way.norm();
        if (!(distance < least)) {
          return infinity;
        }
        const double found = value(Opposite{
            bundle.wall_of[i], Vec3(place.centre + bundle.frame.transpose() * way), distance});
        least = std::min(least, found);
        return found;
      });
  return least;
}

bool GapFinder::touches(const Meetings& meetings, std::size_t wall, const Vec3& q) const {
  return std::any_of(meetings.begin(), meetings.end(), [&](const WallMeetings::Meeting& meeting) {
    return meeting.patch == meetings_.patch_of(wall) &&
           distance(meeting.place, q) <= 2.0 * touching_scale_;
  });
}

// ==== Gap at a point

double GapFinder::gap(std::size_t wall, const Vec3& p, double within) const {
  const Meetings meetings = meetings_.near(wall, p, touching_scale_);
  const double along_normal = ray_gap(walls_[wall], p, meetings, within);
  const double closest = closest_gap(walls_[wall], p, meetings, std::min(along_normal, within));
  return std::min(along_normal, closest);
}

double GapFinder::closest_gap(const Wall& wall, const Vec3& p, const Meetings& meetings,
                              double within) const {
  // Shell by shell, so that what is hidden far behind does not use up the trials of what is near.
  const double reach = std::min(within, 2.0 * size_);
  double inner = 0.0;
  double outer = std::min(reach, wall.facet.box().diagonal().norm());
  for (;;) {
    const double gap = closest_gap(wall, p, meetings, inner, outer);
    if (gap < infinity || outer >= reach) {
      return gap;
    }
    inner = outer;
    outer = std::min(2.0 * outer, reach);
  }
}

/// The same among walls from `inner` to `outer` away.
double GapFinder::closest_gap(const Wall& wall, const Vec3& p, const Meetings& meetings,
                              double inner, double outer) const {
  // By distances made a little smaller, the search is over where it would gain little: on a sphere
  // inside another, all facets are about as far.
  constexpr double scale = 0.99;
  // Behind a body that is in the way there may be any number of walls.
  constexpr int most_hidden = 256;
  int hidden = 0;
  const double nearest = std::max(scale * inner, zero_);
  const auto faces = [&](const Opposite& opposite) {
    const Vec3 way = opposite.closest - p;
    return opposite.distance >= nearest &&
           wall.inward.dot(way) >= cosine_of_opposing * opposite.distance &&
           -walls_[opposite.wall].inward.dot(way) >= cosine_of_square * opposite.distance &&
           !touches(meetings, opposite.wall, opposite.closest);
  };
  const double least = least_opposing({wall.inward, p, 0.0, nearest, true}, scale * outer,
                                      [&](const Opposite& opposite) {
                                        if (hidden >= most_hidden || !faces(opposite)) {
                                          return infinity;
                                        }
                                        if (!sees(wall, p, opposite.closest)) {
                                          ++hidden;
                                          return infinity;
                                        }
                                        return scale * opposite.distance;
                                      });
  return least / scale;
}

double GapFinder::ray_gap(const Wall& wall, const Vec3& p, const Meetings& meetings,
                          double within) const {
  // Starts off the wall, so as to meet neither it nor its other side. A wall is met from its front
  // only, so that of the two sides of one the right one is met.
  const FacetTree::Closest hit =
      tree_.first_hit(p + zero_ * wall.inward, wall.inward, within - zero_,
                      [&](std::uint32_t i) { return inward_[i].dot(wall.inward) < 0.0; });
  if (hit.facet == tree_.facets().size() || !normals_oppose(inward_[hit.facet], wall.inward)) {
    return infinity;
  }
  const double distance = hit.distance + zero_;
  const Vec3 q = p + distance * wall.inward;
  return touches(meetings, tree_.original_index(hit.facet), q) ? infinity : distance;
}

bool GapFinder::sees(const Wall& wall, const Vec3& p, const Vec3& q) const {
  if (wall.facet.corner_count == 2) {
    return sees_past_segments(p, q);
  }
  const Vec3 start = p + zero_ * wall.inward;
  const double length = (q - start).norm();
  const Vec3 direction = (q - start) / length;
  const FacetTree::Closest hit =
      tree_.first_hit(start, direction, length * (1.0 - 1e-6) - zero_,
                      [&](std::uint32_t i) { return inward_[i].dot(direction) < 0.0; });
  return hit.facet == tree_.facets().size();
}

bool GapFinder::sees_past_segments(const Vec3& p, const Vec3& q) const {
  const double length = (q - p).norm();
  const Vec3 inverse = ((q - p) / length).cwiseInverse();
  const Vec3 margin = Vec3::Constant(2.0 * close_to_sight * length);
  const auto enters = [&](std::size_t, const Box& box) {
    return FacetTree::ray_enters(Box(box.min() - margin, box.max() + margin), p, inverse);
  };
  const FacetTree::Closest blocking = tree_.closest_facet(length, enters, [&](std::uint32_t i) {
    return crosses(tree_.facets()[i].facet, p, q) ? 0.0 : infinity;
  });
  return blocking.facet == tree_.facets().size();
}

// ==== Bounds over a piece

GapFinder::View GapFinder::view_of(const Facet& piece, std::size_t wall) const {
  const Vec3 centre = piece.centroid();
  const double radius = piece.radius();
  return {piece,
          {walls_[wall].inward, centre, radius},
          meetings_.near(wall, centre, touching_scale_ - radius)};
}

bool GapFinder::may_bound(const View& view, const Opposite& opposite) const {
  const Wall& wall = walls_[opposite.wall];
  const double highest = Heights(wall.facet, view.place.centre, view.place.normal).highest;
  return opposite.distance > zero_ && highest > zero_ &&
         highest >= cosine_of_opposing * (opposite.distance - view.place.radius) &&
         Heights(view.piece, wall.facet.corners[0], wall.inward).highest > zero_ &&
         !touches(view.meetings, opposite.wall, opposite.closest);
}

bool GapFinder::is_faced(const Facet& piece, std::size_t wall, double within) const {
  const View view = view_of(piece, wall);
  return least_opposing(view.place, within, [&](const Opposite& opposite) {
           return may_bound(view, opposite) ? 0.0 : infinity;
         }) < within;
}

bool GapFinder::is_clear(const Facet& piece, std::size_t wall, double width) const {
  const View view = view_of(piece, wall);
  return least_opposing(view.place, view.place.radius + width, [&](const Opposite& opposite) {
           return bound_over(view, opposite) < width && may_bound(view, opposite) ? 0.0 : infinity;
         }) == infinity;
}

/// A lower bound of the distance from any point of the piece to the wall.
double GapFinder::bound_over(const View& view, const Opposite& opposite) const {
  const Wall& wall = walls_[opposite.wall];
  return std::max({opposite.distance - view.place.radius,
                   Heights(wall.facet, view.place.centre, view.place.normal).lowest,
                   Heights(view.piece, wall.facet.corners[0], wall.inward).lowest});
}

}  // namespace meshgrow
