#include "shape_pieces.h"

#include <algorithm>
#include <cmath>

#include "geometry_curvature.h"
#include "start_sizes/curvature_start_sizes.h"

namespace meshgrow {

namespace {

/// In parts of a piece.
constexpr double step_part = 0.05;

/// Curvatures at the centre of each piece and near each of its corners. (Not at corners: at the
/// poles of spheres and the tips of cones there is none.)
std::vector<double> curvatures_inside(const Entity& entity, const std::vector<ShapePiece>& pieces) {
  constexpr double near_corner = 0.8;
  std::vector<double> parameters;
  std::vector<double> steps;
  for (const ShapePiece& piece : pieces) {
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

void append(const ShapePiece& piece, FacetedSource& source) {
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
  int side_to_halve(const ShapePiece& piece, const double* curvatures) const {
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

}  // namespace

Vec3 ShapePiece::centre() const {
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < corner_count; ++i) {
    sum += points[i];
  }
  return sum / corner_count;
}

double ShapePiece::side(int from) const {
  return (points[(from + 1) % corner_count] - points[from]).norm();
}

double ShapePiece::longest_side() const {
  double longest = 0.0;
  for (int i = 0; i < corner_count; ++i) {
    longest = std::max(longest, side(i));
  }
  return longest;
}

std::array<ShapePiece, 2> ShapePiece::halves(int from) const {
  const int to = (from + 1) % corner_count;
  const Vec3 point = 0.5 * (points[from] + points[to]);
  const std::array<double, 2> parameter = {0.5 * (parameters[from][0] + parameters[to][0]),
                                           0.5 * (parameters[from][1] + parameters[to][1])};
  std::array<ShapePiece, 2> halves = {*this, *this};
  halves[0].points[to] = point;
  halves[0].parameters[to] = parameter;
  halves[1].points[from] = point;
  halves[1].parameters[from] = parameter;
  return halves;
}

std::array<double, 2> ShapePiece::inside(int i, double weight) const {
  std::array<double, 2> result = {0.0, 0.0};
  for (int k = 0; k < corner_count; ++k) {
    for (int axis = 0; axis < 2; ++axis) {
      result[axis] += parameters[k][axis] * (k == i ? weight : (1.0 - weight) / (corner_count - 1));
    }
  }
  return result;
}

std::array<double, 2> ShapePiece::steps() const {
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

std::vector<ShapePiece> pieces_of(const SampledCurve& curve) {
  std::vector<ShapePiece> pieces;
  for (std::size_t i = 0; i + 1 < curve.points.size(); ++i) {
    ShapePiece piece;
    piece.corner_count = 2;
    piece.points = {curve.points[i], curve.points[i + 1], curve.points[i + 1]};
    piece.parameters = {{{curve.parameters[i], 0.0}, {curve.parameters[i + 1], 0.0}, {0.0, 0.0}}};
    pieces.push_back(piece);
  }
  return pieces;
}

std::vector<ShapePiece> pieces_of(const SampledSurface& surface) {
  std::vector<ShapePiece> pieces;
  for (const auto& triangle : surface.triangles) {
    ShapePiece piece;
    for (int i = 0; i < 3; ++i) {
      piece.points[i] = surface.points[triangle[i]];
      piece.parameters[i] = surface.parameters[triangle[i]];
    }
    pieces.push_back(piece);
  }
  return pieces;
}

FacetedSource faceted_source(const Entity& entity, const std::vector<ShapePiece>& pieces) {
  FacetedSource source;
  source.entity = entity;
  for (const ShapePiece& piece : pieces) {
    append(piece, source);
  }
  return source;
}

FacetedSource with_curvatures(const Entity& entity, std::vector<ShapePiece> pieces,
                              const SizeFunction& function) {
  constexpr int most_halvings = 20;
  constexpr double smallest_part = 0.005;  // of the whole shape
  FacetedSource source;
  source.entity = entity;
  Box box;
  for (const ShapePiece& piece : pieces) {
    for (const Vec3& point : piece.points) {
      box.extend(point);
    }
  }
  const Variation variation{function, box.isEmpty() ? 0.0 : smallest_part * box.diagonal().norm()};
  std::vector<double>& known =
      entity.dim == 1 ? source.segment_curvatures : source.triangle_curvatures;
  for (int halving = 0; !pieces.empty(); ++halving) {
    const std::vector<double> curvatures = curvatures_inside(entity, pieces);
    std::vector<ShapePiece> open;
    const double* of_piece = curvatures.data();
    for (const ShapePiece& piece : pieces) {
      const int side = halving < most_halvings ? variation.side_to_halve(piece, of_piece) : -1;
      if (side >= 0) {
        const std::array<ShapePiece, 2> halves = piece.halves(side);
        open.insert(open.end(), halves.begin(), halves.end());
      } else {
        known.push_back(of_piece[0]);
        append(piece, source);
      }
      of_piece += piece.corner_count + 1;
    }
    pieces = std::move(open);
  }
  return source;
}

}  // namespace meshgrow
