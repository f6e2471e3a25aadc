#ifndef MESHGROW_INTERVAL_SEARCH_H
#define MESHGROW_INTERVAL_SEARCH_H

#include <map>
#include <optional>
#include <vector>

#include "interval_matching.h"

namespace meshgrow {

/// More intervals than any curve will have: a demand that grows beyond it has no solution.
constexpr int most_intervals = 1 << 20;

/// Numbers of intervals with which all opposite sides agree, near the wanted ones, with no free
/// curve below what it wants if that can be. Nothing if there are none or they are too hard to
/// find.
std::optional<std::map<Entity, int>> search_intervals(
    const std::vector<OppositeSides>& sides, const std::map<Entity, CurveIntervals>& wanted);

}  // namespace meshgrow

#endif
