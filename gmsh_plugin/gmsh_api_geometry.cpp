// The geometry of curves and surfaces at parameters.

#include <array>

#include "gmsh_api.h"
#include "gmsh_memory.h"

namespace meshgrow::gmsh {

namespace {

std::vector<Vec3> to_vectors(const std::vector<double>& flat) {
  std::vector<Vec3> result;
  result.reserve(flat.size() / 3);
  for (std::size_t i = 0; i + 2 < flat.size(); i += 3) {
    result.emplace_back(flat[i], flat[i + 1], flat[i + 2]);
  }
  return result;
}

}  // namespace

std::vector<std::array<double, 2>> parameter_bounds(const Entity& entity) {
  GmshArray<double> low;
  GmshArray<double> high;
  library().call("gmshModelGetParametrizationBounds", entity.dim, entity.tag, low.data(),
                 low.size(), high.data(), high.size());
  const std::vector<double> lows = low.copy();
  const std::vector<double> highs = high.copy();
  std::vector<std::array<double, 2>> result;
  for (std::size_t i = 0; i < lows.size() && i < highs.size(); ++i) {
    result.push_back({lows[i], highs[i]});
  }
  return result;
}

std::vector<Vec3> points_at(const Entity& entity, const std::vector<double>& parameters) {
  GmshArray<double> coordinates;
  library().call("gmshModelGetValue", entity.dim, entity.tag, parameters.data(), parameters.size(),
                 coordinates.data(), coordinates.size());
  return to_vectors(coordinates.copy());
}

std::vector<Vec3> derivatives_at(const Entity& curve, const std::vector<double>& parameters) {
  GmshArray<double> derivatives;
  library().call("gmshModelGetDerivative", curve.dim, curve.tag, parameters.data(),
                 parameters.size(), derivatives.data(), derivatives.size());
  return to_vectors(derivatives.copy());
}

std::vector<double> parameters_on_surface(const Entity& curve,
                                          const std::vector<double>& parameters,
                                          const Entity& surface, bool other_side) {
  GmshArray<double> result;
  library().call("gmshModelReparametrizeOnSurface", curve.dim, curve.tag, parameters.data(),
                 parameters.size(), surface.tag, result.data(), result.size(), other_side ? 1 : 0);
  return result.copy();
}

std::vector<double> parameters_at(const Entity& entity, const std::vector<double>& coordinates) {
  GmshArray<double> parameters;
  library().call("gmshModelGetParametrization", entity.dim, entity.tag, coordinates.data(),
                 coordinates.size(), parameters.data(), parameters.size());
  return parameters.copy();
}

std::vector<Vec3> normals_at(const Entity& surface, const std::vector<double>& parameters) {
  GmshArray<double> normals;
  library().call("gmshModelGetNormal", surface.tag, parameters.data(), parameters.size(),
                 normals.data(), normals.size());
  return to_vectors(normals.copy());
}

bool is_inside(const Entity& surface, double u, double v) {
  std::array<double, 2> parameters = {u, v};
  // Gmsh 4.9 added the argument that tells parametric coordinates from points in space.
  if (library().has("gmshModelMeshGetMaxNodeTag")) {
    return library().call_int("gmshModelIsInside", surface.dim, surface.tag, parameters.data(),
                              parameters.size(), 1) > 0;
  }
  return library().call_int("gmshModelIsInside", surface.dim, surface.tag, parameters.data(),
                            parameters.size()) > 0;
}

}  // namespace meshgrow::gmsh
