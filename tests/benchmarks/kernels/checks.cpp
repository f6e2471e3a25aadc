#include "checks.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "brute_force.h"
#include "progress.h"
#include "queries.h"

namespace meshgrow::kernels {

namespace {

constexpr double allowed_error_of_exact_sizes = 1e-5;

enum class Wanted { size, distance };

/// Minimum over all facets one by one, by distances that share no code with the library. A facet is
/// passed over only if the sphere around it is too far away already: ten million facets against
/// hundreds of points would take minutes else.
class BruteForce {
 public:
  BruteForce(const std::vector<Vec3>& points, Wanted wanted)
      : points_(points), wanted_(wanted), best_(points.size(), FacetTree::infinity) {}

  std::vector<double> minimum_over(const SizedFacets& facets) {
    // Some facets from everywhere first, so that most others are too far away at once.
    for (std::size_t i = 0; i < facets.size(); i += 997) {
      compare(facets[i]);
    }
    for (const SizedFacet& facet : facets) {
      compare(facet);
    }
    return best_;
  }

 private:
  void compare(const SizedFacet& f) {
    const double start = wanted_ == Wanted::size ? f.start_size : 0.0;
    const double slope = wanted_ == Wanted::size ? f.slope : 1.0;
    const Vec3 centre = f.facet.centroid();
    const double radius = f.facet.radius() * (1.0 + 1e-9);
    const double per_slope = 1.0 / slope;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const double reach = (best_[i] - start) * per_slope + radius;
      if (reach > 0.0 && (points_[i] - centre).squaredNorm() <= reach * reach) {
        const double distance = static_cast<double>(test::reference_distance(f.facet, points_[i]));
        best_[i] = std::min(best_[i], start + slope * distance);
      }
    }
  }

  const std::vector<Vec3>& points_;
  Wanted wanted_;
  std::vector<double> best_;
};

}  // namespace

double Checks::Answer::relative_error() const { return std::abs(got - expected) / expected; }

void Checks::fail(const Input& input, const Answer& answer) {
  ++failures_;
  std::printf("WRONG: %s: input %s, seed %u, point (%.17g, %.17g, %.17g): %.17g instead of %.17g\n",
              answer.what, input.name.c_str(), answer.seed, answer.point.x(), answer.point.y(),
              answer.point.z(), answer.got, answer.expected);
  std::fflush(stdout);
}

void check_exact_sizes(const Input& input, const FacetTree& tree, Checks& checks) {
  constexpr std::size_t count = 200;
  std::vector<Vec3> points = random_points(input, Place::near, count / 2, query_seed);
  const std::vector<Vec3> volume = random_points(input, Place::volume, count / 2, query_seed);
  points.insert(points.end(), volume.begin(), volume.end());
  const std::vector<double> expected = BruteForce(points, Wanted::size).minimum_over(input.facets);
  std::vector<double> batch(points.size());
  tree.sizes(points.data(), points.size(), size_limit, batch.data());
  double worst = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double limited = std::min(expected[i], size_limit);
    const double single = tree.size(points[i], size_limit);
    for (const Checks::Answer& answer :
         {Checks::Answer{"tree.size against brute force", query_seed, points[i], single, limited},
          Checks::Answer{"tree.sizes against brute force", query_seed, points[i], batch[i],
                         limited}}) {
      worst = std::max(worst, answer.relative_error());
      // Asked in this way, a NaN is wrong, too.
      if (!(answer.relative_error() <= allowed_error_of_exact_sizes)) {
        checks.fail(input, answer);
      }
    }
  }
  progress("  exact sizes against brute force: worst relative error %.2g", worst);
}

void check_peer(const Input& input, const char* peer, double allowed_error,
                const std::vector<Vec3>& points, const std::vector<double>& distances,
                Checks& checks) {
  const std::vector<double> expected =
      BruteForce(points, Wanted::distance).minimum_over(input.facets);
  const double scale = input.box.sizes().maxCoeff();
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!(std::abs(distances[i] - expected[i]) <= allowed_error * scale)) {
      checks.fail(input, {peer, query_seed, points[i], distances[i], expected[i]});
    }
  }
}

}  // namespace meshgrow::kernels
