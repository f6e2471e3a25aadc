#ifndef MESHGROW_BENCHMARKS_KERNELS_QUERIES_H
#define MESHGROW_BENCHMARKS_KERNELS_QUERIES_H

#include <string>
#include <vector>

#include "inputs.h"

namespace meshgrow::kernels {

constexpr unsigned query_seed = 20260722;

enum class Place { near, volume };
enum class Order { random, curve };

std::string text(Place place);
std::string text(Order order);

/// Random points: `volume` fills the query box uniformly; `near` starts at a random point of a
/// random facet and moves along its normal (from a segment: at a right angle to it) by up to twice
/// its start size to either side.
std::vector<Vec3> random_points(const Input& input, Place place, std::size_t count, unsigned seed);

/// Points of one timing. `warm_up` are others of the same kind, to be asked before the clock
/// starts: then the caches hold what earlier queries leave there, for whichever side is timed
/// first.
struct Queries {
  std::vector<Vec3> warm_up;
  std::vector<Vec3> points;
};

/// Sides take turns part by part, each a few milliseconds long: a neighbour on the machine that
/// comes and goes within a repetition slows all of them down.
constexpr std::size_t parts = 5;

/// `set` numbers the sets of a run: two sets have no point in common, so that of a large tree or
/// grid a timing does not find in the cache what the one before has asked for.
Queries make_queries(const Input& input, Place place, Order order, std::size_t count,
                     std::size_t warm_up_count, unsigned set);

/// Closest-point queries as a projection onto the whole source makes them: five a facet, near it,
/// along the curve. For a large source only every so many runs of 1000 queries in a row.
struct ProjectionQueries {
  std::vector<Vec3> points;
  double scale = 1.0;  ///< all queries / these queries
};

ProjectionQueries projection_queries(const Input& input, unsigned seed);

}  // namespace meshgrow::kernels

#endif
