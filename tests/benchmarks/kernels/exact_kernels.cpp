#include "exact_kernels.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "embree_peer.h"
#include "progress.h"
#include "queries.h"
#include "timing.h"

namespace meshgrow::kernels {

namespace {

constexpr std::size_t checked_points = 50;

class ExactKernels {
 public:
  ExactKernels(const Input& input, const FacetTree& tree, const CgalPeer& cgal,
               const EmbreePeer* embree, const Options& options, Results& results)
      : input_(input),
        tree_(tree),
        cgal_(cgal),
        embree_(embree),
        options_(options),
        results_(results),
        answers_(options.query_count) {}

  void measure(Place place, Order order, unsigned set) {
    const std::size_t count = options_.query_count;
    const Queries queries = make_queries(input_, place, order, count, count / 4, set);
    const bool with_embree = place == Place::near && embree_ != nullptr;
    Seconds seconds;
    for (std::size_t part = 0; part < parts; ++part) {
      measure_part(queries, part, with_embree, seconds);
    }
    add("exact.vs_cgal." + text(place), order, seconds.cgal / seconds.single);
    add("exact.vs_cgal." + text(place) + ".batch", order, seconds.cgal / seconds.batch);
    if (with_embree) {
      add("exact.vs_embree.near", order, seconds.embree / seconds.single);
    }
  }

 private:
  struct Seconds {
    double batch = 0.0;
    double cgal = 0.0;
    double single = 0.0;
    double embree = 0.0;
  };

  /// All sides one after the other on the same points. CGAL's turn lies between our two, so that
  /// the second does not find the way of the first in the cache.
  void measure_part(const Queries& queries, std::size_t part, bool with_embree, Seconds& seconds) {
    seconds.batch += warm_seconds_of(queries, part, [&](const Vec3* points, std::size_t count) {
      tree_.sizes(points, count, size_limit, answers_.data());
    });
    seconds.cgal += warm_seconds_of(queries, part, [&](const Vec3* points, std::size_t count) {
      cgal_.squared_distances(points, count, answers_.data());
    });
    seconds.single += warm_seconds_of(queries, part, [&](const Vec3* points, std::size_t count) {
      for (std::size_t i = 0; i < count; ++i) {
        answers_[i] = tree_.size(points[i], size_limit);
      }
    });
    if (with_embree) {
      seconds.embree += warm_seconds_of(queries, part, [&](const Vec3* points, std::size_t count) {
        embree_->distances(points, count, answers_.data());
      });
    }
  }

  void add(const std::string& name, Order order, double value) {
    if (options_.wants(name)) {
      results_.add({name, input_.name, text(order)}, value);
    }
  }

  const Input& input_;
  const FacetTree& tree_;
  const CgalPeer& cgal_;
  const EmbreePeer* embree_;
  const Options& options_;
  Results& results_;
  std::vector<double> answers_;
};

void check_peers(const Input& input, const CgalPeer& cgal, const EmbreePeer* embree,
                 Checks& checks) {
  const std::vector<Vec3> points = random_points(input, Place::near, checked_points, query_seed);
  std::vector<double> distances(points.size());
  cgal.squared_distances(points.data(), points.size(), distances.data());
  std::transform(distances.begin(), distances.end(), distances.begin(),
                 [](double squared) { return std::sqrt(squared); });
  check_peer(input, "CGAL against brute force", 1e-9, points, distances, checks);
  if (embree != nullptr) {
    embree->distances(points.data(), points.size(), distances.data());
    check_peer(input, "Embree against brute force", 1e-5, points, distances, checks);
  }
}

bool wants_place(const Options& options, Place place) {
  const std::string name = "exact.vs_cgal." + text(place);
  return options.wants(name) || options.wants(name + ".batch") ||
         (place == Place::near && options.wants("exact.vs_embree.near"));
}

}  // namespace

bool wants_exact_kernels(const Options& options) {
  return wants_place(options, Place::near) || wants_place(options, Place::volume);
}

void measure_exact_kernels(const Input& input, const FacetTree& tree, const CgalPeer& cgal,
                           const Options& options, Results& results, Checks& checks) {
  std::unique_ptr<EmbreePeer> embree;
  if (input.has_triangles() && options.wants("exact.vs_embree.near")) {
    embree = std::make_unique<EmbreePeer>(input.facets);
  }
  check_peers(input, cgal, embree.get(), checks);
  ExactKernels kernels(input, tree, cgal, embree.get(), options, results);
  unsigned set = 0;
  for (int repetition = 0; repetition < options.repetitions; ++repetition) {
    progress("  exact sizes, repetition %d", repetition + 1);
    for (const Place place : {Place::near, Place::volume}) {
      for (const Order order : {Order::random, Order::curve}) {
        if (wants_place(options, place)) {
          kernels.measure(place, order, set++);
        }
      }
    }
  }
}

}  // namespace meshgrow::kernels
