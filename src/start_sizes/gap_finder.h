#ifndef MESHGROW_START_SIZES_GAP_FINDER_H
#define MESHGROW_START_SIZES_GAP_FINDER_H

#include <cstdint>
#include <vector>

#include "facet_tree.h"
#include "region_walls.h"
#include "start_sizes/wall_meetings.h"

namespace meshgrow {

/// Gaps between the walls of one region. Lengths are in model units.
///
/// Two walls touch at a point of one and a point of the other if their smooth patches meet
/// (WallMeetings) closer than the scale of touching to the first point and twice as far from the
/// second. What touches makes no gap.
///
/// Immutable after construction; every const function may be called from any thread. `walls` must
/// outlive it.
class GapFinder {
 public:
  static constexpr double infinity = FacetTree::infinity;

  /// The way to the closest point of a wall is square to that wall to within 10°, about the turn of
  /// coarse facets. Else, in a round hole, what is closest within 45° of the normal would be off to
  /// the side, and nearer by a thirteenth than the hole is wide.
  static constexpr double cosine_of_square = 0.984807753012208;

  GapFinder(const std::vector<Wall>& walls, double touching_scale);

  /// The gap at the point p of a wall if it is below `within`, else infinity: the smaller one of
  /// - the distance along the wall's normal to the first wall met, of triangles;
  /// - the distance to the closest wall whose closest point is seen within 45° of the normal, by a
  ///   way that is square to that wall; a
  ///   wall which is less than 1 % closer than another, or than what the normal meets, is not
  ///   looked for, nor is one behind hundreds of hidden ones.
  /// The wall opposite faces p, its normal opposes within 45°, and it does not touch.
  double gap(std::size_t wall, const Vec3& p, double within) const;

  /// Whether a wall closer than `within` to the centroid of a piece of a wall may bound the gap of
  /// some point of the piece.
  bool is_faced(const Facet& piece, std::size_t wall, double within) const;

  /// Whether no point of the piece has a gap narrower than `width`. May be false without a reason.
  bool is_clear(const Facet& piece, std::size_t wall, double width) const;

 private:
  /// Walls with similar normals, so that those which cannot oppose a wall are not even looked at:
  /// its own neighbours are nearest to it, in numbers. In a frame of their own they lie flat, so
  /// that boxes fit them tightly.
  struct Bundle {
    Bundle(const std::vector<Wall>& walls, const std::vector<std::uint32_t>& members,
           const Vec3& origin);

    Vec3 axis;                 ///< mean normal
    Eigen::Matrix3d frame;     ///< turns the axis to z
    FacetTree tree;            ///< in the frame, about the origin
    std::vector<Box> normals;  ///< by node of the tree: holds the normals of all walls below it
    std::vector<Vec3> inward;  ///< by index into tree.facets(), as the next
    std::vector<std::uint32_t> wall_of;
  };

  using Meetings = std::vector<WallMeetings::Meeting>;
  struct View;
  struct Place;
  struct Opposite;

  template <typename Value>
  double least_opposing(const Place& place, double within, Value value) const;
  template <typename Value>
  double least_opposing(const Bundle& bundle, const Place& place, double within,
                        const Value& value) const;

  View view_of(const Facet& piece, std::size_t wall) const;
  bool may_bound(const View& view, const Opposite& opposite) const;
  double bound_over(const View& view, const Opposite& opposite) const;
  bool touches(const Meetings& meetings, std::size_t wall, const Vec3& q) const;
  bool sees(const Wall& wall, const Vec3& p, const Vec3& q) const;
  bool sees_past_segments(const Vec3& p, const Vec3& q) const;
  double closest_gap(const Wall& wall, const Vec3& p, const Meetings& meetings,
                     double within) const;
  double closest_gap(const Wall& wall, const Vec3& p, const Meetings& meetings, double inner,
                     double outer) const;
  double ray_gap(const Wall& wall, const Vec3& p, const Meetings& meetings, double within) const;

  const std::vector<Wall>& walls_;
  double touching_scale_;
  Vec3 centre_ = Vec3::Zero();
  double size_ = 0.0;
  double zero_ = 0.0;  ///< what coordinates of this size can be off by
  std::vector<Bundle> bundles_;
  std::vector<Vec3> inward_;  ///< by index into tree_.facets()
  FacetTree tree_;
  WallMeetings meetings_;
};

}  // namespace meshgrow

#endif
