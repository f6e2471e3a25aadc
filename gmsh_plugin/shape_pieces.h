#ifndef MESHGROW_SHAPE_PIECES_H
#define MESHGROW_SHAPE_PIECES_H

#include <array>
#include <vector>

#include "faceted_source.h"
#include "shape_sampler.h"
#include "size_function.h"

namespace meshgrow {

/// A segment or triangle of a curve or surface with geometry: its corners in space and in the
/// parameters of the shape (the second parameter of a curve is 0).
struct ShapePiece {
  int corner_count = 3;
  std::array<Vec3, 3> points;
  std::array<std::array<double, 2>, 3> parameters;

  Vec3 centre() const;
  /// Length of the side that begins at this corner.
  double side(int from) const;
  double longest_side() const;

  /// Cut in the middle of the side that begins at this corner.
  std::array<ShapePiece, 2> halves(int from) const;

  /// Parameters at the weighted mean of the corners: the weight of corner i, those of the others
  /// equal.
  std::array<double, 2> inside(int i, double weight) const;

  /// Half the steps of differences that measure the curvature of the shape on the piece.
  std::array<double, 2> steps() const;
};

std::vector<ShapePiece> pieces_of(const SampledCurve& curve);
std::vector<ShapePiece> pieces_of(const SampledSurface& surface);

/// The pieces without their parameters.
FacetedSource faceted_source(const Entity& entity, const std::vector<ShapePiece>& pieces);

/// The pieces with the curvature of the entity's geometry at their centres. Those on which the size
/// of a curvature size function varies noticeably are halved until it hardly does, unless they are
/// too small for it to matter beside growth.
FacetedSource with_curvatures(const Entity& entity, std::vector<ShapePiece> pieces,
                              const SizeFunction& function);

}  // namespace meshgrow

#endif
