#include "geometry_sampler.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "error.h"
#include "facet.h"
#include "gmsh_api.h"

namespace meshgrow {

namespace {

// Odd numbers: the samples of a symmetric shape then do not all agree by accident.
constexpr int curve_intervals_at_first = 7;
constexpr int curve_depth = 9;
constexpr int surface_cells_at_first = 5;
constexpr int surface_depth = 6;

/// Largest distance from the entity to its pieces, in resolutions.
constexpr double chord_error = 0.1;

class CurveSampler {
 public:
  CurveSampler(const Entity& curve, double resolution, FacetedSource& source)
      : curve_(curve), allowed_(chord_error * resolution), source_(source) {}

  void sample() {
    const auto bounds = gmsh::parameter_bounds(curve_);
    if (bounds.size() != 1) {
      throw Error(entity_name(curve_) +
                  " has neither a mesh nor a parametrisation: mesh it first.");
    }
    const auto [low, high] = bounds[0];
    std::vector<double> parameters;
    for (int i = 0; i <= curve_intervals_at_first; ++i) {
      parameters.push_back(low + (high - low) * i / curve_intervals_at_first);
    }
    const std::vector<Vec3> points = gmsh::points_at(curve_, parameters);
    for (int i = 0; i < curve_intervals_at_first; ++i) {
      refine(parameters[i], points[i], parameters[i + 1], points[i + 1], curve_depth);
    }
  }

 private:
  void refine(double t0, const Vec3& p0, double t1, const Vec3& p1, int depth) {
    const double t = 0.5 * (t0 + t1);
    const Vec3 middle = gmsh::points_at(curve_, {t})[0];
    if (depth > 0 && distance(Facet::segment(p0, p1), middle) > allowed_) {
      refine(t0, p0, t, middle, depth - 1);
      refine(t, middle, t1, p1, depth - 1);
    } else {
      source_.segments.push_back({p0, middle});
      source_.segments.push_back({middle, p1});
    }
  }

  Entity curve_;
  double allowed_;
  FacetedSource& source_;
};

class SurfaceSampler {
 public:
  SurfaceSampler(const Entity& surface, double resolution, FacetedSource& source)
      : surface_(surface), resolution_(resolution), source_(source) {}

  void sample() {
    const auto bounds = gmsh::parameter_bounds(surface_);
    if (bounds.size() != 2) {
      throw Error(entity_name(surface_) +
                  " has neither a mesh nor a parametrisation: mesh it first.");
    }
    const double du = (bounds[0][1] - bounds[0][0]) / surface_cells_at_first;
    const double dv = (bounds[1][1] - bounds[1][0]) / surface_cells_at_first;
    for (int i = 0; i < surface_cells_at_first; ++i) {
      for (int j = 0; j < surface_cells_at_first; ++j) {
        const double u = bounds[0][0] + i * du;
        const double v = bounds[1][0] + j * dv;
        refine({at(u, v), at(u + du, v), at(u + du, v + dv), at(u, v + dv)}, surface_depth);
      }
    }
  }

 private:
  struct Sample {
    double u;
    double v;
    Vec3 point;
    bool inside;
  };
  using Cell = std::array<Sample, 4>;

  Sample at(double u, double v) const {
    return {u, v, gmsh::points_at(surface_, {u, v})[0], gmsh::is_inside(surface_, u, v)};
  }

  void refine(const Cell& c, int depth) {
    const Sample centre = at(0.5 * (c[0].u + c[2].u), 0.5 * (c[0].v + c[2].v));
    int inside = centre.inside ? 1 : 0;
    double longest = 0.0;
    for (int i = 0; i < 4; ++i) {
      inside += c[i].inside ? 1 : 0;
      longest = std::max(longest, (c[(i + 1) % 4].point - c[i].point).norm());
    }
    const Vec3 mean = 0.25 * (c[0].point + c[1].point + c[2].point + c[3].point);
    // The diagonal counts as well: it is where two triangles would replace the cell.
    const Vec3 on_diagonal = 0.5 * (c[0].point + c[2].point);
    const bool flat = std::max((centre.point - mean).norm(), (centre.point - on_diagonal).norm()) <=
                      chord_error * resolution_;
    const bool trimmed = inside < 5;
    // Small features inside a cell whose samples agree would be missed: cells start small enough
    // by surface_cells_at_first, and trimming curves are sampled by themselves.
    if (depth > 0 && (!flat || (trimmed && longest > 0.5 * resolution_ && inside > 0))) {
      const Sample south = at(centre.u, c[0].v);
      const Sample east = at(c[1].u, centre.v);
      const Sample north = at(centre.u, c[2].v);
      const Sample west = at(c[0].u, centre.v);
      refine({c[0], south, centre, west}, depth - 1);
      refine({south, c[1], east, centre}, depth - 1);
      refine({centre, east, c[2], north}, depth - 1);
      refine({west, centre, north, c[3]}, depth - 1);
      return;
    }
    if (!trimmed && flat) {
      source_.triangles.push_back({c[0].point, c[1].point, c[2].point});
      source_.triangles.push_back({c[0].point, c[2].point, c[3].point});
      return;
    }
    for (int i = 0; i < 4; ++i) {
      const Sample& a = c[i];
      const Sample& b = c[(i + 1) % 4];
      if (a.inside && b.inside && centre.inside) {
        source_.triangles.push_back({a.point, b.point, centre.point});
      }
    }
  }

  Entity surface_;
  double resolution_;
  FacetedSource& source_;
};

void sample(const Entity& entity, const Topology& topology, double resolution,
            FacetedSource& source) {
  if (entity.dim == 0) {
    source.points.push_back(gmsh::points_at(entity, {})[0]);
  } else if (entity.dim == 1) {
    CurveSampler(entity, resolution, source).sample();
  } else {
    if (entity.dim == 2) {
      SurfaceSampler(entity, resolution, source).sample();
    }
    for (const Entity& lower : topology.lower(entity)) {
      sample(lower, topology, resolution, source);
    }
  }
}

}  // namespace

FacetedSource sample_geometry(const Entity& entity, const Topology& topology, double resolution) {
  FacetedSource source;
  source.entity = entity;
  sample(entity, topology, resolution, source);
  return source;
}

}  // namespace meshgrow
