#include "model_reader.h"

#include <algorithm>
#include <map>

#include "error.h"

namespace meshgrow {

namespace {

[[noreturn]] void refuse_type(const Entity& entity, const gmsh::ElementType& type) {
  throw Error(entity_name(entity) + " has elements of type '" + type.name +
              "', which meshgrow does not read: use lines, triangles, quadrilaterals, tetrahedra, "
              "hexahedra, prisms or pyramids.");
}

gmsh::ElementType known_type(int type, const Entity& entity) {
  try {
    return gmsh::element_type(type);
  } catch (const Error&) {
    // Gmsh has types, such as trihedra, of which it tells no properties.
    gmsh::ElementType unknown;
    unknown.name = "number " + std::to_string(type);
    refuse_type(entity, unknown);
  }
}

ElementShape report_shape(ElementFamily family, const Entity& entity,
                          const gmsh::ElementType& type) {
  switch (family) {
    case ElementFamily::triangle:
      return ElementShape::triangle;
    case ElementFamily::quad:
      return ElementShape::quad;
    case ElementFamily::tetrahedron:
      return ElementShape::tetrahedron;
    case ElementFamily::hexahedron:
      return ElementShape::hexahedron;
    case ElementFamily::prism:
      return ElementShape::prism;
    case ElementFamily::pyramid:
      return ElementShape::pyramid;
    default:
      refuse_type(entity, type);
  }
}

}  // namespace

Topology read_topology() {
  Topology topology;
  const std::vector<Entity> entities = gmsh::entities();
  if (entities.empty()) {
    throw Error("The current Gmsh model has no entities: open or build a model first.");
  }
  const std::set<Entity> all(entities.begin(), entities.end());
  for (const Entity& entity : entities) {
    if (all.count({entity.dim, entity.tag - gmsh::compound_offset}) > 0 &&
        gmsh::is_discrete(entity) && !gmsh::has_elements(entity)) {
      continue;  // left over from a compound, whose parts have the mesh
    }
    std::vector<Entity> lower = entity.dim > 0 ? gmsh::boundary(entity) : std::vector<Entity>();
    if (entity.dim >= 2) {
      const std::vector<Entity> inside = gmsh::embedded(entity);
      lower.insert(lower.end(), inside.begin(), inside.end());
    }
    std::sort(lower.begin(), lower.end());
    lower.erase(std::unique(lower.begin(), lower.end()), lower.end());
    topology.add_entity(entity, std::move(lower), gmsh::bounding_box(entity));
  }
  for (const Entity& group : gmsh::physical_groups()) {
    topology.add_physical_group({group.dim, group.tag, gmsh::physical_name(group),
                                 gmsh::entities_of_physical_group(group)});
  }
  return topology;
}

NodeCoordinates::NodeCoordinates() { add(gmsh::all_nodes()); }

NodeCoordinates::NodeCoordinates(const std::set<Entity>& entities) {
  for (const Entity& entity : entities) {
    add(gmsh::nodes(entity));
  }
}

void NodeCoordinates::add(const gmsh::Nodes& nodes) {
  coordinates_.reserve(coordinates_.size() + nodes.tags.size());
  index_of_.reserve(coordinates_.size() + nodes.tags.size());
  for (std::size_t i = 0; i < nodes.tags.size(); ++i) {
    index_of_.emplace(nodes.tags[i], coordinates_.size());
    coordinates_.emplace_back(nodes.coordinates[3 * i], nodes.coordinates[3 * i + 1],
                              nodes.coordinates[3 * i + 2]);
  }
}

std::size_t NodeCoordinates::index(std::size_t tag, const Entity& asked_by) const {
  const auto found = index_of_.find(tag);
  if (found == index_of_.end()) {
    throw Error(entity_name(asked_by) + " has an element with node " + std::to_string(tag) +
                ", which does not exist: repair its mesh.");
  }
  return found->second;
}

const Vec3& NodeCoordinates::at(std::size_t tag, const Entity& asked_by) const {
  return coordinates_[index(tag, asked_by)];
}

ElementFamily element_family(const gmsh::ElementType& type) {
  // The number of corners alone would take a trihedron for a tetrahedron.
  static const std::map<std::string, ElementFamily> families = {
      {"Line", ElementFamily::line},
      {"Triangle", ElementFamily::triangle},
      {"Quadrilateral", ElementFamily::quad},
      {"Quadrangle", ElementFamily::quad},
      {"Tetrahedron", ElementFamily::tetrahedron},
      {"Hexahedron", ElementFamily::hexahedron},
      {"Prism", ElementFamily::prism},
      {"Pyramid", ElementFamily::pyramid}};
  const auto found = families.find(type.name.substr(0, type.name.find(' ')));
  return found == families.end() ? ElementFamily::unknown : found->second;
}

ElementCorners read_element_corners(const Entity& entity) {
  ElementCorners corners;
  for (const gmsh::Elements& block : gmsh::elements(entity)) {
    const gmsh::ElementType type = known_type(block.type, entity);
    const ElementFamily family = element_family(type);
    const auto step = static_cast<std::size_t>(type.node_count);
    for (std::size_t first = 0; first + step <= block.node_tags.size(); first += step) {
      const std::size_t* tags = &block.node_tags[first];
      if (family == ElementFamily::line) {
        corners.segments.push_back({tags[0], tags[1]});
      } else if (family == ElementFamily::triangle) {
        corners.triangles.push_back({tags[0], tags[1], tags[2]});
      } else if (family == ElementFamily::quad) {
        corners.quads.push_back({tags[0], tags[1], tags[2], tags[3]});
      } else {
        refuse_type(entity, type);
      }
    }
  }
  return corners;
}

FacetedSource read_entity_mesh(const Entity& entity, const NodeCoordinates& nodes) {
  const ElementCorners corners = read_element_corners(entity);
  FacetedSource source;
  source.entity = entity;
  const auto at = [&](std::size_t tag) { return nodes.at(tag, entity); };
  for (const auto& [a, b] : corners.segments) {
    source.segments.push_back({at(a), at(b)});
  }
  for (const auto& [a, b, c] : corners.triangles) {
    source.triangles.push_back({at(a), at(b), at(c)});
  }
  for (const auto& [a, b, c, d] : corners.quads) {
    source.quads.push_back({at(a), at(b), at(c), at(d)});
  }
  return source;
}

ReportMesh read_report_mesh(int dim, std::vector<Entity> entities) {
  if (entities.empty()) {
    for (const Entity& entity : gmsh::entities()) {
      if (entity.dim == dim) {
        entities.push_back(entity);
      }
    }
  }
  const NodeCoordinates nodes;
  ReportMesh mesh;
  mesh.nodes = nodes.coordinates();
  for (const Entity& entity : entities) {
    for (const gmsh::Elements& block : gmsh::elements(entity)) {
      const gmsh::ElementType type = known_type(block.type, entity);
      const ElementShape shape = report_shape(element_family(type), entity, type);
      const auto step = static_cast<std::size_t>(type.node_count);
      for (std::size_t first = 0; first + step <= block.node_tags.size(); first += step) {
        ReportElement element;
        element.shape = shape;
        element.entity = entity;
        element.tag = block.tags[first / step];
        for (int i = 0; i < corner_count(shape); ++i) {
          element.corners[i] =
              static_cast<std::uint32_t>(nodes.index(block.node_tags[first + i], entity));
        }
        mesh.elements.push_back(element);
      }
    }
  }
  return mesh;
}

}  // namespace meshgrow
