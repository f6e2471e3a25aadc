#ifndef MESHGROW_START_SIZES_WALL_MEETINGS_H
#define MESHGROW_START_SIZES_WALL_MEETINGS_H

#include <array>
#include <cstdint>
#include <vector>

#include "facet_tree.h"
#include "region_walls.h"

namespace meshgrow {

/// Largest angle between a wall's normal and the reverse of another's for the two to oppose: 45°.
constexpr double cosine_of_opposing = 0.70710678118654752;

/// Whether two walls with these inward normals face each other within 45°, or rounding more: 45° is
/// a frequent angle.
inline bool normals_oppose(const Vec3& a, const Vec3& b) {
  return a.dot(b) <= -cosine_of_opposing + 1e-9;
}

/// Where opposing walls meet, with the region between them: the edge of a wedge, the tip of a cone,
/// the point where a sphere stands on a plane. Two walls meet in the nodes or the side that they
/// share. So that it does not matter how coarse the walls are, their smooth patches (walls that
/// share sides and bend by less than 45° there) meet in the same place.
///
/// Immutable after construction; every const function may be called from any thread.
class WallMeetings {
 public:
  explicit WallMeetings(const std::vector<Wall>& walls);

  /// Another patch, and the nearest place where it meets the patch asked for.
  struct Meeting {
    std::uint32_t patch;
    Facet place;
  };

  /// All patches that the wall's patch meets closer than `within` to p.
  std::vector<Meeting> near(std::size_t wall, const Vec3& p, double within) const;

  std::uint32_t patch_of(std::size_t wall) const { return patch_of_[wall]; }

  bool empty() const { return places_.empty(); }

 private:
  std::vector<std::uint32_t> patch_of_;  ///< empty where nothing meets
  FacetTree places_;
  std::vector<std::array<std::uint32_t, 2>> patches_at_;  ///< by index into places_.facets()
};

}  // namespace meshgrow

#endif
