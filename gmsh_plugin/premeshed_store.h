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
/// elements, and which nodes of periodic entities correspond. Element tags are not.
class PremeshedStore {
 public:
  struct Mesh {
    gmsh::Nodes nodes;
    std::vector<gmsh::Elements> elements;
    gmsh::PeriodicNodes periodic;
  };
  static Mesh read(const Entity& entity);
  /// The same with corner nodes only.
  static Mesh first_order(const Mesh& mesh);

  /// Copies the meshes of all entities of the model that have elements.
  explicit PremeshedStore(const Topology& topology);

  /// Copies the meshes of these entities as well.
  void keep(const std::vector<Entity>& entities);

  /// Copies the meshes of those of these entities again whose elements are others now; returns
  /// them.
  std::vector<Entity> keep_of_other_cells(const std::vector<Entity>& entities);

  /// Those of these entities that Gmsh has given other elements, if it has meshed something on them
  /// that is not stored: put_back_changed() would delete that and throw.
  std::vector<Entity> misfits(const std::vector<Entity>& entities) const;

  /// Forgets the copies of entities that are not among these.
  void keep_only(const std::set<Entity>& entities);

  std::set<Entity> entities() const;
  bool contains(const Entity& entity) const { return meshes_.count(entity) > 0; }

  /// Puts back every stored mesh that is gone entirely, as after a pass over curves. First order
  /// only: Gmsh has made everything first order at that time.
  void put_back_missing() const;

  /// A stored entity with elements of second or higher order, if there is one.
  std::optional<Entity> any_of_higher_order() const;

  /// Puts back every stored mesh that differs in any way; meshes on top of it are taken off and
  /// laid on again. Throws Error, naming the entities, if one still differs afterwards, or if Gmsh
  /// had given it other elements: what was meshed on those does not fit it and is deleted.
  void put_back_changed() const;

  /// The same where an error is passing already: what does not fit is deleted without a word.
  void put_back_after_error() const;

  /// Stored entities whose mesh is not as it was.
  std::vector<Entity> changed() const;

 private:
  static void write(const std::map<Entity, Mesh>& meshes);
  static bool same(const Mesh& a, const Mesh& b);
  /// Corner nodes of each element, in no order.
  static std::multiset<std::vector<std::size_t>> cells(const Mesh& mesh);
  /// Entities with a mesh on top of these, or periodic copies of these, and so on, and these.
  std::set<Entity> depending_on(const std::vector<Entity>& entities) const;
  void put_back_periodicity(const std::map<Entity, Mesh>& laid_again) const;
  std::vector<Entity> of_other_cells(const std::vector<Entity>& differing) const;
  std::vector<Entity> stored(const std::vector<Entity>& entities) const;
  struct Misfits {
    std::vector<Entity> changed;
    std::vector<Entity> deleted;
  };
  Misfits put_back() const;

  const Topology& topology_;
  std::map<Entity, Mesh> meshes_;
};

}  // namespace meshgrow

#endif
