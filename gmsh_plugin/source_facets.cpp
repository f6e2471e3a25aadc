#include "source_facets.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <unordered_map>

#include "error.h"
#include "geometry_curvature.h"
#include "geometry_sampler.h"
#include "gmsh_api.h"
#include "mapped_surface.h"

namespace meshgrow {

namespace {

/// For gaps, which know no angle.
constexpr double standard_turn = 6.0;
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// The parameters of mesh nodes on a curve or surface.
class NodeParameters {
 public:
  explicit NodeParameters(const Entity& entity) : dim_(static_cast<std::size_t>(entity.dim)) {
    const gmsh::Nodes nodes = gmsh::nodes_with_boundary(entity);
    if (nodes.parametric_coordinates.size() == dim_ * nodes.tags.size()) {
      parameters_ = nodes.parametric_coordinates;
      for (std::size_t i = 0; i < nodes.tags.size(); ++i) {
        index_of_.emplace(nodes.tags[i], i);
      }
    }
  }

  /// NaN where a node has none.
  std::array<double, 2> at(std::size_t tag) const {
    const auto found = index_of_.find(tag);
    if (found == index_of_.end()) {
      return {unknown, unknown};
    }
    const double* of_node = &parameters_[dim_ * found->second];
    return {of_node[0], dim_ == 2 ? of_node[1] : 0.0};
  }

 private:
  std::size_t dim_;
  std::vector<double> parameters_;
  std::unordered_map<std::size_t, std::size_t> index_of_;
};

/// The elements of a curve or surface, quads as two triangles, with the parameters of their nodes.
std::vector<ShapePiece> meshed_pieces(const Entity& entity, const NodeCoordinates& nodes) {
  const ElementCorners corners = read_element_corners(entity);
  const NodeParameters parameters(entity);
  std::vector<ShapePiece> pieces;
  const auto add = [&](std::initializer_list<std::size_t> tags) {
    ShapePiece piece;
    piece.corner_count = static_cast<int>(tags.size());
    int i = 0;
    for (const std::size_t tag : tags) {
      piece.points[i] = nodes.at(tag, entity);
      piece.parameters[i] = parameters.at(tag);
      ++i;
    }
    pieces.push_back(piece);
  };
  for (const auto& [a, b] : corners.segments) {
    add({a, b});
  }
  for (const auto& [a, b, c] : corners.triangles) {
    add({a, b, c});
  }
  for (const auto& [a, b, c, d] : corners.quads) {
    add({a, b, c});
    add({a, c, d});
  }
  return pieces;
}

/// Curvature of the geometry at the centre of each element, whose place in the parameters is the
/// mean of its corners, or, where that is another place (across a seam), its projection.
std::vector<double> curvatures_at_centres(const Entity& entity,
                                          const std::vector<ShapePiece>& pieces) {
  constexpr double small_step = 1e-3;  // in parts of the range, where no better is known
  const auto dim = static_cast<std::size_t>(entity.dim);
  const auto bounds = gmsh::parameter_bounds(entity);
  if (bounds.size() != dim) {
    return std::vector<double>(pieces.size(), unknown);
  }
  std::vector<double> parameters;
  std::vector<double> steps;
  for (const ShapePiece& piece : pieces) {
    const std::array<double, 2> centre = piece.inside(0, 1.0 / piece.corner_count);
    const std::array<double, 2> step = piece.steps();
    for (std::size_t axis = 0; axis < dim; ++axis) {
      const bool is_known = std::isfinite(centre[axis]) && step[axis] > 0.0;
      parameters.push_back(is_known ? centre[axis] : bounds[axis][0]);
      steps.push_back(is_known ? step[axis] : small_step * (bounds[axis][1] - bounds[axis][0]));
    }
  }
  const std::vector<Vec3> on_shape = gmsh::points_at(entity, parameters);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const Vec3 centre = pieces[i].centre();
    if (!((on_shape[i] - centre).norm() <= 0.25 * pieces[i].longest_side())) {
      const std::vector<double> projected =
          gmsh::parameters_at(entity, {centre.x(), centre.y(), centre.z()});
      for (std::size_t axis = 0; axis < dim && axis < projected.size(); ++axis) {
        parameters[dim * i + axis] = projected[axis];
        steps[dim * i + axis] = small_step * (bounds[axis][1] - bounds[axis][0]);
      }
    }
  }
  return dim == 1 ? curve_curvatures(entity, parameters, steps)
                  : surface_curvatures(entity, parameters, steps);
}

}  // namespace

SourceFacets::SourceFacets(const Topology& topology, const NodeCoordinates& nodes)
    : topology_(topology), nodes_(nodes) {}

ShapeSampler& SourceFacets::sampler(double max_turn) {
  return samplers_.try_emplace(max_turn, topology_, max_turn).first->second;
}

FacetedSource SourceFacets::with_curvature(const Entity& entity, const SizeFunction& function) {
  if (entity.dim == 1 && has_no_length(entity, topology_)) {
    return faceted_source(entity, {});  // the pole of a sphere, which has no curvature as a curve
  }
  if (gmsh::has_elements(entity)) {
    return meshed_with_curvature(entity);
  }
  ShapeSampler& fine = sampler(function.angle / 3.0);
  if (entity.dim == 1) {
    return sampled(entity, pieces_of(fine.curve(entity)), function);
  }
  const auto surface = fine.surface(entity);
  return surface ? sampled(entity, pieces_of(*surface), function) : shape(entity);
}

FacetedSource SourceFacets::sampled(const Entity& entity, std::vector<ShapePiece> pieces,
                                    const SizeFunction& function) {
  // Without geometry, curvature is that of the facets.
  return gmsh::is_discrete(entity) ? faceted_source(entity, pieces)
                                   : with_curvatures(entity, std::move(pieces), function);
}

FacetedSource SourceFacets::meshed_with_curvature(const Entity& entity) {
  const std::vector<ShapePiece> pieces = meshed_pieces(entity, nodes_);
  FacetedSource source = faceted_source(entity, pieces);
  if (!gmsh::is_discrete(entity)) {  // else its curvature is that of its facets
    (entity.dim == 1 ? source.segment_curvatures : source.triangle_curvatures) =
        curvatures_at_centres(entity, pieces);
  }
  return source;
}

FacetedSource SourceFacets::shape(const Entity& entity) {
  const auto known = shapes_.find(entity);
  if (known != shapes_.end()) {
    return known->second;
  }
  FacetedSource source;
  if (gmsh::has_elements(entity)) {
    source = read_entity_mesh(entity, nodes_);
  } else if (entity.dim == 1) {
    source = faceted_source(entity, pieces_of(sampler(standard_turn).curve(entity)));
  } else if (const auto sampled = sampler(standard_turn).surface(entity)) {
    source = faceted_source(entity, pieces_of(*sampled));
  } else {
    // Pieces that do not fit together at the edges are better than none.
    gmsh::log(entity_name(entity) +
                  " could not be cut into facets along its edges: gaps between its edges are not "
                  "measured unless it is meshed beforehand.",
              "warning");
    const Box box = topology_.box(entity);
    source =
        sample_geometry(entity, topology_, 0.05 * (box.isEmpty() ? 1.0 : box.diagonal().norm()));
  }
  return shapes_.emplace(entity, std::move(source)).first->second;
}

std::vector<Wall> SourceFacets::walls(const Entity& region) {
  std::vector<FacetedSource> borders;
  const bool is_meshed = region.dim == 2 && gmsh::has_elements(region);
  for (const Entity& lower : topology_.lower(region)) {
    if (lower.dim == region.dim - 1 && !(region.dim == 2 && has_no_length(lower, topology_))) {
      // The sides of a surface's facets are the pieces of its curves, meshed or sampled.
      borders.push_back(region.dim == 2 && !is_meshed
                            ? faceted_source(lower, pieces_of(sampler(standard_turn).curve(lower)))
                            : shape(lower));
    }
  }
  if (region.dim == 3) {
    return volume_walls(borders);
  }
  std::set<Entity> met;
  std::set<Entity> seams;
  for (const Entity& curve : gmsh::boundary(region)) {
    if (!met.insert(curve).second) {
      seams.insert(curve);
    }
  }
  return surface_walls(shape(region), borders, seams);
}

}  // namespace meshgrow
