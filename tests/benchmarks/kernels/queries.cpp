#include "queries.h"

#include <algorithm>
#include <random>

#include "space_filling_curve.h"

namespace meshgrow::kernels {

namespace {

constexpr std::size_t projections_per_facet = 5;
constexpr std::size_t facets_per_run = 200;  // 1000 queries
constexpr std::size_t most_facets_without_sampling = 200000;
constexpr std::size_t sampled_facets = 50000;  // 250,000 queries

class RandomPoints {
 public:
  explicit RandomPoints(unsigned seed) : engine_(seed) {}

  double number(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }

  std::size_t index(std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(engine_);
  }

  Vec3 in_box(const Box& box) {
    const Vec3 local(number(0.0, 1.0), number(0.0, 1.0), number(0.0, 1.0));
    return box.min() + local.cwiseProduct(box.sizes());
  }

  Vec3 near(const SizedFacet& facet) {
    const double height = number(-2.0, 2.0) * facet.start_size;
    return on(facet.facet) + height * away_from(facet.facet);
  }

 private:
  Vec3 on(const Facet& facet) {
    const auto& [a, b, c] = facet.corners;
    double u = number(0.0, 1.0);
    double v = facet.corner_count == 3 ? number(0.0, 1.0) : 0.0;
    if (u + v > 1.0) {
      u = 1.0 - u;
      v = 1.0 - v;
    }
    return a + u * (b - a) + v * (c - a);
  }

  /// Unit vector.
  Vec3 away_from(const Facet& facet) {
    const auto& [a, b, c] = facet.corners;
    if (facet.corner_count == 3) {
      return (b - a).cross(c - a).normalized();
    }
    Vec3 any;
    do {
      any = in_box(Box(Vec3::Constant(-1.0), Vec3::Constant(1.0)));
    } while (any.norm() > 1.0 || (b - a).normalized().cross(any).norm() < 0.01);
    return (b - a).cross(any).normalized();
  }

  std::mt19937_64 engine_;
};

std::vector<std::uint32_t> facets_along_curve(const Input& input) {
  std::vector<Vec3> centroids;
  centroids.reserve(input.facets.size());
  for (const SizedFacet& facet : input.facets) {
    centroids.push_back(facet.facet.centroid());
  }
  return hilbert_order(centroids, input.query_box);
}

}  // namespace

std::string text(Place place) { return place == Place::near ? "near" : "volume"; }
std::string text(Order order) { return order == Order::random ? "random" : "curve"; }

std::vector<Vec3> random_points(const Input& input, Place place, std::size_t count, unsigned seed) {
  RandomPoints random(seed);
  std::vector<Vec3> points;
  points.reserve(count);
  while (points.size() < count) {
    points.push_back(place == Place::volume
                         ? random.in_box(input.query_box)
                         : random.near(input.facets[random.index(input.facets.size())]));
  }
  return points;
}

Queries make_queries(const Input& input, Place place, Order order, std::size_t count,
                     std::size_t warm_up_count, unsigned set) {
  const unsigned seed = query_seed + 10 * (set + 1);
  Queries queries{random_points(input, place, warm_up_count, seed),
                  random_points(input, place, count, seed + 1)};
  if (order == Order::curve) {
    queries.warm_up = along_curve(queries.warm_up, input.query_box);
    queries.points = along_curve(queries.points, input.query_box);
  }
  return queries;
}

ProjectionQueries projection_queries(const Input& input, unsigned seed) {
  const std::vector<std::uint32_t> facets = facets_along_curve(input);
  const std::size_t stride = facets.size() <= most_facets_without_sampling
                                 ? 1
                                 : std::max<std::size_t>(1, facets.size() / sampled_facets);
  RandomPoints random(seed);
  ProjectionQueries queries;
  for (std::size_t run = 0; run * facets_per_run < facets.size(); run += stride) {
    const std::size_t end = std::min(facets.size(), (run + 1) * facets_per_run);
    for (std::size_t i = run * facets_per_run; i < end; ++i) {
      for (std::size_t k = 0; k < projections_per_facet; ++k) {
        queries.points.push_back(random.near(input.facets[facets[i]]));
      }
    }
  }
  queries.scale = static_cast<double>(projections_per_facet * facets.size()) /
                  static_cast<double>(queries.points.size());
  // Runs lie one after the other on the curve, so sorting leaves them together.
  queries.points = along_curve(queries.points, input.query_box);
  return queries;
}

}  // namespace meshgrow::kernels
