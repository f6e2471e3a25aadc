#ifndef MESHGROW_MODEL_READER_H
#define MESHGROW_MODEL_READER_H

#include <array>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "faceted_source.h"
#include "gmsh_api.h"
#include "mesh_report.h"
#include "topology.h"

namespace meshgrow {

/// Entities, boundaries, embedded entities, boxes and physical groups of Gmsh's current model.
/// Throws Error if the model has no entities.
Topology read_topology();

/// Coordinates of nodes of the current model by node tag.
class NodeCoordinates {
 public:
  /// Of all nodes.
  NodeCoordinates();
  /// Of the nodes on these entities only.
  explicit NodeCoordinates(const std::set<Entity>& entities);
  /// Throws Error, naming the entity, if there is no such node.
  const Vec3& at(std::size_t tag, const Entity& asked_by) const;
  std::size_t index(std::size_t tag, const Entity& asked_by) const;
  const std::vector<Vec3>& coordinates() const { return coordinates_; }

 private:
  void add(const gmsh::Nodes& nodes);

  std::vector<Vec3> coordinates_;
  std::unordered_map<std::size_t, std::size_t> index_of_;
};

/// Tags of the corner nodes of the elements of a curve or surface.
struct ElementCorners {
  std::vector<std::array<std::size_t, 2>> segments;
  std::vector<std::array<std::size_t, 3>> triangles;
  std::vector<std::array<std::size_t, 4>> quads;
};

/// Throws Error that names entity and type for elements other than lines, triangles and
/// quadrilaterals.
ElementCorners read_element_corners(const Entity& entity);

/// The mesh of a curve or surface by corner nodes, whatever the order of its elements; empty if it
/// has none. Throws Error as read_element_corners.
FacetedSource read_entity_mesh(const Entity& entity, const NodeCoordinates& nodes);

/// The elements of these entities (all of one dimension, 2 or 3) for a report; all entities of the
/// dimension if none is named.
ReportMesh read_report_mesh(int dim, std::vector<Entity> entities);

/// What an element type is by its corner nodes; `unknown` for types that meshgrow does not read,
/// such as polygons and trihedra.
enum class ElementFamily { line, triangle, quad, tetrahedron, hexahedron, prism, pyramid, unknown };
ElementFamily element_family(const gmsh::ElementType& type);

}  // namespace meshgrow

#endif
