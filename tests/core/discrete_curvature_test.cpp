#include "discrete_curvature.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "random_facets.h"

namespace meshgrow {
namespace {

using test::Random;
using test::uniform;

using Segment = std::array<Vec3, 2>;
using Segments = std::vector<Segment>;
using Triangle = std::array<Vec3, 3>;
using Triangles = std::vector<Triangle>;
using Curvature = std::function<double(const Vec3&)>;
using Map = std::function<Vec3(double, double)>;

const double pi = std::acos(-1.0);
const unsigned seed = 20240607;

// ==== Shapes

template <std::size_t corner_count>
Vec3 centre(const std::array<Vec3, corner_count>& facet) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& corner : facet) {
    sum += corner;
  }
  return sum / static_cast<double>(corner_count);
}

/// Any order of the facets; any direction or orientation of each.
template <typename Facets>
Facets scrambled(Facets facets, Random& random) {
  std::shuffle(facets.begin(), facets.end(), random);
  for (auto& facet : facets) {
    std::shuffle(facet.begin(), facet.end(), random);
  }
  return facets;
}

Segments polyline(int count, const std::function<Vec3(double)>& map) {
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    points.push_back(map(2.0 * pi * i / count));
  }
  Segments segments;
  for (int i = 0; i < count; ++i) {
    segments.push_back({points[i], points[(i + 1) % count]});
  }
  return segments;
}

enum class Diagonals { equal, alternating, random };

struct Patch {
  int columns;
  int rows;
  bool closed_columns = false;
  bool closed_rows = false;
  Diagonals diagonals = Diagonals::equal;
};

/// Of the unit square, mapped.
Triangles patch(const Patch& wanted, const Map& map) {
  Random random(seed);
  const auto point = [&](int i, int j) {
    const int column = wanted.closed_columns ? i % wanted.columns : i;
    const int row = wanted.closed_rows ? j % wanted.rows : j;
    return map(double(column) / wanted.columns, double(row) / wanted.rows);
  };
  Triangles triangles;
  const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    if (a != b && b != c && c != a) {
      triangles.push_back({a, b, c});
    }
  };
  for (int i = 0; i < wanted.columns; ++i) {
    for (int j = 0; j < wanted.rows; ++j) {
      const Vec3 a = point(i, j), b = point(i + 1, j), c = point(i + 1, j + 1), d = point(i, j + 1);
      const bool other = (wanted.diagonals == Diagonals::alternating && (i + j) % 2 == 1) ||
                         (wanted.diagonals == Diagonals::random && random() % 2 == 1);
      add(a, b, other ? d : c);
      add(other ? b : a, c, d);
    }
  }
  return triangles;
}

Map cylinder(double radius, double height, double turn = 1.0) {
  return [=](double u, double v) {
    const double angle = 2.0 * pi * turn * u;
    return Vec3(radius * std::cos(angle), radius * std::sin(angle), height * v);
  };
}

/// v from pole to pole.
Map ellipsoid(double a, double b, double c) {
  return [=](double u, double v) {
    const double sine = v == 1.0 ? 0.0 : std::sin(pi * v);
    return Vec3(a * sine * std::cos(2.0 * pi * u), b * sine * std::sin(2.0 * pi * u),
                c * std::cos(pi * v));
  };
}

Map torus(double ring, double tube) {
  return [=](double u, double v) {
    const double radius = ring + tube * std::cos(2.0 * pi * v);
    return Vec3(radius * std::cos(2.0 * pi * u), radius * std::sin(2.0 * pi * u),
                tube * std::sin(2.0 * pi * v));
  };
}

Curvature torus_curvature(double ring, double tube) {
  return [=](const Vec3& p) {
    const double out = std::hypot(p.x(), p.y()) - ring;
    const double cosine = out / std::hypot(out, p.z());
    return std::max(1.0 / tube, std::abs(cosine / (ring + tube * cosine)));
  };
}

/// Of the quadric x^2/a^2 + y^2/b^2 + z^2/c^2 = 1, at the point on the ray to p.
Curvature ellipsoid_curvature(double a, double b, double c) {
  return [=](const Vec3& p) {
    const Vec3 form(1.0 / (a * a), 1.0 / (b * b), 1.0 / (c * c));
    const Vec3 on = p / std::sqrt(form.dot(p.cwiseProduct(p)));
    const Vec3 gradient = form.cwiseProduct(on);
    const Vec3 normal = gradient.normalized();
    const Eigen::Matrix3d flat = Eigen::Matrix3d::Identity() - normal * normal.transpose();
    const Eigen::Matrix3d shape = flat * form.asDiagonal() * flat / gradient.norm();
    const double sum = shape.trace();
    const double squares = (shape * shape).trace();
    return 0.5 * (sum + std::sqrt(std::max(0.0, 2.0 * squares - sum * sum)));
  };
}

Curvature constant(double value) {
  return [=](const Vec3&) { return value; };
}

Triangles octasphere(int level) {
  Triangles triangles;
  for (int octant = 0; octant < 8; ++octant) {
    const auto side = [&](int bit) { return (octant >> bit & 1) != 0 ? -1.0 : 1.0; };
    triangles.push_back({Vec3(side(0), 0, 0), Vec3(0, side(1), 0), Vec3(0, 0, side(2))});
  }
  for (int i = 0; i < level; ++i) {
    Triangles finer;
    for (const auto& [a, b, c] : triangles) {
      const Vec3 ab = (a + b).normalized(), bc = (b + c).normalized(), ca = (c + a).normalized();
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    triangles = finer;
  }
  return triangles;
}

Triangles icosphere(int level) {
  const double g = 0.5 * (1.0 + std::sqrt(5.0));
  std::vector<Vec3> points;
  for (const double one : {-1.0, 1.0}) {
    for (const double golden : {-g, g}) {
      points.insert(points.end(),
                    {Vec3(0, one, golden), Vec3(one, golden, 0), Vec3(golden, 0, one)});
    }
  }
  Triangles triangles;
  const auto joined = [](const Vec3& a, const Vec3& b) {
    return std::abs((a - b).norm() - 2) < 0.1;
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      for (std::size_t k = 0; k < j; ++k) {
        if (joined(points[i], points[j]) && joined(points[j], points[k]) &&
            joined(points[k], points[i])) {
          triangles.push_back(
              {points[i].normalized(), points[j].normalized(), points[k].normalized()});
        }
      }
    }
  }
  for (int i = 0; i < level; ++i) {
    Triangles finer;
    for (const auto& [a, b, c] : triangles) {
      const Vec3 ab = (a + b).normalized(), bc = (b + c).normalized(), ca = (c + a).normalized();
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    triangles = finer;
  }
  return triangles;
}

Triangles joined(Triangles one, const Triangles& other) {
  one.insert(one.end(), other.begin(), other.end());
  return one;
}

/// Two unit squares that share an edge and turn there.
Triangles fold(double degrees, int pieces) {
  const double turn = degrees * pi / 180.0;
  return patch({2 * pieces, pieces}, [=](double u, double v) {
    const double x = 2.0 * u - 1.0;
    return x <= 0.0 ? Vec3(x, v, 0) : Vec3(x * std::cos(turn), v, x * std::sin(turn));
  });
}

// ==== Checks

/// Worst relative error; with `expected` 0, the worst absolute one.
template <typename Facets>
double worst_error(const Facets& facets, const std::vector<double>& curvatures,
                   const Curvature& expected) {
  EXPECT_EQ(curvatures.size(), facets.size());
  double worst = 0.0;
  for (std::size_t i = 0; i < facets.size(); ++i) {
    const double exact = expected(centre(facets[i]));
    const double error = std::abs(curvatures[i] - exact) / (exact > 0.0 ? exact : 1.0);
    worst = error <= worst ? worst : error;  // NaN is the worst
  }
  return worst;
}

void expect_curvature(const std::string& name, const Triangles& ordered, const Curvature& expected,
                      double tolerance) {
  Random random(seed);
  const Triangles triangles = scrambled(ordered, random);
  const double worst = worst_error(triangles, triangle_curvatures(triangles), expected);
  ::testing::Test::RecordProperty(name, std::to_string(worst));
  EXPECT_LE(worst, tolerance) << name << ": worst error " << 100.0 * worst << " %, "
                              << triangles.size() << " triangles, seed " << seed;
}

void expect_polyline(const std::string& name, const Segments& ordered, const Curvature& expected,
                     double tolerance) {
  Random random(seed);
  const Segments segments = scrambled(ordered, random);
  const double worst = worst_error(segments, segment_curvatures(segments), expected);
  ::testing::Test::RecordProperty(name, std::to_string(worst));
  EXPECT_LE(worst, tolerance) << name << ": worst error " << 100.0 * worst << " %, seed " << seed;
}

const Diagonals all_diagonals[] = {Diagonals::equal, Diagonals::alternating, Diagonals::random};

// ==== Segments

TEST(SegmentCurvature, IsExactOnACircleOfAnySize) {
  for (const double radius : {1e-9, 1.0, 1e9}) {
    for (const int count : {9, 10, 24, 1000}) {
      expect_polyline("circle of " + std::to_string(count),
                      polyline(count,
                               [=](double t) {
                                 return Vec3(radius * std::cos(t), radius * std::sin(t), radius);
                               }),
                      constant(1.0 / radius), 1e-6);
    }
  }
}

TEST(SegmentCurvature, FollowsAnEllipse) {
  const double a = 2.0, b = 1.0;
  const Curvature exact = [=](const Vec3& p) {
    const double t = std::atan2(p.y() / b, p.x() / a);
    return a * b / std::pow(std::hypot(a * std::sin(t), b * std::cos(t)), 3.0);
  };
  const auto ellipse = [=](double t) { return Vec3(a * std::cos(t), b * std::sin(t), 0); };
  // A segment has the larger curvature of its two ends, not that of its middle.
  expect_polyline("ellipse of 48", polyline(48, ellipse), exact, 0.2);
  expect_polyline("ellipse of 96", polyline(96, ellipse), exact, 0.1);
}

TEST(SegmentCurvature, IsNoneAtEndsCornersBranchesAndOnNothing) {
  const auto curvatures_of = [](const Segments& segments) { return segment_curvatures(segments); };
  EXPECT_TRUE(curvatures_of({}).empty());
  const Vec3 o(0, 0, 0), x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(curvatures_of({{o, x}}), std::vector<double>(1, 0.0));
  EXPECT_EQ(curvatures_of({{o, x}, {o, y}}), std::vector<double>(2, 0.0)) << "corner";
  EXPECT_EQ(curvatures_of({{o, x}, {x, 2 * x}}), std::vector<double>(2, 0.0)) << "straight";
  EXPECT_EQ(curvatures_of({{o, x}, {x, o}}), std::vector<double>(2, 0.0)) << "there and back";
  const Vec3 bend = 2 * x + 0.2 * y;
  EXPECT_GT(curvatures_of({{o, x}, {x, bend}})[0], 0.1);
  EXPECT_EQ(curvatures_of({{o, x}, {x, bend}, {x, x + z}}), std::vector<double>(3, 0.0))
      << "branch";
  const std::vector<double> broken =
      curvatures_of({{o, x}, {bend, x}, {x, x}, {x, Vec3(nan, 0, 0)}});
  EXPECT_GT(broken[0], 0.1) << "what has no length, or no place, is left out";
  EXPECT_EQ(broken[2], 0.0);
  EXPECT_EQ(broken[3], 0.0);
  EXPECT_GT(
      curvatures_of({{Vec3(-1, 0, 0), Vec3(0.0, 0, 0)}, {Vec3(-0.0, 0, 0), Vec3(1, 0.2, 0)}})[0],
      0.1)
      << "negative zero";
}

// ==== Triangles: smooth surfaces

TEST(TriangleCurvature, IsExactOnRegularCylinders) {
  for (const Diagonals diagonals : all_diagonals) {
    for (const double height : {0.0003, 0.3, 3.0, 300.0}) {
      for (const int rows : {1, 2, 8}) {
        for (const int columns : {10, 24, 100}) {
          expect_curvature("cylinder",
                           patch({columns, rows, true, false, diagonals}, cylinder(2.0, height)),
                           constant(0.5), 1e-4);
        }
      }
    }
  }
}

TEST(TriangleCurvature, IsExactOnCylindersWithStripsOfUnequalWidth) {
  const Map uneven = [](double u, double v) {
    return cylinder(1.0, 2.0)(u + 0.1 * std::sin(2.0 * pi * u), v);
  };
  for (const int rows : {1, 5}) {
    expect_curvature("uneven cylinder", patch({48, rows, true}, uneven), constant(1.0), 1e-6);
  }
}

TEST(TriangleCurvature, HoldsAtTheStraightBordersOfACylinder) {
  for (const Diagonals diagonals : all_diagonals) {
    for (const int rows : {1, 2, 5}) {
      expect_curvature("half cylinder " + std::to_string(rows),
                       patch({12, rows, false, false, diagonals}, cylinder(1.0, 3.0, 0.5)),
                       constant(1.0), 0.03);
      expect_curvature("quarter cylinder " + std::to_string(rows),
                       patch({6, rows, false, false, diagonals}, cylinder(1.0, 3.0, 0.25)),
                       constant(1.0), 0.03);
    }
  }
}

TEST(TriangleCurvature, HoldsForStlCoordinatesInSinglePrecision) {
  for (const int columns : {24, 1000}) {
    Triangles triangles = patch({columns, 5, true}, cylinder(10.0, 20.0));
    for (Triangle& triangle : triangles) {
      for (Vec3& corner : triangle) {
        corner = corner.cast<float>().cast<double>();
      }
    }
    expect_curvature("cylinder in floats", triangles, constant(0.1), 0.01);
  }
}

TEST(TriangleCurvature, IsExactOnSpheres) {
  for (const Diagonals diagonals : all_diagonals) {
    expect_curvature("UV sphere", patch({24, 12, true, false, diagonals}, ellipsoid(2, 2, 2)),
                     constant(0.5), 1e-6);
  }
  for (int level = 1; level < 5; ++level) {
    expect_curvature("icosphere", icosphere(level), constant(1.0), 1e-6);
  }
  for (int level = 2; level < 5; ++level) {
    expect_curvature("octasphere", octasphere(level), constant(1.0), 1e-6);
  }
}

TEST(TriangleCurvature, HoldsAtTheBordersOfASphere) {
  for (const Diagonals diagonals : all_diagonals) {
    expect_curvature("half sphere",
                     patch({24, 6, true, false, diagonals},
                           [](double u, double v) { return ellipsoid(1, 1, 1)(u, 0.5 * v); }),
                     constant(1.0), 0.01);
    expect_curvature("square of a sphere",
                     patch({6, 6, false, false, diagonals},
                           [](double u, double v) {
                             return Vec3(1.4 * u - 0.7, 1.4 * v - 0.7, 1).normalized();
                           }),
                     constant(1.0), 0.02);
  }
}

TEST(TriangleCurvature, FollowsATorus) {
  for (const Diagonals diagonals : all_diagonals) {
    expect_curvature("torus 3:1", patch({24, 24, true, true, diagonals}, torus(3, 1)),
                     torus_curvature(3, 1), 0.1);
    expect_curvature("torus 1.3:1", patch({48, 48, true, true, diagonals}, torus(1.3, 1)),
                     torus_curvature(1.3, 1), 0.1);
  }
}

TEST(TriangleCurvature, FollowsAnEllipsoid) {
  const Curvature exact = ellipsoid_curvature(2, 1.5, 1);
  const auto facets = [](int columns, Diagonals diagonals) {
    return patch({columns, columns / 2, true, false, diagonals}, ellipsoid(2, 1.5, 1));
  };
  for (const Diagonals diagonals : {Diagonals::equal, Diagonals::alternating}) {
    expect_curvature("ellipsoid of 24", facets(24, diagonals), exact, 0.14);
    expect_curvature("ellipsoid of 36", facets(36, diagonals), exact, 0.1);
    expect_curvature("ellipsoid of 96", facets(96, diagonals), exact, 0.05);
  }
  expect_curvature("ellipsoid of 24, random", facets(24, Diagonals::random), exact, 0.2);
}

/// A triangle is as curved as the circle at the edge that it has there: the error is the circles'
/// difference.
TEST(TriangleCurvature, FollowsACone) {
  const double slope = pi / 4.0;
  const Map frustum = [](double u, double v) { return cylinder(1.0 + v, v)(u, 1.0); };
  const Curvature exact = [=](const Vec3& p) { return std::cos(slope) / std::hypot(p.x(), p.y()); };
  for (const Diagonals diagonals : all_diagonals) {
    expect_curvature("cone", patch({24, 8, true, false, diagonals}, frustum), exact, 0.1);
    expect_curvature("half cone",
                     patch({12, 8, false, false, diagonals},
                           [&](double u, double v) { return frustum(0.5 * u, v); }),
                     exact, 0.1);
  }
}

TEST(TriangleCurvature, IsFiniteAtTheTipOfACone) {
  const Triangles cone = patch({24, 1, true}, [](double u, double v) {
    return v == 0.0 ? Vec3(0, 0, 1) : cylinder(1.0, 0.0)(u, v);
  });
  ASSERT_EQ(cone.size(), 24U);
  // Of the base circle; twice that in the middle.
  expect_curvature("cone of one strip", cone, constant(std::cos(pi / 4.0)), 0.02);
}

// ==== Triangles: flat, folded, broken

TEST(TriangleCurvature, IsZeroWhereFlat) {
  const Map square = [](double u, double v) { return Vec3(u, v, 3.0); };
  for (const Diagonals diagonals : all_diagonals) {
    expect_curvature("square", patch({5, 7, false, false, diagonals}, square), constant(0.0), 1e-9);
  }
  expect_curvature("one triangle", {{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}}, constant(0.0),
                   0.0);
  Triangles box;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {0.0, 1.0}) {
      box = joined(box, patch({4, 4}, [=](double u, double v) {
                     Vec3 p;
                     p[axis] = side;
                     p[(axis + 1) % 3] = u;
                     p[(axis + 2) % 3] = v;
                     return p;
                   }));
    }
  }
  expect_curvature("box", box, constant(0.0), 1e-9);
}

TEST(TriangleCurvature, StopsAtTheEdgeOfACylindersCaps) {
  const Map bottom = [](double u, double v) { return Vec3(v * cylinder(2, 0)(u, 0)); };
  const Map top = [](double u, double v) {
    const Vec3 rim = cylinder(2, 3)(u, 1);
    return Vec3(v * rim.x(), v * rim.y(), rim.z());
  };
  for (const int rows : {1, 4}) {
    const Triangles all =
        joined(joined(patch({24, rows, true}, cylinder(2, 3)), patch({24, rows, true}, bottom)),
               patch({24, rows, true}, top));
    expect_curvature(
        "capped cylinder", all,
        [](const Vec3& p) { return p.z() > 1e-9 && p.z() < 3.0 - 1e-9 ? 0.5 : 0.0; }, 1e-4);
  }
}

TEST(TriangleCurvature, CountsAFoldUnlessItIsACrease) {
  for (const int pieces : {1, 4}) {
    const Triangles smooth = fold(30.0, pieces);
    const std::vector<double> curvatures = triangle_curvatures(smooth);
    EXPECT_GT(*std::max_element(curvatures.begin(), curvatures.end()), 0.2);
    expect_curvature("fold of 50 degrees", fold(50.0, pieces), constant(0.0), 1e-9);
  }
}

TEST(TriangleCurvature, TakesTheEdgeOfThreeSheetsForABorder) {
  const Triangles flat = patch({4, 4}, [](double u, double v) { return Vec3(2 * u - 1, v, 0); });
  const Triangles wall = patch({4, 4}, [](double u, double v) { return Vec3(0, v, u); });
  expect_curvature("T", joined(flat, wall), constant(0.0), 1e-9);
}

TEST(TriangleCurvature, IsZeroAtDegenerateTrianglesAndNotDisturbedByThem) {
  const Triangles sound = patch({24, 4, true}, cylinder(2, 3));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const Vec3 a = sound[0][0], b = sound[0][1];
  const Triangles broken = {{a, a, a},
                            {a, b, a},
                            {a, b, 0.5 * (a + b)},
                            {a, b, Vec3(nan, 0, 0)},
                            {a, b, Vec3(0, infinity, 0)},
                            {a, b, Vec3(1e200, 0, 0)}};
  const std::vector<double> curvatures = triangle_curvatures(joined(sound, broken));
  for (std::size_t i = 0; i < sound.size(); ++i) {
    EXPECT_NEAR(curvatures[i], 0.5, 1e-4) << i;
  }
  for (std::size_t i = sound.size(); i < curvatures.size(); ++i) {
    EXPECT_EQ(curvatures[i], 0.0) << i - sound.size();
  }
  EXPECT_TRUE(triangle_curvatures({}).empty());
}

TEST(TriangleCurvature, NeedsNoOrientableSurface) {
  const double width = 0.2;
  const auto moebius = [&](int count) {
    const auto point = [&](int i, double across) {
      const double side = i == count ? -across : across;
      const double t = 2.0 * pi * (i % count) / count;
      const double radius = 1.0 + width * side * std::cos(0.5 * t);
      return Vec3(radius * std::cos(t), radius * std::sin(t), width * side * std::sin(0.5 * t));
    };
    Triangles strip;
    for (int i = 0; i < count; ++i) {
      for (const double side : {-1.0, 0.0}) {
        const Vec3 c = point(i + 1, side + 1.0), a = point(i, side);
        strip.push_back({a, point(i + 1, side), c});
        strip.push_back({a, c, point(i, side + 1.0)});
      }
    }
    return strip;
  };
  const std::vector<double> curvatures = triangle_curvatures(moebius(60));
  EXPECT_GT(*std::min_element(curvatures.begin(), curvatures.end()), 0.3);
  EXPECT_LT(*std::max_element(curvatures.begin(), curvatures.end()), 2.0);
}

// ==== Invariance

TEST(TriangleCurvature, DependsOnNeitherOrderOrientationPlaceNorScale) {
  const Triangles original = joined(
      patch({24, 12, true, false, Diagonals::random}, ellipsoid(2, 1.5, 1)),
      patch({12, 5, false, false, Diagonals::random},
            [](double u, double v) { return Vec3(cylinder(1, 3, 0.5)(u, v) + Vec3(5, 0, 0)); }));
  const std::vector<double> expected = triangle_curvatures(original);
  for (unsigned round = 0; round < 20; ++round) {
    Random random(seed + round);
    const double scale = test::log_uniform(random, 1e-9, 1e9);
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(uniform(random, 0.0, 2.0 * pi), test::random_direction(random))
            .toRotationMatrix();
    std::vector<std::size_t> order(original.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
      order[i] = i;
    }
    std::shuffle(order.begin(), order.end(), random);
    Triangles changed;
    for (const std::size_t i : order) {
      Triangle triangle = original[i];
      std::shuffle(triangle.begin(), triangle.end(), random);
      for (Vec3& corner : triangle) {
        corner = scale * (turn * corner);
      }
      changed.push_back(triangle);
    }
    const std::vector<double> curvatures = triangle_curvatures(changed);
    double worst = 0.0;
    for (std::size_t i = 0; i < order.size(); ++i) {
      worst = std::max(worst, std::abs(curvatures[i] * scale / expected[order[i]] - 1.0));
    }
    EXPECT_LE(worst, 1e-6) << "seed " << seed + round << ", scale " << scale;
  }
}

}  // namespace
}  // namespace meshgrow
