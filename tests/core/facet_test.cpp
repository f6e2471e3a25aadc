#include "facet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "brute_force.h"
#include "random_facets.h"

namespace meshgrow {
namespace {

using test::log_uniform;
using test::Random;
using test::uniform;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// A family of facets about the origin, of extent 1 or so.
struct Shape {
  std::string name;
  std::function<Facet(Random&)> make;
};

Facet thin(Random& random, double flatness) {
  return test::thin_triangle(random, test::random_in_ball(random, 1.0), 1.0, flatness);
}

/// Two long sides, the third of length `width`.
Facet needle(Random& random, double width) {
  const Vec3 a = test::random_in_ball(random, 1.0);
  const Vec3 along = test::random_direction(random);
  const Vec3 across = along.cross(test::random_direction(random)).normalized();
  return Facet::triangle(a, a + along, a + along + width * across);
}

std::vector<Shape> shapes() {
  const auto vertex = [](Random& random) { return test::random_in_ball(random, 1.0); };
  std::vector<Shape> result = {
      {"point", [=](Random& r) { return Facet::point(vertex(r)); }},
      {"segment", [=](Random& r) { return Facet::segment(vertex(r), vertex(r)); }},
      {"triangle", [=](Random& r) { return Facet::triangle(vertex(r), vertex(r), vertex(r)); }},
      {"triangle along the axes",
       [](Random&) {
         return Facet::triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
       }},
      {"zero-length segment",
       [=](Random& r) {
         const Vec3 a = vertex(r);
         return Facet::segment(a, a);
       }},
      {"short segment",
       [=](Random& r) {
         const Vec3 a = vertex(r);
         return Facet::segment(a, a + log_uniform(r, 1e-12, 1e-3) * test::random_direction(r));
       }},
      {"triangle of three coincident corners",
       [=](Random& r) {
         const Vec3 a = vertex(r);
         return Facet::triangle(a, a, a);
       }},
      {"collinear corners",
       [=](Random& r) {
         const Vec3 a = vertex(r);
         const Vec3 b = vertex(r);
         return Facet::triangle(a, b, a + uniform(r, -1.0, 2.0) * (b - a));
       }},
      {"exactly collinear corners",
       [](Random&) {
         return Facet::triangle({0, 0, 0}, {0.25, 0.5, 1}, {-0.5, -1, -2});
       }},
      {"obtuse triangle", [](Random& r) { return thin(r, 0.05); }},
      {"thin triangle of any proportions",
       [=](Random& r) {
         // The short side may point along the long ones, where it helps least.
         const Facet shape = thin(r, log_uniform(r, 1e-12, 1.0));
         const auto& [start, end, side] = shape.corners;
         return Facet::triangle(start, end, start + log_uniform(r, 1e-9, 1.0) * (side - start));
       }},
  };
  for (int twice = 0; twice < 3; ++twice) {
    result.push_back({"coincident corners " + std::to_string(twice), [=](Random& r) {
                        const Vec3 a = vertex(r);
                        const Vec3 b = vertex(r);
                        return twice == 0   ? Facet::triangle(a, a, b)
                               : twice == 1 ? Facet::triangle(a, b, a)
                                            : Facet::triangle(b, a, a);
                      }});
  }
  for (int decade = 3; decade <= 9; ++decade) {
    const double flatness = std::pow(10.0, -decade);
    const std::string of = " of 1e-" + std::to_string(decade);
    result.push_back({"sliver" + of, [=](Random& r) { return thin(r, flatness); }});
    result.push_back({"needle" + of, [=](Random& r) { return needle(r, flatness); }});
  }
  return result;
}

Facet rotated_corners(const Facet& facet, int first) {
  Facet result = facet;
  if (facet.corner_count == 3) {
    for (int i = 0; i < 3; ++i) {
      result.corners[i] = facet.corners[(first + i) % 3];
    }
  }
  return result;
}

/// Scaled about the origin, then moved.
Facet placed(Facet facet, double scale, const Vec3& offset) {
  for (Vec3& corner : facet.corners) {
    corner = scale * corner + offset;
  }
  return facet;
}

/// On the facet, close to it, beyond its corners, and very far away.
Vec3 query(Random& random, const Facet& facet, double scale) {
  const Vec3 on = test::random_on_facet(random, facet);
  switch (test::random_index(random, 5)) {
    case 0:
      return facet.corners[test::random_index(random, 3)];
    case 1:
      return on;
    case 2:
      return on + test::random_in_ball(random, scale * log_uniform(random, 1e-9, 1.0));
    case 3:
      return on + test::random_in_ball(random, scale * log_uniform(random, 1.0, 1e6));
    default: {
      // In the plane of the facet, where inside and outside are told apart.
      const auto& [a, b, c] = facet.corners;
      return a + uniform(random, -2.0, 3.0) * (b - a) + uniform(random, -2.0, 3.0) * (c - a);
    }
  }
}

std::string text_of(const Facet& facet, const Vec3& p) {
  std::ostringstream text;
  text.precision(17);
  for (int i = 0; i < facet.corner_count; ++i) {
    text << "(" << facet.corners[i].transpose() << ") ";
  }
  text << "from (" << p.transpose() << ")";
  return text.str();
}

/// Compares distances and closest points of all shapes to the reference; the error allowed is 1e-12
/// of the distance and the rounding of the coordinates.
void compare_to_reference(double scale, const Vec3& offset, unsigned seed) {
  Random random(seed);
  for (const Shape& shape : shapes()) {
    SCOPED_TRACE(shape.name + ", seed " + std::to_string(seed));
    double worst_distance = 0.0;
    double worst_place = 0.0;
    std::string worst_distance_text;
    std::string worst_place_text;
    for (int i = 0; i < 150; ++i) {
      const Facet made = placed(shape.make(random), scale, offset);
      for (int j = 0; j < 10; ++j) {
        const Facet facet = rotated_corners(made, j % 3);
        const Vec3 p = query(random, facet, scale);
        const double facet_scale = test::coordinate_scale(facet);
        const double p_scale = std::max(facet_scale, p.cwiseAbs().maxCoeff());
        const Vec3 closest = closest_point(facet, p);
        ASSERT_EQ(distance(facet, p), (closest - p).norm());
        const auto expected = static_cast<double>(test::reference_distance(facet, p));
        const double allowed = 1e-12 * expected + 4.0 * epsilon * p_scale;
        const double error = std::abs(distance(facet, p) - expected) / allowed;
        if (!(error <= worst_distance)) {
          worst_distance = error;
          worst_distance_text = text_of(facet, p);
        }
        const auto off = static_cast<double>(test::reference_distance(facet, closest));
        const double off_allowed = 8.0 * epsilon * facet_scale;
        const double place = off_allowed > 0.0 ? off / off_allowed : off;
        if (!(place <= worst_place)) {
          worst_place = place;
          worst_place_text = text_of(facet, p);
        }
      }
    }
    EXPECT_LE(worst_distance, 1.0) << "distance: " << worst_distance_text;
    EXPECT_LE(worst_place, 1.0) << "closest point off the facet: " << worst_place_text;
  }
}

TEST(Facet, DistanceEqualsTheReference) { compare_to_reference(1.0, Vec3::Zero(), 1); }

TEST(Facet, DistanceEqualsTheReferenceInSmallModels) {
  compare_to_reference(1e-9, Vec3::Zero(), 2);
}

TEST(Facet, DistanceEqualsTheReferenceInLargeModels) { compare_to_reference(1e9, Vec3::Zero(), 3); }

TEST(Facet, DistanceEqualsTheReferenceFarFromTheOrigin) {
  compare_to_reference(1.0, Vec3(1e8, -2e8, 5e7), 4);
  compare_to_reference(1e-3, Vec3(1e3, 0.0, -1e3), 5);
}

TEST(Facet, TheTwoReferencesAgree) {
  // Or else a mistake in a reference could hide one in the library.
  constexpr unsigned seed = 6;
  Random random(seed);
  for (int i = 0; i < 2000; ++i) {
    std::array<test::WideVec3, 4> x;
    for (test::WideVec3& v : x) {
      v = test::random_in_ball(random, 1.0).cast<long double>();
    }
    const auto projected =
        static_cast<double>(test::projected_triangle_distance(x[0], x[1], x[2], x[3]));
    const auto swept = static_cast<double>(test::swept_triangle_distance(x[0], x[1], x[2], x[3]));
    ASSERT_NEAR(projected, swept, 1e-13) << "round " << i << ", seed " << seed;
  }
}

TEST(Facet, ClosestPointInEveryRegionOfATriangle) {
  const Facet facet = Facet::triangle({0, 0, 0}, {4, 0, 0}, {0, 4, 0});
  const auto closest = [&](double x, double y, double z) {
    return closest_point(facet, {x, y, z});
  };
  EXPECT_EQ(closest(1, 1, 5), Vec3(1, 1, 0));    // inside
  EXPECT_EQ(closest(-1, -2, 3), Vec3(0, 0, 0));  // corners
  EXPECT_EQ(closest(9, -1, 3), Vec3(4, 0, 0));
  EXPECT_EQ(closest(-1, 9, -3), Vec3(0, 4, 0));
  EXPECT_EQ(closest(2, -7, 1), Vec3(2, 0, 0));  // sides
  EXPECT_EQ(closest(-7, 3, 1), Vec3(0, 3, 0));
  EXPECT_EQ(closest(3, 5, 2), Vec3(1, 3, 0));
  EXPECT_EQ(distance(facet, {3, 5, 1}), 3.0);  // (2, 2, 1) away from (1, 3, 0)
}

TEST(Facet, ClosestPointOfASegmentIsClampedToItsEnds) {
  const Facet facet = Facet::segment({1, 0, 0}, {3, 0, 0});
  EXPECT_EQ(closest_point(facet, {0, 5, 0}), Vec3(1, 0, 0));
  EXPECT_EQ(closest_point(facet, {2, 5, 0}), Vec3(2, 0, 0));
  EXPECT_EQ(closest_point(facet, {7, 3, 0}), Vec3(3, 0, 0));
  EXPECT_EQ(distance(facet, {7, 3, 0}), 5.0);
}

TEST(Facet, BoxAndCentroidTakeTheFacetsOwnCornersOnly) {
  Facet point = Facet::point({1, 2, 3});
  point.corners[1] = point.corners[2] = Vec3(9, 9, 9);
  EXPECT_EQ(point.box().min(), Vec3(1, 2, 3));
  EXPECT_EQ(point.box().max(), Vec3(1, 2, 3));
  EXPECT_EQ(point.centroid(), Vec3(1, 2, 3));
  EXPECT_EQ(distance(point, {1, 2, 4}), 1.0);

  Facet segment = Facet::segment({3, 0, 0}, {1, 2, -4});
  segment.corners[2] = Vec3(9, 9, 9);
  EXPECT_EQ(segment.box().min(), Vec3(1, 0, -4));
  EXPECT_EQ(segment.box().max(), Vec3(3, 2, 0));
  EXPECT_EQ(segment.centroid(), Vec3(2, 1, -2));
  EXPECT_EQ(distance(segment, {3, 0, 1}), 1.0);

  const Facet triangle = Facet::triangle({0, 0, 0}, {3, 0, 6}, {0, -3, 0});
  EXPECT_EQ(triangle.box().min(), Vec3(0, -3, 0));
  EXPECT_EQ(triangle.box().max(), Vec3(3, 0, 6));
  EXPECT_EQ(triangle.centroid(), Vec3(1, -1, 2));
}

// ==== Rays

TEST(Facet, RayDistanceEqualsTheReference) {
  // The volumes that the ray spans with each side, in extended precision.
  constexpr unsigned seed = 7;
  Random random(seed);
  int hits = 0;
  int misses = 0;
  for (int i = 0; i < 20000; ++i) {
    const double scale = log_uniform(random, 1e-6, 1e6);
    const Facet facet =
        Facet::triangle(test::random_in_ball(random, scale), test::random_in_ball(random, scale),
                        test::random_in_ball(random, scale));
    const Vec3 origin = test::random_in_ball(random, 2.0 * scale);
    const Vec3 aim =
        test::random_on_facet(random, facet) + test::random_in_ball(random, 0.3 * scale);
    const Vec3 direction = (aim - origin).normalized();
    const test::WideVec3 d = direction.cast<long double>();
    const test::WideVec3 o = origin.cast<long double>();
    const test::WideVec3 a = facet.corners[0].cast<long double>() - o;
    const test::WideVec3 b = facet.corners[1].cast<long double>() - o;
    const test::WideVec3 c = facet.corners[2].cast<long double>() - o;
    const long double u = d.dot(c.cross(b));
    const long double v = d.dot(a.cross(c));
    const long double w = d.dot(b.cross(a));
    const long double t = a.dot((b - a).cross(c - a)) / d.dot((b - a).cross(c - a));
    // So close to the border, in front or behind, that rounding may decide.
    const long double border = 1e-12L * scale * scale;
    if (std::min({std::abs(u), std::abs(v), std::abs(w)}) < border || std::abs(t) < 1e-9 * scale ||
        std::abs(u + v + w) < 1e-6 * scale * scale) {
      continue;
    }
    const bool inside = (u > 0) == (v > 0) && (v > 0) == (w > 0) && t > 0;
    const double distance = ray_distance(facet, origin, direction);
    ASSERT_EQ(std::isfinite(distance), inside) << "round " << i << ", seed " << seed;
    if (inside) {
      ASSERT_NEAR(distance, static_cast<double>(t), 1e-9 * scale)
          << "round " << i << ", seed " << seed;
    }
    (inside ? hits : misses) += 1;
  }
  EXPECT_GT(hits, 3000);
  EXPECT_GT(misses, 3000);
}

TEST(Facet, RayMeetsBordersAndBothSides) {
  const Facet facet = Facet::triangle({0, 0, 0}, {4, 0, 0}, {0, 4, 0});
  const Vec3 up(0, 0, 1);
  EXPECT_EQ(ray_distance(facet, {1, 1, -3}, up), 3.0);
  EXPECT_EQ(ray_distance(facet, {1, 1, 3}, -up), 3.0);
  EXPECT_EQ(ray_distance(facet, {1, 1, 0}, up), 0.0);
  EXPECT_EQ(ray_distance(facet, {2, 0, -3}, up), 3.0);  // on a side
  EXPECT_EQ(ray_distance(facet, {2, 2, -3}, up), 3.0);
  EXPECT_EQ(ray_distance(facet, {0, 4, -3}, up), 3.0);  // on a corner
}

TEST(Facet, RayMisses) {
  constexpr double miss = std::numeric_limits<double>::infinity();
  const Facet facet = Facet::triangle({0, 0, 0}, {4, 0, 0}, {0, 4, 0});
  const Vec3 up(0, 0, 1);
  EXPECT_EQ(ray_distance(facet, {1, 1, 3}, up), miss);  // behind
  EXPECT_EQ(ray_distance(facet, {3, 3, -3}, up), miss);
  EXPECT_EQ(ray_distance(facet, {-1, 1, 0}, Vec3(1, 0, 0)), miss);  // within the plane
  EXPECT_EQ(ray_distance(facet, {-1, 1, 1}, Vec3(1, 0, 0)), miss);
  EXPECT_EQ(ray_distance(Facet::segment({0, 0, 0}, {1, 0, 0}), {0, 0, -1}, up), miss);
  EXPECT_EQ(ray_distance(Facet::point({0, 0, 0}), {0, 0, -1}, up), miss);
  EXPECT_EQ(ray_distance(Facet::triangle({0, 0, 0}, {0, 0, 0}, {1, 0, 0}), {0, 0, -1}, up), miss);
}

TEST(Facet, NoRaySlipsThroughSharedSidesAndCorners) {
  // Fans about a corner: whatever is aimed at the corner or at a spoke meets one of its triangles.
  constexpr unsigned seed = 8;
  Random random(seed);
  for (int round = 0; round < 20000; ++round) {
    const Vec3 offset = test::random_in_ball(random, round % 3 == 0 ? 0.0 : 100.0);
    const Vec3 corner = offset + test::random_in_ball(random, 0.1);
    const int spokes = 4 + static_cast<int>(test::random_index(random, 4));
    std::vector<Vec3> rim;
    const Eigen::AngleAxisd turn(uniform(random, 0.0, 3.0), test::random_direction(random));
    for (int i = 0; i < spokes; ++i) {
      const double angle = 2.0 * 3.14159265358979 * (i + uniform(random, -0.2, 0.2)) / spokes;
      rim.push_back(offset +
                    turn * Vec3(std::cos(angle), std::sin(angle), uniform(random, -0.1, 0.1)));
    }
    const Vec3 origin = offset + turn * Vec3(uniform(random, -0.1, 0.1), uniform(random, -0.1, 0.1),
                                             uniform(random, 0.5, 3.0));
    const Vec3 on_spoke = corner + uniform(random, 0.0, 0.9) * (rim[0] - corner);
    for (const Vec3& aim : {corner, on_spoke}) {
      const Vec3 direction = (aim - origin).normalized();
      bool hit = false;
      for (int i = 0; i < spokes; ++i) {
        const Facet facet = i % 2 == 0 ? Facet::triangle(corner, rim[i], rim[(i + 1) % spokes])
                                       : Facet::triangle(rim[i], corner, rim[(i + 1) % spokes]);
        hit = hit || std::isfinite(ray_distance(facet, origin, direction));
      }
      ASSERT_TRUE(hit) << "round " << round << ", seed " << seed;
    }
  }
}

}  // namespace
}  // namespace meshgrow
