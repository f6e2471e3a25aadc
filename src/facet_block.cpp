#include "facet_block.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace meshgrow {

Vec3 set_facet(simd::FacetBlock& block, std::uint32_t lane, const SizedFacet& sized,
               const Vec3& origin, double unit) {
  const Facet& facet = sized.facet;
  const double scale = 1.0 / unit;
  std::array<Vec3, 3> c;
  for (int k = 0; k < 3; ++k) {
    // Corners that the facet does not have repeat its last one.
    c[k] = (facet.corners[std::min(k, facet.corner_count - 1)] - origin) * scale;
  }

  // The longest side first.
  const double sides[3] = {(c[1] - c[0]).squaredNorm(), (c[2] - c[1]).squaredNorm(),
                           (c[0] - c[2]).squaredNorm()};
  const auto longest = static_cast<int>(std::max_element(sides, sides + 3) - sides);
  const Vec3& a = c[longest];
  const Vec3& b = c[(longest + 1) % 3];
  const Vec3& third = c[(longest + 2) % 3];
  // What is shorter is a point: its square has no digits left.
  constexpr double shortest_length = 1e-100;
  const double length =
      sides[longest] > shortest_length * shortest_length ? std::sqrt(sides[longest]) : 0.0;
  Vec3 along = Vec3::UnitX();
  if (length > 0.0) {
    along = (b - a) * (1.0 / length);
  }
  const double foot = along.dot(third - a);
  Vec3 across = (third - a) - foot * along;
  across -= across.dot(along) * along;
  const double height = across.norm();
  // Of no height, any direction across will do.
  const bool has_height = length > 0.0 && height > 1e-12 * length;
  if (has_height) {
    across /= height;
  } else {
    across = along.unitOrthogonal();
  }
  for (int axis = 0; axis < 3; ++axis) {
    block.corner[axis][lane] = static_cast<float>(a[axis]);
    block.along[axis][lane] = static_cast<float>(along[axis]);
    block.across[axis][lane] = static_cast<float>(across[axis]);
  }
  block.length[lane] = static_cast<float>(length);
  block.foot[lane] = static_cast<float>(std::clamp(foot, 0.0, length));
  block.height[lane] = has_height ? static_cast<float>(height) : 0.0f;
  block.start_size[lane] =
      static_cast<float>(std::min(sized.start_size / unit, largest_start_size));
  block.slope[lane] = static_cast<float>(sized.slope);
  const Vec3 side = c[1] - c[0];
  return facet.corner_count == 2 ? side : Vec3(side.cross(c[2] - c[0]));
}

}  // namespace meshgrow
