#ifndef MESHGROW_TESTS_RANDOM_FACETS_H
#define MESHGROW_TESTS_RANDOM_FACETS_H

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "sized_facets.h"

namespace meshgrow::test {

using Random = std::mt19937_64;

inline double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

/// Every decade is as likely as any other.
inline double log_uniform(Random& random, double low, double high) {
  return std::exp(uniform(random, std::log(low), std::log(high)));
}

inline std::size_t random_index(Random& random, std::size_t count) {
  return std::uniform_int_distribution<std::size_t>(0, count - 1)(random);
}

inline Vec3 random_in_box(Random& random, const Box& box) {
  Vec3 p;
  for (int axis = 0; axis < 3; ++axis) {
    p[axis] = uniform(random, box.min()[axis], std::nextafter(box.max()[axis], 1e300));
  }
  return p;
}

inline Box cube(double half_edge) {
  return Box(Vec3::Constant(-half_edge), Vec3::Constant(half_edge));
}

inline Vec3 random_in_ball(Random& random, double radius) {
  for (;;) {
    const Vec3 p = random_in_box(random, cube(1.0));
    if (p.squaredNorm() <= 1.0) {
      return radius * p;
    }
  }
}

inline Vec3 random_direction(Random& random) {
  for (;;) {
    const Vec3 p = random_in_ball(random, 1.0);
    if (p.norm() > 0.1) {
      return p.normalized();
    }
  }
}

inline Vec3 random_on_facet(Random& random, const Facet& facet) {
  const auto& [a, b, c] = facet.corners;
  const double u = uniform(random, 0.0, 1.0);
  const double v = facet.corner_count == 3 ? uniform(random, 0.0, 1.0 - u) : 0.0;
  return a + u * (b - a) + v * (c - a);
}

/// A triangle whose height over its longest side is `flatness` of that side.
inline Facet thin_triangle(Random& random, const Vec3& a, double length, double flatness) {
  const Vec3 along = random_direction(random);
  const Vec3 across = along.cross(random_direction(random)).normalized();
  const Vec3 b = a + length * along;
  const Vec3 c = a + uniform(random, 0.0, 1.0) * (b - a) + flatness * length * across;
  return Facet::triangle(a, b, c);
}

/// degenerate: zero length, zero area, coincident, and needles.
enum class FacetMix { points, segments, triangles, mixed, degenerate };

inline std::string mix_name(FacetMix mix) {
  static const char* const names[] = {"points", "segments", "triangles", "mixed", "degenerate"};
  return names[static_cast<int>(mix)];
}

struct RandomFacets {
  FacetMix mix = FacetMix::mixed;
  std::size_t count = 100;
  Box box = cube(1.0);
  double shortest = 0.01;  ///< extent of a facet
  double longest = 0.5;
  double smallest_size = 1e-6;  ///< start size
  double largest_size = 1.0;
  std::vector<double> slopes = {0.01, 1.0 / 21.0, 1.0 / 6.0, 0.5, 0.8};
};

inline Facet random_degenerate_facet(Random& random, const Vec3& a, double length,
                                     const SizedFacets& earlier) {
  const Vec3 b = a + length * random_direction(random);
  switch (random_index(random, 6)) {
    case 0:
      return Facet::segment(a, a);
    case 1:
      return Facet::triangle(a, a, a);
    case 2:
      return Facet::triangle(a, b, a + uniform(random, -1.0, 2.0) * (b - a));
    case 3:
      return Facet::triangle(a, b, b);
    case 4:
      return thin_triangle(random, a, length, log_uniform(random, 1e-9, 1e-3));
    default:
      return earlier.empty() ? Facet::segment(a, b)
                             : earlier[random_index(random, earlier.size())].facet;
  }
}

inline SizedFacets random_facets(Random& random, const RandomFacets& wanted) {
  SizedFacets facets;
  while (facets.size() < wanted.count) {
    const Vec3 a = random_in_box(random, wanted.box);
    const double length = log_uniform(random, wanted.shortest, wanted.longest);
    const Vec3 b = a + length * random_direction(random);
    const Vec3 c = a + length * random_direction(random);
    FacetMix mix = wanted.mix;
    if (mix == FacetMix::mixed) {
      mix = static_cast<FacetMix>(random_index(random, 3));
    }
    const Facet facet = mix == FacetMix::points     ? Facet::point(a)
                        : mix == FacetMix::segments ? Facet::segment(a, b)
                        : mix == FacetMix::triangles
                            ? Facet::triangle(a, b, c)
                            : random_degenerate_facet(random, a, length, facets);
    facets.push_back({facet, log_uniform(random, wanted.smallest_size, wanted.largest_size),
                      wanted.slopes[random_index(random, wanted.slopes.size())]});
  }
  return facets;
}

/// Scattered over the surroundings, close to facets, on facets and their corners, and far away.
template <typename Facets>
Vec3 random_query(Random& random, const Facets& facets, const Box& box) {
  const Facet& facet = facets[random_index(random, facets.size())].facet;
  const double reach = box.sizes().maxCoeff();
  switch (random_index(random, 8)) {
    case 0:
      return facet.corners[random_index(random, 3)];
    case 1:
      return random_on_facet(random, facet);
    case 2:
    case 3:
    case 4:
      return random_on_facet(random, facet) +
             random_in_ball(random, log_uniform(random, 1e-6 * reach, reach));
    case 5:
      return box.center() + random_in_ball(random, log_uniform(random, reach, 1e3 * reach));
    default:
      return random_in_box(random,
                           Box(box.min() - 0.5 * box.sizes(), box.max() + 0.5 * box.sizes()));
  }
}

}  // namespace meshgrow::test

#endif
