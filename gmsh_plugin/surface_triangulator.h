#ifndef MESHGROW_SURFACE_TRIANGULATOR_H
#define MESHGROW_SURFACE_TRIANGULATOR_H

#include <memory>

#include "planar_triangulation.h"
#include "shape_sampler.h"

namespace meshgrow {

/// A curve on a surface, in the surface's parameters and in space.
struct CurveOnSurface {
  std::vector<double> uv;  ///< two a point
  std::vector<Vec3> points;
  bool is_border = true;  ///< else embedded
};

/// Triangulates one surface for ShapeSampler: in its parameters, stretched so that its normal turns
/// by as much in both directions.
class SurfaceTriangulator {
 public:
  /// `curves`: all on the border, seams once for each side, and those embedded. Throws Error if
  /// they or the parametrisation are unusable: the border has a gap or crosses itself.
  SurfaceTriangulator(const Entity& surface, const std::vector<CurveOnSurface>& curves,
                      double max_turn);

  /// Adds points inside until the normal turns by at most the angle given along each side.
  void refine();

  SampledSurface result() const;

 private:
  using Point = PlanarTriangulation::Point;
  using Side = std::array<std::size_t, 2>;

  void measure_range(const std::vector<CurveOnSurface>& curves);
  void measure_stretch();
  void add_curve(const CurveOnSurface& curve);
  bool is_closed() const;
  Point stretched(double u, double v) const;
  std::size_t add_vertex(double u, double v, const Vec3& point, const Vec3& normal);
  std::size_t end_vertex(double u, double v, const Vec3& point, const Vec3& normal);
  std::vector<std::size_t> vertices_of(const CurveOnSurface& curve);
  void add_inner_points(const std::vector<double>& uv);
  bool is_tilted(const std::array<std::size_t, 3>& triangle) const;
  std::vector<double> points_wanted() const;

  Entity surface_;
  double max_turn_;
  std::array<double, 2> low_;
  std::array<double, 2> range_;
  Point stretch_ = Point::Ones();
  bool turns_both_ways_ = false;
  bool is_flat_ = true;
  double smallest_side_ = 0.0;  ///< in space
  std::unique_ptr<PlanarTriangulation> triangulation_;
  SampledSurface sampled_;         ///< triangles only in the result
  std::vector<Vec3> normals_;      ///< one a vertex
  std::vector<std::size_t> ends_;  ///< vertices at ends of curves
  std::vector<int> border_degree_;
};

}  // namespace meshgrow

#endif
