#ifndef MESHGROW_PLANE_CUT_H
#define MESHGROW_PLANE_CUT_H

#include <array>
#include <functional>
#include <vector>

#include "geometry.h"

namespace meshgrow {

/// A square of a plane cut with the sizes at its corners, in order around it.
struct CutSquare {
  std::array<Vec3, 4> corners;
  std::array<double, 4> sizes;
};

/// Sizes at so many points.
using SizesAt = std::function<void(const std::vector<Vec3>& points, double* sizes)>;

/// Squares that fill the cut of the box by the plane through `point`, `resolution` of them along
/// its longer side, divided in four as long as interpolation between the corners differs by more
/// than `tolerance` (relative) at the middle of the square or of a side, up to six times. Squares
/// with sizes that are not finite are left out; none if the plane misses the box.
std::vector<CutSquare> cut_by_plane(const Box& box, const Vec3& point, const Vec3& normal,
                                    int resolution, double tolerance, const SizesAt& sizes_at);

}  // namespace meshgrow

#endif
