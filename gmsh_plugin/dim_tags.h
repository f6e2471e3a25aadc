#ifndef MESHGROW_DIM_TAGS_H
#define MESHGROW_DIM_TAGS_H

#include <vector>

#include "entity.h"

namespace meshgrow::gmsh {

/// Entities as Gmsh passes them: dimension, tag, dimension, tag, …
inline std::vector<Entity> to_entities(const std::vector<int>& dim_tags) {
  std::vector<Entity> result;
  for (std::size_t i = 0; i + 1 < dim_tags.size(); i += 2) {
    result.push_back({dim_tags[i], dim_tags[i + 1]});
  }
  return result;
}

inline std::vector<int> to_dim_tags(const std::vector<Entity>& entities) {
  std::vector<int> result;
  for (const Entity& entity : entities) {
    result.push_back(entity.dim);
    result.push_back(entity.tag);
  }
  return result;
}

}  // namespace meshgrow::gmsh

#endif
