#include "interval_search.h"

#include <algorithm>

namespace meshgrow {

namespace {

/// Narrows the ranges in which the numbers can be by each pair of sides, then tries.
class NumberSearch {
 public:
  struct Range {
    int low = 1;
    int high = 1;
  };
  using Ranges = std::map<Entity, Range>;

  NumberSearch(const std::vector<OppositeSides>& sides,
               const std::map<Entity, CurveIntervals>& wanted)
      : sides_(sides), wanted_(wanted), most_visits_(100000 + 1000 * sides.size()) {}

  /// Ranges of one number each, with no free curve below what it wanted if that can be; none if
  /// there are no such numbers or they are too hard to find.
  std::optional<Ranges> find() {
    const std::optional<Ranges> found = find(true);
    return found ? found : find(false);
  }

 private:
  std::optional<Ranges> find(bool not_below_wanted) {
    visits_ = 0;
    long long total = 16;
    for (const auto& [curve, intervals] : wanted_) {
      total += intervals.count;
    }
    const int high = static_cast<int>(std::min<long long>(2 * total, most_intervals));
    Ranges ranges;
    for (const auto& [curve, intervals] : wanted_) {
      ranges[curve] = {intervals.fixed || not_below_wanted ? intervals.count : 1,
                       intervals.fixed ? intervals.count : high};
    }
    return search(std::move(ranges));
  }

  bool narrow(Ranges& ranges, const std::vector<Entity>& side, int other_low, int other_high,
              bool& changed) const {
    int low = 0;
    int high = 0;
    for (const Entity& curve : side) {
      low += ranges[curve].low;
      high += ranges[curve].high;
    }
    for (const Entity& curve : side) {
      Range& range = ranges[curve];
      Range narrower = {std::max(range.low, other_low - (high - range.high)),
                        std::min(range.high, other_high - (low - range.low))};
      const CurveIntervals& intervals = wanted_.at(curve);
      if (intervals.even && !intervals.fixed) {
        narrower.low += narrower.low % 2;
        narrower.high -= narrower.high % 2;
      }
      if (narrower.low > narrower.high) {
        return false;
      }
      if (narrower.low != range.low || narrower.high != range.high) {
        changed = true;
        low += narrower.low - range.low;
        high += narrower.high - range.high;
        range = narrower;
      }
    }
    return true;
  }

  bool narrow(Ranges& ranges) {
    for (bool changed = true; changed;) {
      changed = false;
      for (const OppositeSides& pair : sides_) {
        for (const bool swapped : {false, true}) {
          int low = 0;
          int high = 0;
          for (const Entity& curve : swapped ? pair.first : pair.second) {
            low += ranges[curve].low;
            high += ranges[curve].high;
          }
          if (++visits_ > most_visits_ ||
              !narrow(ranges, swapped ? pair.second : pair.first, low, high, changed)) {
            return false;
          }
        }
      }
    }
    return true;
  }

  std::optional<Ranges> search(Ranges ranges) {
    if (!narrow(ranges)) {
      return std::nullopt;
    }
    const auto width = [](const Range& range) { return range.high - range.low; };
    auto narrowest = ranges.end();
    for (auto entry = ranges.begin(); entry != ranges.end(); ++entry) {
      if (width(entry->second) > 0 &&
          (narrowest == ranges.end() || width(entry->second) < width(narrowest->second))) {
        narrowest = entry;
      }
    }
    if (narrowest == ranges.end()) {
      return ranges;
    }
    const Entity curve = narrowest->first;
    const Range range = narrowest->second;
    const int wanted = std::clamp(wanted_.at(curve).count, range.low, range.high);
    for (int away = 0; away <= width(range) && visits_ <= most_visits_; ++away) {
      for (const int count : {wanted + away, wanted - away}) {
        if (count < range.low || count > range.high) {
          continue;
        }
        ranges[curve] = {count, count};
        if (const std::optional<Ranges> found = search(ranges)) {
          return found;
        }
        if (away == 0) {
          break;
        }
      }
    }
    return std::nullopt;
  }

  const std::vector<OppositeSides>& sides_;
  const std::map<Entity, CurveIntervals>& wanted_;
  std::size_t most_visits_;  ///< pairs of sides looked at, after which the search is given up
  std::size_t visits_ = 0;
};

}  // namespace

std::optional<std::map<Entity, int>> search_intervals(
    const std::vector<OppositeSides>& sides, const std::map<Entity, CurveIntervals>& wanted) {
  const std::optional<NumberSearch::Ranges> found = NumberSearch(sides, wanted).find();
  if (!found) {
    return std::nullopt;
  }
  std::map<Entity, int> result;
  for (const auto& [curve, range] : *found) {
    result[curve] = range.low;
  }
  return result;
}

}  // namespace meshgrow
