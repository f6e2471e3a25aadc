#ifndef MESHGROW_PREMESHED_STORE_H
#define MESHGROW_PREMESHED_STORE_H

#include <map>
#include <optional>
#include <set>
#include <vector>

#include "gmsh_api.h"
#include "topology.h"

namespace meshgrow {

/// Keeps a copy of the meshes that exist when it is made, and puts back what Gmsh takes away: it
/// drops the meshes of all surfaces and volumes when it meshes curves, and makes meshes of higher
/// order first order (DESIGN.md, section 5, lines 1 and 3).
///
/// Kept are, for each entity: node tags, coordinates to the bit, connectivity and order of
/// elements. Element tags are not.
class PremeshedStore {
 public:
  /// Copies the meshes of all entities of the model that have elements.
  explicit PremeshedStore(const Topology& topology);

  /// Copies the meshes of these entities as well.
  void keep(const std::vector<Entity>& entities);

  std::set<Entity> entities() const;
  bool contains(const Entity& entity) const { return meshes_.count(entity) > 0; }

  /// Puts back every stored mesh that is gone entirely, as after a pass over curves. First order
  /// only: Gmsh has made everything first order at that time.
  void put_back_missing() const;

  /// A stored entity with elements of second or higher order, if there is one.
  std::optional<Entity> any_of_higher_order() const;

  /// Puts back every stored mesh that differs in any way; meshes on top of it are taken off and
  /// laid on again. Throws Error, naming the entities, if one still differs afterwards.
  void put_back_changed() const;

  /// Stored entities whose mesh is not as it was.
  std::vector<Entity> changed() const;

 private:
  struct Mesh {
    gmsh::Nodes nodes;
    std::vector<gmsh::Elements> elements;
  };
  static Mesh read(const Entity& entity);
  static Mesh first_order(const Mesh& mesh);
  static void write(const Entity& entity, const Mesh& mesh);
  static bool same(const Mesh& a, const Mesh& b);

  const Topology& topology_;
  std::map<Entity, Mesh> meshes_;
};

}  // namespace meshgrow

#endif
