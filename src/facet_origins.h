#ifndef MESHGROW_FACET_ORIGINS_H
#define MESHGROW_FACET_ORIGINS_H

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "entity.h"

namespace meshgrow {

/// Which entities the facets of a set are of: stretches of facets, one after the other.
class FacetOrigins {
 public:
  /// A stretch begins with the facet of this index, which is not below those of earlier stretches.
  void begin(std::size_t first_facet, const Entity& entity) {
    if (!stretches_.empty() && stretches_.back().first == first_facet) {
      stretches_.pop_back();  // it had no facet
    }
    if (stretches_.empty() || stretches_.back().second != entity) {
      stretches_.emplace_back(first_facet, entity);
    }
  }

  /// Nothing for a facet before the first stretch.
  std::optional<Entity> entity_of(std::size_t facet) const {
    const auto after =
        std::upper_bound(stretches_.begin(), stretches_.end(), facet,
                         [](std::size_t index, const auto& s) { return index < s.first; });
    return after == stretches_.begin() ? std::nullopt
                                       : std::optional<Entity>(std::prev(after)->second);
  }

  const std::vector<std::pair<std::size_t, Entity>>& stretches() const { return stretches_; }

 private:
  std::vector<std::pair<std::size_t, Entity>> stretches_;
};

}  // namespace meshgrow

#endif
