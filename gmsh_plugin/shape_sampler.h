#ifndef MESHGROW_SHAPE_SAMPLER_H
#define MESHGROW_SHAPE_SAMPLER_H

#include <array>
#include <map>
#include <optional>
#include <vector>

#include "gmsh_api.h"
#include "topology.h"

namespace meshgrow {

/// A curve as a chain of points.
struct SampledCurve {
  std::vector<double> parameters;
  std::vector<Vec3> points;  ///< one a parameter
};

/// A surface as triangles, oriented alike, that fit together.
struct SampledSurface {
  std::vector<std::array<double, 2>> parameters;
  std::vector<Vec3> points;  ///< one a pair of parameters; several pairs may give the same point
  std::vector<std::array<std::size_t, 3>> triangles;
};

struct CurveOnSurface;

/// Makes facets of curves and surfaces that have no mesh, from their parametrisation within the
/// trimming curves. Only reads the model; not thread-safe, as Gmsh is not.
///
/// A curve is cut until neither its tangent nor the normal of a surface on it turns by more than
/// `max_turn` degrees from one point to the next; a surface until its normal does not, by a
/// triangulation of its parameters that keeps the points of the curves. So surfaces that meet have
/// the same points on their common curve, to the bit.
class ShapeSampler {
 public:
  ShapeSampler(const Topology& topology, double max_turn);

  /// Throws Error for a curve without parametrisation.
  const SampledCurve& curve(const Entity& curve);

  /// None if the parametrisation or the trimming curves are not what they should be.
  std::optional<SampledSurface> surface(const Entity& surface);

 private:
  Vec3 end_point(const Entity& curve, const Vec3& computed) const;
  std::vector<CurveOnSurface> curves_on(const Entity& surface);

  const Topology& topology_;
  double max_turn_;
  std::map<Entity, std::vector<Entity>> surfaces_on_;
  std::map<Entity, SampledCurve> curves_;
};

/// Normals of a surface along a curve on its border, given in the surface's parameters and in
/// space. At the pole of a sphere or the tip of a cone, which the parameters see as a curve, those
/// a little inside.
std::vector<Vec3> normals_along(const Entity& surface, const std::vector<double>& uv,
                                const std::vector<Vec3>& points);

/// Angle in degrees between two directions of any length; 0 if one of them is no direction.
double turn_between(const Vec3& a, const Vec3& b);

}  // namespace meshgrow

#endif
