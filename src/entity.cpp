#include "entity.h"

#include <algorithm>

namespace meshgrow {

int highest_dimension(const std::vector<Entity>& entities) {
  return std::max_element(entities.begin(), entities.end())->dim;
}

std::string dimension_name(int dim) {
  static const char* const names[] = {"Point", "Curve", "Surface", "Volume"};
  if (dim < 0 || dim > 3) {
    return "Entity of dimension " + std::to_string(dim);
  }
  return names[dim];
}

std::string entity_name(const Entity& entity) {
  return dimension_name(entity.dim) + " " + std::to_string(entity.tag);
}

std::string entity_names(const std::vector<Entity>& entities, std::size_t most) {
  std::string text;
  const std::size_t shown = std::min(most, entities.size());
  for (std::size_t i = 0; i < shown; ++i) {
    const bool last = i + 1 == entities.size();
    text += (i == 0 ? "" : last ? " and " : ", ") + entity_name(entities[i]);
  }
  if (shown < entities.size()) {
    text += " and " + std::to_string(entities.size() - shown) + " more";
  }
  return text;
}

}  // namespace meshgrow
