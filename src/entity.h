#ifndef MESHGROW_ENTITY_H
#define MESHGROW_ENTITY_H

#include <string>
#include <tuple>
#include <vector>

namespace meshgrow {

/// A model entity as Gmsh names it: dimension 0 (point), 1 (curve), 2 (surface), 3 (volume) and
/// tag.
struct Entity {
  int dim = 0;
  int tag = 0;

  friend bool operator==(const Entity& a, const Entity& b) {
    return a.dim == b.dim && a.tag == b.tag;
  }
  friend bool operator!=(const Entity& a, const Entity& b) { return !(a == b); }
  friend bool operator<(const Entity& a, const Entity& b) {
    return std::tie(a.dim, a.tag) < std::tie(b.dim, b.tag);
  }
};

/// Of entities that are at least one.
int highest_dimension(const std::vector<Entity>& entities);

/// "Point", "Curve", "Surface" or "Volume"; "Entity of dimension 7" for anything else.
std::string dimension_name(int dim);

/// "Surface 7".
std::string entity_name(const Entity& entity);

/// "Surface 7, Surface 9 and 12 more": at most `most` names.
std::string entity_names(const std::vector<Entity>& entities, std::size_t most = 5);

}  // namespace meshgrow

#endif
