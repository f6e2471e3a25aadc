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
#include "start_sizes/curvature_start_sizes.h"

namespace meshgrow {

namespace {

/// For gaps, which know no angle.
constexpr double standard_turn = 6.0;
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// Half the step of differences, in parts of a piece.
constexpr double step_part = 0.05;

/// A piece of a sampled shape: its corners in space and in the parameters of the shape (the second
/// parameter of a curve is 0).
struct Piece {
  int corner_count = 3;
  std::array<Vec3, 3> points;
  std::array<std::array<double, 2>, 3> parameters;

  double longest_side() const {
    double longest = 0.0;
    for (int i = 0; i < corner_count; ++i) {
      longest = std::max(longest, side(i));
    }
    return longest;
  }

  Vec3 centre() const {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < corner_count; ++i) {
      sum += points[i];
    }
    return sum / corner_count;
  }

  double side(int from) const { return (points[(from + 1) % corner_count] - points[from]).norm(); }

  /// Cut in the middle of the side that begins at this corner.
  std::array<Piece, 2> halves(int from) const {
    const int to = (from + 1) % corner_count;
    const Vec3 point = 0.5 * (points[from] + points[to]);
    const std::array<double, 2> parameter = {0.5 * (parameters[from][0] + parameters[to][0]),
                                             0.5 * (parameters[from][1] + parameters[to][1])};
    std::array<Piece, 2> halves = {*this, *this};
    halves[0].points[to] = point;
    halves[0].parameters[to] = parameter;
    halves[1].points[from] = point;
    halves[1].parameters[from] = parameter;
    return halves;
  }

  /// Parameters at the weighted mean of the corners: the weight of corner i, those of the others
  /// equal.
  std::array<double, 2> inside(int i, double weight) const {
    std::array<double, 2> result = {0.0, 0.0};
    for (int k = 0; k < corner_count; ++k) {
      for (int axis = 0; axis < 2; ++axis) {
        result[axis] +=
            parameters[k][axis] * (k == i ? weight : (1.0 - weight) / (corner_count - 1));
      }
    }
    return result;
  }

  std::array<double, 2> steps() const {
    std::array<double, 2> result;
    for (int axis = 0; axis < 2; ++axis) {
      double low = parameters[0][axis];
      double high = low;
      for (int k = 1; k < corner_count; ++k) {
        low = std::min(low, parameters[k][axis]);
        high = std::max(high, parameters[k][axis]);
      }
      result[axis] = step_part * (high - low);
    }
    return result;
  }
};

/// Curvatures at the centre of each piece and near each of its corners. (Not at corners: at the
/// poles of spheres and the tips of cones there is none.)
std::vector<double> curvatures_inside(const Entity& entity, const std::vector<Piece>& pieces) {
  constexpr double near_corner = 0.8;
  std::vector<double> parameters;
  std::vector<double> steps;
  for (const Piece& piece : pieces) {
    const std::array<double, 2> step = piece.steps();
    for (int i = -1; i < piece.corner_count; ++i) {
      const std::array<double, 2> at =
          i < 0 ? piece.inside(0, 1.0 / piece.corner_count) : piece.inside(i, near_corner);
      for (int axis = 0; axis < entity.dim; ++axis) {
        parameters.push_back(at[axis]);
        steps.push_back(step[axis]);
      }
    }
  }
  return entity.dim == 1 ? curve_curvatures(entity, parameters, steps)
                         : surface_curvatures(entity, parameters, steps);
}

void append(const Piece& piece, FacetedSource& source) {
  if (piece.corner_count == 2) {
    source.segments.push_back({piece.points[0], piece.points[1]});
  } else {
    source.triangles.push_back(piece.points);
  }
}

/// How far sizes may vary on a piece, and which pieces are too small for it to matter.
struct Variation {
  const SizeFunction& function;
  double smallest_side;

  static constexpr double allowed_ratio = 1.08;
  static constexpr double small_piece = 0.5;  // of the size: growth hides what varies within

  double size(double curvature) const {
    return std::clamp(curvature_start_size(curvature, function.angle), function.min_size,
                      2.0 * function.size_limit);
  }

  /// The side to halve, by its first corner, since the size varies most along it; -1 if it hardly
  /// varies. `curvatures`: at the centre, then near each corner.
  int side_to_halve(const Piece& piece, const double* curvatures) const {
    const auto [low, high] = std::minmax_element(curvatures, curvatures + piece.corner_count + 1);
    const double smallest = size(*high);
    const double least_side = std::max(small_piece * smallest, smallest_side);
    if (!(smallest < function.size_limit) || !(size(*low) > allowed_ratio * smallest)) {
      return -1;
    }
    int side = -1;
    double most = 0.0;
    for (int i = 0; i < piece.corner_count; ++i) {
      const double ratio = std::abs(
          std::log(size(curvatures[1 + i]) / size(curvatures[1 + (i + 1) % piece.corner_count])));
      // The longer one of two sides along which it varies alike.
      const double score = ratio + 1e-3 * piece.side(i) / piece.longest_side();
      if (piece.side(i) > least_side && score > most) {
        most = score;
        side = i;
      }
    }
    return side;
  }
};

/// Halves pieces until the size hardly varies on any, and adds them with the curvature at their
/// centres.
void append_pieces(std::vector<Piece> pieces, const SizeFunction& function, bool knows_curvature,
                   FacetedSource& source) {
  constexpr int most_halvings = 20;
  constexpr double smallest_part = 0.005;  // of the whole shape
  Box box;
  for (const Piece& piece : pieces) {
    for (const Vec3& point : piece.points) {
      box.extend(point);
    }
  }
  const Variation variation{function, box.isEmpty() ? 0.0 : smallest_part * box.diagonal().norm()};
  std::vector<double>& known =
      source.entity.dim == 1 ? source.segment_curvatures : source.triangle_curvatures;
  for (int halving = 0; !pieces.empty(); ++halving) {
    const std::vector<double> curvatures =
        knows_curvature ? curvatures_inside(source.entity, pieces) : std::vector<double>();
    std::vector<Piece> open;
    const double* of_piece = curvatures.data();
    for (const Piece& piece : pieces) {
      const int side = knows_curvature && halving < most_halvings
                           ? variation.side_to_halve(piece, of_piece)
                           : -1;
      if (side >= 0) {
        const std::array<Piece, 2> halves = piece.halves(side);
        open.insert(open.end(), halves.begin(), halves.end());
      } else {
        known.push_back(knows_curvature ? of_piece[0] : unknown);
        append(piece, source);
      }
      of_piece += knows_curvature ? piece.corner_count + 1 : 0;
    }
    pieces = std::move(open);
  }
}

std::vector<Piece> pieces_of(const SampledCurve& curve) {
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i + 1 < curve.points.size(); ++i) {
    Piece piece;
    piece.corner_count = 2;
    piece.points = {curve.points[i], curve.points[i + 1], curve.points[i + 1]};
    piece.parameters = {{{curve.parameters[i], 0.0}, {curve.parameters[i + 1], 0.0}, {0.0, 0.0}}};
    pieces.push_back(piece);
  }
  return pieces;
}

std::vector<Piece> pieces_of(const SampledSurface& surface) {
  std::vector<Piece> pieces;
  for (const auto& triangle : surface.triangles) {
    Piece piece;
    for (int i = 0; i < 3; ++i) {
      piece.points[i] = surface.points[triangle[i]];
      piece.parameters[i] = surface.parameters[triangle[i]];
    }
    pieces.push_back(piece);
  }
  return pieces;
}

FacetedSource plain(const Entity& entity, const std::vector<Piece>& pieces) {
  FacetedSource source;
  source.entity = entity;
  for (const Piece& piece : pieces) {
    append(piece, source);
  }
  return source;
}

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
std::vector<Piece> meshed_pieces(const Entity& entity, const NodeCoordinates& nodes) {
  const ElementCorners corners = read_element_corners(entity);
  const NodeParameters parameters(entity);
  std::vector<Piece> pieces;
  const auto add = [&](std::initializer_list<std::size_t> tags) {
    Piece piece;
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
std::vector<double> curvatures_at_centres(const Entity& entity, const std::vector<Piece>& pieces) {
  constexpr double small_step = 1e-3;  // in parts of the range, where no better is known
  const auto dim = static_cast<std::size_t>(entity.dim);
  const auto bounds = gmsh::parameter_bounds(entity);
  if (bounds.size() != dim) {
    return std::vector<double>(pieces.size(), unknown);
  }
  std::vector<double> parameters;
  std::vector<double> steps;
  for (const Piece& piece : pieces) {
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
  if (gmsh::has_elements(entity)) {
    return meshed_with_curvature(entity);
  }
  return entity.dim == 1 ? sampled_curve(entity, function) : sampled_surface(entity, function);
}

FacetedSource SourceFacets::sampled_curve(const Entity& curve, const SizeFunction& function) {
  FacetedSource source;
  source.entity = curve;
  append_pieces(pieces_of(sampler(function.angle / 3.0).curve(curve)), function,
                !gmsh::is_discrete(curve), source);
  return source;
}

FacetedSource SourceFacets::sampled_surface(const Entity& surface, const SizeFunction& function) {
  const auto sampled = sampler(function.angle / 3.0).surface(surface);
  if (!sampled) {
    return shape(surface);
  }
  FacetedSource source;
  source.entity = surface;
  append_pieces(pieces_of(*sampled), function, !gmsh::is_discrete(surface), source);
  return source;
}

FacetedSource SourceFacets::meshed_with_curvature(const Entity& entity) {
  const std::vector<Piece> pieces = meshed_pieces(entity, nodes_);
  FacetedSource source = plain(entity, pieces);
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
    source = plain(entity, pieces_of(sampler(standard_turn).curve(entity)));
  } else if (const auto sampled = sampler(standard_turn).surface(entity)) {
    source = plain(entity, pieces_of(*sampled));
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
                            ? plain(lower, pieces_of(sampler(standard_turn).curve(lower)))
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
