#ifndef MESHGROW_INTERVAL_MATCHING_H
#define MESHGROW_INTERVAL_MATCHING_H

#include <map>
#include <vector>

#include "entity.h"

namespace meshgrow {

/// Two sides of a mapped (transfinite) surface that need the same number of intervals. A side is
/// one curve or several in a row.
struct OppositeSides {
  Entity surface;
  std::vector<Entity> first;
  std::vector<Entity> second;
  /// Takes the place of `second` where both are fixed and that one does not fit; may be empty.
  std::vector<Entity> instead = {};
};

/// How many intervals (line elements) a curve has or wants.
struct CurveIntervals {
  int count = 1;
  bool fixed = false;  ///< meshed before or prescribed by the user
  bool even = false;   ///< Gmsh gives it even numbers only, for the recombination of a neighbour
};

/// Numbers of intervals with which all opposite sides agree: fixed curves keep theirs, of free
/// sides the larger number wins (paper, section 5.2: the "adjusted" mesh). A side of several curves
/// shares what is added or taken in proportion to the numbers wanted. Curves that `wanted` does not
/// know count as free with one interval. Throws Error that names surface and curves if there are no
/// such numbers.
std::map<Entity, int> match_intervals(const std::vector<OppositeSides>& sides,
                                      const std::map<Entity, CurveIntervals>& wanted);

}  // namespace meshgrow

#endif
