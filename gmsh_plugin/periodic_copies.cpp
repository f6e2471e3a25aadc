#include "periodic_copies.h"

#include <algorithm>
#include <numeric>
#include <unordered_map>

#include "error.h"
#include "gmsh_api.h"
#include "model_reader.h"
#include "premeshed_store.h"
#include "restore.h"

namespace meshgrow {

namespace {

using NodePairs = std::unordered_map<std::size_t, std::size_t>;  // of the master -> of the copy

/// The affine transformation from master to copy, as Gmsh gives it: 4 × 4, by rows.
class Transformation {
 public:
  explicit Transformation(const std::vector<double>& rows) : rows_(rows) {}
  Vec3 operator()(const Vec3& p) const {
    Vec3 moved;
    for (std::size_t i = 0; i < 3; ++i) {
      moved[static_cast<Eigen::Index>(i)] = rows_[4 * i] * p.x() + rows_[4 * i + 1] * p.y() +
                                            rows_[4 * i + 2] * p.z() + rows_[4 * i + 3];
    }
    return moved;
  }

 private:
  const std::vector<double>& rows_;
};

struct PlacedNode {
  std::size_t tag = 0;
  Vec3 position;
};

std::vector<PlacedNode> nodes_below(const Entity& entity, const Topology& topology) {
  std::vector<PlacedNode> result;
  for (const Entity& below : topology.closure(topology.lower(entity))) {
    const gmsh::Nodes nodes = gmsh::nodes(below);
    for (std::size_t i = 0; i < nodes.tags.size(); ++i) {
      result.push_back({nodes.tags[i], Vec3(nodes.coordinates[3 * i], nodes.coordinates[3 * i + 1],
                                            nodes.coordinates[3 * i + 2])});
    }
  }
  return result;
}

/// Pairs the nodes on the boundaries by position.
NodePairs pair_boundaries(const Entity& copy, const Entity& master, const Transformation& move,
                          const Topology& topology) {
  const std::vector<PlacedNode> here = nodes_below(copy, topology);
  const Box& box = topology.box(copy);
  const double tolerance = 1e-4 * (box.isEmpty() ? 1.0 : box.diagonal().norm());
  NodePairs pairs;
  std::set<std::size_t> used;
  for (const PlacedNode& there : nodes_below(master, topology)) {
    const Vec3 moved = move(there.position);
    const auto nearest = std::min_element(
        here.begin(), here.end(), [&moved](const PlacedNode& a, const PlacedNode& b) {
          return (a.position - moved).squaredNorm() < (b.position - moved).squaredNorm();
        });
    if (nearest == here.end() || (nearest->position - moved).norm() > tolerance ||
        !used.insert(nearest->tag).second) {
      throw Error(
          entity_name(copy) + " is a periodic copy of " + entity_name(master) +
          ", but their boundaries are meshed differently: mesh both beforehand, or neither.");
    }
    pairs[there.tag] = nearest->tag;
  }
  return pairs;
}

/// Turns the order of corners of every element.
void reverse_elements(std::vector<gmsh::Elements>& elements) {
  for (gmsh::Elements& block : elements) {
    const auto step = static_cast<std::ptrdiff_t>(gmsh::element_type(block.type).node_count);
    for (auto first = block.node_tags.begin(); first != block.node_tags.end(); first += step) {
      std::reverse(first, first + step);
    }
  }
}

/// Whether the first element of a surface mesh turns against the normal of the surface.
bool is_against_normal(const Entity& surface, const std::vector<gmsh::Elements>& elements,
                       const NodeCoordinates& nodes) {
  if (elements.empty() || elements.front().node_tags.size() < 3) {
    return false;
  }
  std::array<Vec3, 3> corner;
  for (std::size_t i = 0; i < 3; ++i) {
    corner[i] = nodes.at(elements.front().node_tags[i], surface);
  }
  const Vec3 middle = (corner[0] + corner[1] + corner[2]) / 3.0;
  const std::vector<Vec3> normals =
      gmsh::normals_at(surface, gmsh::parameters_at(surface, {middle.x(), middle.y(), middle.z()}));
  return !normals.empty() &&
         (corner[1] - corner[0]).cross(corner[2] - corner[0]).dot(normals.front()) < 0.0;
}

/// Whether the line elements run against the parameter of their curve.
bool runs_back(const Entity& curve, const std::vector<gmsh::Elements>& elements,
               const NodeCoordinates& nodes) {
  if (elements.empty() || elements.front().node_tags.empty()) {
    return false;
  }
  // In the middle, away from the seam of a closed curve.
  const std::vector<std::size_t>& tags = elements.front().node_tags;
  const std::size_t first = tags.size() / 4 * 2;
  const Vec3 a = nodes.at(tags[first], curve);
  const Vec3 b = nodes.at(tags[first + 1], curve);
  const std::vector<double> parameters =
      gmsh::parameters_at(curve, {a.x(), a.y(), a.z(), b.x(), b.y(), b.z()});
  return parameters.at(0) > parameters.at(1);
}

}  // namespace

std::map<Entity, Entity> periodic_masters(const Topology& topology) {
  std::map<Entity, Entity> result;
  for (const Entity& entity : topology.entities()) {
    if (entity.dim == 1 || entity.dim == 2) {
      const gmsh::PeriodicNodes periodic = gmsh::periodic_nodes(entity);
      const Entity master{entity.dim, periodic.master};
      if (master != entity && topology.contains(master) && periodic.transformation.size() == 16) {
        result[entity] = master;
      }
    }
  }
  return result;
}

namespace {

void lay_copy(const Entity& copy, const Entity& master, const Topology& topology) {
  const std::vector<double> rows = gmsh::periodic_nodes(copy).transformation;
  const Transformation move(rows);
  NodePairs pairs = pair_boundaries(copy, master, move, topology);
  const PremeshedStore::Mesh source = PremeshedStore::first_order(PremeshedStore::read(master));

  // Where the nodes go, along a curve in the order of its parameter, as Gmsh keeps them.
  std::vector<double> places;
  for (std::size_t i = 0; i < source.nodes.tags.size(); ++i) {
    const Vec3 moved =
        move(Vec3(source.nodes.coordinates[3 * i], source.nodes.coordinates[3 * i + 1],
                  source.nodes.coordinates[3 * i + 2]));
    places.insert(places.end(), {moved.x(), moved.y(), moved.z()});
  }
  const std::vector<double> parameters =
      places.empty() ? places : gmsh::parameters_at(copy, places);
  std::vector<std::size_t> order(source.nodes.tags.size());
  std::iota(order.begin(), order.end(), 0U);
  if (copy.dim == 1) {
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return parameters[a] < parameters[b]; });
  }
  gmsh::Nodes nodes;
  const auto width = static_cast<std::size_t>(copy.dim);
  for (const std::size_t i : order) {
    const auto add = [i](const std::vector<double>& from, std::size_t step,
                         std::vector<double>& to) {
      const auto begin = from.begin() + static_cast<std::ptrdiff_t>(i * step);
      to.insert(to.end(), begin, begin + static_cast<std::ptrdiff_t>(step));
    };
    add(places, 3, nodes.coordinates);
    add(parameters, width, nodes.parametric_coordinates);
  }
  gmsh::add_nodes(copy, nodes);  // without tags: Gmsh gives new ones
  const std::vector<std::size_t> tags = gmsh::nodes(copy).tags;
  for (std::size_t k = 0; k < order.size(); ++k) {
    pairs[source.nodes.tags[order[k]]] = tags.at(k);
  }

  std::vector<gmsh::Elements> elements = source.elements;
  for (gmsh::Elements& block : elements) {
    for (std::size_t& node : block.node_tags) {
      node = pairs.at(node);
    }
  }
  const NodeCoordinates coordinates(topology.closure({copy}));
  if (copy.dim == 1 && runs_back(copy, elements, coordinates)) {
    for (gmsh::Elements& block : elements) {
      std::reverse(block.node_tags.begin(), block.node_tags.end());
    }
  } else if (copy.dim == 2 && is_against_normal(copy, elements, coordinates)) {
    reverse_elements(elements);
  }
  gmsh::add_elements(copy, elements);

  gmsh::PeriodicNodes periodic;
  periodic.master = master.tag;
  for (const auto& [there, here] : pairs) {
    periodic.nodes.push_back(here);
    periodic.master_nodes.push_back(there);
  }
  gmsh::set_periodic_nodes({{copy, periodic}});
}

}  // namespace

void copy_from_master(const Entity& copy, const Entity& master, const Topology& topology) {
  try {
    lay_copy(copy, master, topology);
  } catch (...) {
    // Half a copy, or one of which Gmsh does not know which nodes correspond, would stop later
    // runs.
    restore([&copy] { gmsh::clear_mesh({copy}); });
    throw;
  }
}

}  // namespace meshgrow
