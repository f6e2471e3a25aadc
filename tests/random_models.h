#ifndef MESHGROW_TESTS_RANDOM_MODELS_H
#define MESHGROW_TESTS_RANDOM_MODELS_H

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <string>
#include <vector>

#include "graded_sphere.h"
#include "growth_law.h"
#include "random_facets.h"

/// Random size fields of every shape: what property tests run over.
namespace meshgrow::test {

constexpr double machine_epsilon = 2.220446049250313e-16;

/// A size field, and the box in which its sizes are asked for.
struct RandomModel {
  std::string name;
  SizedFacets facets;
  double size_limit = 1.0;
  Box box;

  /// Largest coordinate in it: what rounding errors of distances are proportional to.
  double reach() const {
    double reach = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
    for (const SizedFacet& f : facets) {
      for (const Vec3& corner : f.facet.corners) {
        reach = std::max(reach, corner.cwiseAbs().maxCoeff());
      }
    }
    return reach;
  }

  double largest_slope() const {
    double slope = 0.0;
    for (const SizedFacet& f : facets) {
      slope = std::max(slope, f.slope);
    }
    return slope;
  }
};

template <typename T, std::size_t count>
const T& one_of(Random& random, const std::array<T, count>& choices) {
  return choices[random_index(random, count)];
}

// ==== Facets

/// Facets in a few places, each a thousandth to a millionth of the whole.
inline std::vector<Facet> random_clusters(Random& random, std::size_t count) {
  std::vector<Facet> facets;
  while (facets.size() < count) {
    RandomFacets wanted;
    const double size = log_uniform(random, 1e-6, 1e-3);
    const Vec3 centre = random_in_box(random, cube(1.0));
    wanted.box = Box(centre - Vec3::Constant(size), centre + Vec3::Constant(size));
    wanted.shortest = 0.01 * size;
    wanted.longest = 2.0 * size;
    wanted.count = 1 + random_index(random, 40);
    for (const SizedFacet& f : random_facets(random, wanted)) {
      facets.push_back(f.facet);
    }
  }
  facets.resize(count);
  return facets;
}

/// Needles and slivers from end to end of the model, a thousand to a billion times as long as wide.
inline std::vector<Facet> random_needles(Random& random, std::size_t count) {
  std::vector<Facet> facets;
  while (facets.size() < count) {
    facets.push_back(thin_triangle(random, random_in_box(random, cube(1.0)),
                                   log_uniform(random, 0.1, 2.0), log_uniform(random, 1e-9, 1e-3)));
  }
  return facets;
}

/// A few facets, each many times in the same place.
inline std::vector<Facet> random_repeated(Random& random, std::size_t count) {
  RandomFacets wanted;
  wanted.count = 1 + count / 20;
  std::vector<Facet> facets;
  for (const SizedFacet& f : random_facets(random, wanted)) {
    facets.push_back(f.facet);
  }
  while (facets.size() < count) {
    facets.push_back(facets[random_index(random, wanted.count)]);
  }
  return facets;
}

/// A sphere as it is meshed, graded, perhaps squeezed to a plate or a rod.
inline std::vector<Facet> random_surface(Random& random, std::size_t count) {
  const Vec3 stretch(log_uniform(random, 1e-3, 1.0), log_uniform(random, 0.1, 1.0), 1.0);
  std::vector<Facet> facets;
  for (const auto& [a, b, c] : graded_sphere(count, log_uniform(random, 1.0, 30.0))) {
    facets.push_back(
        Facet::triangle(a.cwiseProduct(stretch), b.cwiseProduct(stretch), c.cwiseProduct(stretch)));
  }
  return facets;
}

/// Polygons through space, as meshed curves are.
inline std::vector<Facet> random_curves(Random& random, std::size_t count) {
  std::vector<Facet> facets;
  while (facets.size() < count) {
    Vec3 a = random_in_box(random, cube(1.0));
    Vec3 direction = random_direction(random);
    double length = log_uniform(random, 1e-3, 0.2);
    for (std::size_t i = 1 + random_index(random, 40); i > 0; --i) {
      direction = (direction + random_in_ball(random, 0.3)).normalized();
      length *= uniform(random, 0.8, 1.25);
      const Vec3 b = a + length * direction;
      facets.push_back(Facet::segment(a, b));
      a = b;
    }
  }
  facets.resize(count);
  return facets;
}

inline std::vector<Facet> random_mix(Random& random, std::size_t count, FacetMix mix) {
  RandomFacets wanted;
  wanted.mix = mix;
  wanted.count = count;
  std::vector<Facet> facets;
  for (const SizedFacet& f : random_facets(random, wanted)) {
    facets.push_back(f.facet);
  }
  return facets;
}

/// Within a plane or a line along the axes, as 2D models are.
inline std::vector<Facet> flattened(std::vector<Facet> facets, int axes, double place) {
  for (Facet& facet : facets) {
    for (Vec3& corner : facet.corners) {
      for (int axis = 2; axis > 2 - axes; --axis) {
        corner[axis] = place;
      }
    }
  }
  return facets;
}

// ==== Sizes

/// What the element is long, or the distance to the next place of the model if it is a point.
inline double extent(const Facet& facet) {
  const Box box = facet.box();
  const double extent = box.sizes().norm();
  return extent > 0.0 ? extent : 0.05;
}

inline double random_growth_rate(Random& random) {
  return random_index(random, 3) == 0
             ? uniform(random, 1.0, 2.0)
             : one_of(random, std::array<double, 6>{1.0, 1.0 + 1e-7, 1.05, 1.2, 1.5, 8.0});
}

/// Start sizes as of a mesh, one for all, or any; slopes of one growth rate or of several.
inline SizedFacets with_random_sizes(Random& random, const std::vector<Facet>& facets) {
  const std::size_t rule = random_index(random, 4);
  const double size = log_uniform(random, 1e-3, 0.3);
  const double smallest = log_uniform(random, 1e-5, 0.1);
  const double growth_rate = random_growth_rate(random);
  const bool several_rates = random_index(random, 3) == 0;
  SizedFacets result;
  for (const Facet& facet : facets) {
    const double start_size = rule == 0   ? size
                              : rule == 1 ? log_uniform(random, smallest, 1.0)
                                          : extent(facet);
    const double rate = several_rates ? random_growth_rate(random) : growth_rate;
    result.push_back({facet, start_size, growth_slope(rate)});
  }
  return result;
}

/// None, below all sizes, above the smallest, or reached in the middle of the box.
inline double random_limit(Random& random, const SizedFacets& facets, const Box& box) {
  double smallest = facets.front().start_size;
  for (const SizedFacet& f : facets) {
    smallest = std::min(smallest, f.start_size);
  }
  switch (random_index(random, 6)) {
    case 0:
      return 1e22;
    case 1:
      return 0.5 * smallest;
    case 2:
    case 3: {
      const Vec3 p = random_in_box(random, box);
      double size = 1e22;
      for (const SizedFacet& f : facets) {
        size = std::min(size, f.size_at(p));
      }
      return size;
    }
    default:
      return smallest * log_uniform(random, 1.5, 1e3);
  }
}

// ==== Models

inline Box box_of(const SizedFacets& facets) {
  Box box;
  for (const SizedFacet& f : facets) {
    box.extend(f.facet.box());
  }
  return box;
}

/// Around the facets, larger, beside them, in the middle of them, or of no thickness.
inline Box random_box_for(Random& random, const SizedFacets& facets) {
  const Box own = box_of(facets);
  const double size = std::max(own.sizes().maxCoeff(), 0.1);
  Box box = own;
  const auto widen = [&box](double by) {
    box = Box(box.min() - Vec3::Constant(by), box.max() + Vec3::Constant(by));
  };
  switch (random_index(random, 8)) {
    case 0:
      break;
    case 1:
      widen(size * log_uniform(random, 1.0, 30.0));
      break;
    case 2:
      box.translate(Vec3(size * random_direction(random)));
      break;
    case 3:
      box = Box(own.center() - Vec3::Constant(0.05 * size),
                own.center() + Vec3::Constant(0.1 * size));
      break;
    case 4:
      widen(0.3 * size);
      box.min().z() = box.max().z() = own.center().z();
      break;
    default:
      widen(size * uniform(random, 0.01, 0.6));
  }
  return box;
}

inline RandomModel random_model(Random& random, std::size_t most_facets) {
  RandomModel model;
  const auto count = static_cast<std::size_t>(
      std::lround(log_uniform(random, 1.0, static_cast<double>(most_facets))));
  const std::size_t kind = random_index(random, 10);
  std::vector<Facet> facets;
  switch (kind) {
    case 0:
      facets = random_clusters(random, count);
      break;
    case 1:
      facets = random_needles(random, count);
      break;
    case 2:
      facets = random_repeated(random, count);
      break;
    case 3:
    case 4:
      facets = random_surface(random, std::max<std::size_t>(count, 50));
      break;
    case 5:
      facets = random_curves(random, count);
      break;
    default:
      facets = random_mix(random, count, static_cast<FacetMix>(random_index(random, 5)));
  }
  const std::size_t flat_axes = random_index(random, 8);
  if (flat_axes == 1 || flat_axes == 2) {
    facets = flattened(facets, static_cast<int>(flat_axes), uniform(random, -1.0, 1.0));
  }
  model.facets = with_random_sizes(random, facets);
  model.box = random_box_for(random, model.facets);
  model.size_limit = random_limit(random, model.facets, model.box);
  std::ostringstream text;
  text << "kind " << kind << ", " << model.facets.size() << " facets, limit " << model.size_limit;
  model.name = text.str();
  return model;
}

// ==== Points

/// On and beside facets, within the box, on its faces, edges and corners and one number beside
/// them, outside and far outside.
inline Vec3 random_point(Random& random, const RandomModel& model) {
  const Box& box = model.box;
  const SizedFacet& f = model.facets[random_index(random, model.facets.size())];
  const double size = std::max(box.sizes().maxCoeff(), 1e-3 * model.reach());
  switch (random_index(random, 8)) {
    case 0:
      return f.facet.corners[random_index(random, 3)];
    case 1:
      return random_on_facet(random, f.facet);
    case 2:
      return random_on_facet(random, f.facet) + random_in_ball(random, 2.0 * f.start_size);
    case 3:
      return random_on_facet(random, f.facet) +
             random_in_ball(random, log_uniform(random, 1e-9 * size, size));
    case 4: {
      Vec3 p = random_in_box(random, box);
      for (std::size_t k = 1 + random_index(random, 3); k > 0; --k) {
        double& x = p[static_cast<Eigen::Index>(random_index(random, 3))];
        const auto axis = &x - p.data();
        x = random_index(random, 2) == 0 ? box.min()[axis] : box.max()[axis];
        const std::size_t beside = random_index(random, 3);
        x = beside == 0 ? x : std::nextafter(x, beside == 1 ? 1e300 : -1e300);
      }
      return p;
    }
    case 5:
      return box.center() + random_in_ball(random, size * log_uniform(random, 1.0, 1e6));
    default:
      return random_in_box(random, box);
  }
}

inline std::vector<Vec3> random_points(Random& random, const RandomModel& model,
                                       std::size_t count) {
  std::vector<Vec3> points;
  while (points.size() < count) {
    points.push_back(random_point(random, model));
  }
  return points;
}

inline std::string text_of(const Vec3& p) {
  std::ostringstream text;
  text.precision(17);
  text << "at (" << p.transpose() << ")";
  return text.str();
}

// ==== Changed models

/// Another place for every point of a model; lengths are multiplied by `scale`.
template <typename Map>
RandomModel mapped(RandomModel model, Map map, double scale) {
  for (SizedFacet& f : model.facets) {
    for (Vec3& corner : f.facet.corners) {
      corner = map(corner);
    }
    f.start_size *= scale;
  }
  model.size_limit *= scale;
  Box box;
  for (int corner = 0; corner < 8; ++corner) {
    box.extend(Vec3(map(model.box.corner(static_cast<Box::CornerType>(corner)))));
  }
  model.box = box;
  return model;
}

inline Eigen::Matrix3d random_rotation(Random& random) {
  return Eigen::AngleAxisd(uniform(random, 0.0, 6.283185307179586), random_direction(random))
      .toRotationMatrix();
}

}  // namespace meshgrow::test

#endif
