#ifndef MESHGROW_ATTACHED_REGION_H
#define MESHGROW_ATTACHED_REGION_H

#include "facet_tree.h"

namespace meshgrow {

/// What is inside volumes, by the meshes of their boundaries: sizes are asked for nowhere else.
///
/// Should a boundary not be closed, some of what is inside is taken to be outside: who relies on it
/// must then be slower, not wrong.
///
/// Immutable after construction; every const function may be called from any thread.
class AttachedRegion {
 public:
  /// `triangles`: of each volume all boundary faces, those that two volumes share twice.
  explicit AttachedRegion(const std::vector<std::array<Vec3, 3>>& triangles, int threads = 1);

  /// Whether the boundary comes closer than `radius` to the finite point.
  bool touches(const Vec3& centre, double radius) const;

  /// Whether the point is inside, by what a ray from it meets.
  bool encloses(const Vec3& p) const;

  /// Whether one of the points is inside and the other is not: much faster than to ask for each.
  bool separates(const Vec3& p, const Vec3& q) const;

 private:
  std::size_t crossings(const Vec3& from, const Vec3& direction, double within) const;

  FacetTree boundary_;
};

}  // namespace meshgrow

#endif
