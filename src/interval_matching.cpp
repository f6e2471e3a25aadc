#include "interval_matching.h"

#include <algorithm>
#include <optional>

#include "error.h"
#include "interval_search.h"
#include "text_stream.h"

namespace meshgrow {

namespace {

class Matcher {
 public:
  Matcher(const std::vector<OppositeSides>& sides, const std::map<Entity, CurveIntervals>& wanted)
      : sides_(sides), curves_(wanted) {
    for (const OppositeSides& pair : sides_) {
      for (const std::vector<Entity>* side : {&pair.first, &pair.second, &pair.instead}) {
        for (const Entity& curve : *side) {
          curves_.insert({curve, CurveIntervals()});
        }
      }
    }
    for (OppositeSides& pair : sides_) {
      if (!pair.instead.empty() && free_curves(pair.first).empty() &&
          free_curves(pair.second).empty() && sum(pair.first) != sum(pair.second)) {
        pair.second = pair.instead;
      }
    }
    for (auto& [curve, intervals] : curves_) {
      if (!intervals.fixed && intervals.even) {
        intervals.count += intervals.count % 2;
      }
    }
    wanted_ = curves_;
  }

  std::map<Entity, int> match() {
    std::map<Entity, int> result;
    try {
      while (obey_fixed_side(1) || obey_fixed_side(most_intervals) || raise_smaller_sides()) {
      }
    } catch (const Error&) {
      // Sharing in proportion may end in a contradiction where other numbers would do.
      const std::optional<std::map<Entity, int>> found = search_intervals(sides_, wanted_);
      if (!found) {
        throw;
      }
      return *found;
    }
    for (const auto& [curve, intervals] : curves_) {
      result[curve] = intervals.count;
    }
    return result;
  }

 private:
  int sum(const std::vector<Entity>& side) const {
    int total = 0;
    for (const Entity& curve : side) {
      total += curves_.at(curve).count;
    }
    return total;
  }

  std::vector<Entity> free_curves(const std::vector<Entity>& side) const {
    std::vector<Entity> result;
    std::copy_if(side.begin(), side.end(), std::back_inserter(result),
                 [this](const Entity& curve) { return !curves_.at(curve).fixed; });
    return result;
  }

  /// Gives the free curves of one side, at most `most_free`, what the fixed other side asks of
  /// them, and fixes them. False if there is no such pair of sides.
  bool obey_fixed_side(std::size_t most_free) {
    bool any = false;
    for (const OppositeSides& pair : sides_) {
      for (const bool swapped : {false, true}) {
        const std::vector<Entity>& fixed = swapped ? pair.second : pair.first;
        const std::vector<Entity>& other = swapped ? pair.first : pair.second;
        const std::vector<Entity> free = free_curves(other);
        if (!free_curves(fixed).empty()) {
          continue;
        }
        if (free.empty() && sum(fixed) != sum(other)) {
          refuse(pair);
        }
        if (!free.empty() && free.size() <= most_free) {
          distribute(free, sum(fixed) - sum(other), pair);
          for (const Entity& curve : free) {
            curves_[curve].fixed = true;
          }
          any = true;
          if (most_free > 1) {
            return true;  // what is left may follow from it curve by curve
          }
        }
      }
    }
    return any;
  }

  bool raise_smaller_sides() {
    bool any = false;
    for (const OppositeSides& pair : sides_) {
      const int difference = sum(pair.first) - sum(pair.second);
      if (difference != 0) {
        const std::vector<Entity> raised = free_curves(difference < 0 ? pair.first : pair.second);
        // A curve on both sides adds to both: raising it is of no use.
        const std::vector<Entity>& other = difference < 0 ? pair.second : pair.first;
        if (std::any_of(raised.begin(), raised.end(), [&other](const Entity& curve) {
              return std::count(other.begin(), other.end(), curve) > 0;
            })) {
          refuse(pair);
        }
        distribute_upwards(raised, std::abs(difference));
        // Along a chain of surfaces, each may be raised once for every one behind it.
        const std::size_t most_raises = 1000 + sides_.size() * (sides_.size() + 100);
        if (sum(pair.first) > most_intervals || ++raises_ > most_raises) {
          refuse(pair);
        }
        any = true;
      }
    }
    return any;
  }

  /// How far a curve is from what it wanted: present number over wanted number.
  double stretch(const Entity& curve) const {
    return static_cast<double>(curves_.at(curve).count) / wanted_.at(curve).count;
  }
  bool less_stretched(const Entity& a, const Entity& b) const { return stretch(a) < stretch(b); }
  int step(const Entity& curve) const { return curves_.at(curve).even ? 2 : 1; }

  /// Adds at least `more` intervals.
  void distribute_upwards(const std::vector<Entity>& curves, int more) {
    while (more > 0) {
      const Entity least = *std::min_element(
          curves.begin(), curves.end(),
          [this](const Entity& a, const Entity& b) { return less_stretched(a, b); });
      curves_[least].count += step(least);
      more -= step(least);
    }
  }

  /// Adds exactly `more` intervals, or takes −`more` away.
  void distribute(const std::vector<Entity>& curves, int more, const OppositeSides& pair) {
    while (more != 0) {
      std::vector<Entity> able;
      std::copy_if(curves.begin(), curves.end(), std::back_inserter(able),
                   [this, more](const Entity& curve) {
                     return step(curve) <= std::abs(more) &&
                            (more > 0 || curves_.at(curve).count > step(curve));
                   });
      if (able.empty()) {
        refuse(pair);
      }
      const auto compare = [this](const Entity& a, const Entity& b) {
        return less_stretched(a, b);
      };
      const Entity chosen = more > 0 ? *std::min_element(able.begin(), able.end(), compare)
                                     : *std::max_element(able.begin(), able.end(), compare);
      const int change = more > 0 ? step(chosen) : -step(chosen);
      curves_[chosen].count += change;
      more -= change;
    }
  }

  std::string describe(const std::vector<Entity>& side) const {
    TextStream text;
    const char* separator = "";
    for (const Entity& curve : side) {
      const CurveIntervals& intervals = wanted_.at(curve);
      text << separator << entity_name(curve)
           << (intervals.fixed  ? " (fixed at "
               : intervals.even ? " (even, wants "
                                : " (wants ")
           << intervals.count << ')';
      separator = " + ";
    }
    return text.str();
  }

  [[noreturn]] void refuse(const OppositeSides& pair) const {
    throw Error(entity_name(pair.surface) +
                " is mapped, but its opposite sides cannot get the same number of intervals: " +
                describe(pair.first) + " against " + describe(pair.second) +
                ": give its curves other numbers, or mesh it without mapping.");
  }

  std::vector<OppositeSides> sides_;
  std::size_t raises_ = 0;
  std::map<Entity, CurveIntervals> curves_;
  std::map<Entity, CurveIntervals> wanted_;
};

}  // namespace

std::map<Entity, int> match_intervals(const std::vector<OppositeSides>& sides,
                                      const std::map<Entity, CurveIntervals>& wanted) {
  return Matcher(sides, wanted).match();
}

}  // namespace meshgrow
