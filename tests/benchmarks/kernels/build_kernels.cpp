#include "build_kernels.h"

#include <algorithm>
#include <utility>

#include "progress.h"
#include "queries.h"
#include "timing.h"

namespace meshgrow::kernels {

namespace {

/// Trees of fewer facets are built several times in one timing: a few milliseconds say little.
constexpr std::size_t facets_per_timing = 100000;

class BuildKernels {
 public:
  BuildKernels(const Input& input, CgalPeer& cgal, const Options& options, Results& results)
      : input_(input), cgal_(cgal), options_(options), results_(results) {
    if (wants_projection()) {
      queries_ = projection_queries(input, query_seed);
      answers_.resize(queries_.points.size());
    }
  }

  void measure() {
    build_trees();
    add("tree.build.vs_cgal", cgal_build_ / tree_build_);
    if (wants_projection()) {
      project();
      add("tree.vs_projection", cgal_projection_ / (tree_build_ + batch_queries_));
      add("tree.vs_projection.single", cgal_projection_ / (tree_build_ + single_queries_));
    }
    if (!wants_grid()) {
      return;
    }
    built_.grid.reset();
    const double grid_build = seconds_of([&] { built_.grid = build_grid(input_, built_.tree, 1); });
    add("grid.build.seconds", tree_build_ + grid_build);
    if (options_.wants("grid.build.vs_projection")) {
      add("grid.build.vs_projection", cgal_projection_ / (tree_build_ + grid_build));
    }
    if (options_.wants("grid.build.threads2")) {
      add("grid.build.threads2", (tree_build_ + grid_build) / seconds_on_two_threads());
    }
  }

  /// Numbers that do not depend on the machine.
  void count_memory() {
    if (built_.grid == nullptr) {
      return;
    }
    const BackgroundGrid::Statistics& statistics = built_.grid->statistics();
    const auto leaves =
        static_cast<double>(statistics.interpolated_leaves + statistics.exact_leaves);
    const auto facets = static_cast<double>(input_.facets.size());
    const auto bytes = static_cast<double>(statistics.bytes);
    add("grid.leaves_per_facet", leaves / facets);
    add("grid.leaf_bytes", bytes / leaves);
    add("grid.bytes_per_facet", bytes / facets);
  }

  Built take() { return std::move(built_); }

 private:
  bool wants_projection() const {
    return options_.wants_any(
        {"grid.build.vs_projection", "tree.vs_projection", "tree.vs_projection.single"});
  }

  bool wants_grid() const {
    return options_.wants_any({"grid.build.vs_projection", "grid.build.seconds",
                               "grid.build.threads2", "grid.leaves_per_facet", "grid.leaf_bytes",
                               "grid.bytes_per_facet", "scale.exponent"});
  }

  void add(const std::string& name, double value) {
    // The exponent is made from the seconds of all spheres.
    const bool wanted =
        options_.wants(name) || (name == "grid.build.seconds" && options_.wants("scale.exponent"));
    if (wanted) {
      results_.add({name, input_.name}, value);
    }
  }

  /// Both trees, alternately. What each frees and the copy that ours takes over are not timed.
  void build_trees() {
    const std::size_t rounds = std::max<std::size_t>(1, facets_per_timing / input_.facets.size());
    cgal_build_ = 0.0;
    tree_build_ = 0.0;
    for (std::size_t round = 0; round < rounds; ++round) {
      cgal_.clear();
      cgal_build_ += seconds_of([&] { cgal_.build(); }) / static_cast<double>(rounds);
      built_ = {};
      SizedFacets facets = input_.facets;
      tree_build_ +=
          seconds_of([&] { built_.tree = std::make_shared<FacetTree>(std::move(facets), 1); }) /
          static_cast<double>(rounds);
    }
  }

  /// The projection's queries on both trees; of a large source by a sample, scaled up.
  void project() {
    const std::vector<Vec3>& points = queries_.points;
    cgal_projection_ =
        cgal_build_ + queries_.scale * seconds_of([&] {
                        cgal_.squared_distances(points.data(), points.size(), answers_.data());
                      });
    batch_queries_ =
        queries_.scale * seconds_of([&] {
          built_.tree->sizes(points.data(), points.size(), size_limit, answers_.data());
        });
    if (options_.wants("tree.vs_projection.single")) {
      single_queries_ = queries_.scale * seconds_of([&] {
                          for (std::size_t i = 0; i < points.size(); ++i) {
                            answers_[i] = built_.tree->size(points[i], size_limit);
                          }
                        });
    }
  }

  double seconds_on_two_threads() const {
    SizedFacets facets = input_.facets;
    std::shared_ptr<const FacetTree> tree;
    std::unique_ptr<const BackgroundGrid> grid;
    return seconds_of([&] {
      tree = std::make_shared<FacetTree>(std::move(facets), 2);
      grid = build_grid(input_, tree, 2);
    });
  }

  const Input& input_;
  CgalPeer& cgal_;
  const Options& options_;
  Results& results_;
  ProjectionQueries queries_;
  std::vector<double> answers_;
  Built built_;
  double cgal_build_ = 0.0;       ///< seconds
  double tree_build_ = 0.0;       ///< seconds
  double cgal_projection_ = 0.0;  ///< seconds of building and all queries
  double batch_queries_ = 0.0;    ///< seconds of all queries by our tree
  double single_queries_ = 0.0;   ///< the same one by one
};

}  // namespace

std::shared_ptr<const FacetTree> build_tree(const Input& input, int threads) {
  return std::make_shared<FacetTree>(input.facets, threads);
}

std::unique_ptr<const BackgroundGrid> build_grid(const Input& input,
                                                 std::shared_ptr<const FacetTree> tree,
                                                 int threads) {
  GridOptions options;
  options.tolerance = tolerance;
  options.threads = threads;
  return std::make_unique<BackgroundGrid>(std::move(tree), size_limit, input.query_box, options);
}

bool wants_build_kernels(const Options& options) {
  return options.wants_any({"tree.build.vs_cgal", "tree.vs_projection", "tree.vs_projection.single",
                            "grid.build.vs_projection", "grid.build.seconds", "grid.build.threads2",
                            "grid.leaves_per_facet", "grid.leaf_bytes", "grid.bytes_per_facet",
                            "scale.exponent"});
}

Built measure_build_kernels(const Input& input, CgalPeer& cgal, const Options& options,
                            Results& results) {
  BuildKernels kernels(input, cgal, options, results);
  for (int repetition = 0; repetition < options.repetitions; ++repetition) {
    progress("  building, repetition %d", repetition + 1);
    kernels.measure();
  }
  kernels.count_memory();
  return kernels.take();
}

}  // namespace meshgrow::kernels
