#ifndef MESHGROW_ATTACHED_REGION_H
#define MESHGROW_ATTACHED_REGION_H

#include "facet_tree.h"

namespace meshgrow {

/// What is inside volumes, by the meshes of their boundaries: sizes are asked for nowhere else.
///
/// Errs towards `boundary` and `inside`. Should a boundary not be closed, some of what is inside is
/// taken to be outside; who relies on it must then be slower, not wrong.
///
/// Immutable after construction; every const function may be called from any thread.
class AttachedRegion {
 public:
  /// `triangles`: of each volume all boundary faces, those that two volumes share twice. The start
  /// sizes and slopes do not matter.
  explicit AttachedRegion(std::vector<std::array<Vec3, 3>> triangles, int threads = 1);

  enum class Place { outside, boundary, inside };

  /// Where the ball around the finite point is.
  Place place(const Vec3& centre, double radius) const;

 private:
  bool encloses(const Vec3& p) const;

  FacetTree boundary_;
};

}  // namespace meshgrow

#endif
