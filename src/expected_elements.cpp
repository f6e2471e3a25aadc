#include "expected_elements.h"

#include <algorithm>
#include <cmath>

namespace meshgrow {

namespace {

constexpr double pi = 3.14159265358979323846;

/// Gmsh's tetrahedra are about a quarter longer than asked, regular ones have h³ / (6 √2).
constexpr double tetrahedra_per_cube = 4.2;

double area(const Facet& facet) {
  return 0.5 *
         (facet.corners[1] - facet.corners[0]).cross(facet.corners[2] - facet.corners[0]).norm();
}

/// The integral of weight(r) / (S0 + α r)³ from the facet to the depth, weight being the area, per
/// facet, of what lies at the distance r: around surfaces it grows as around a sphere of the given
/// radius.
double integral(const SizedFacet& sized, double depth, double radius) {
  // The substitution r = depth · u³ puts most of the samples where most of the elements are.
  constexpr int samples = 24;
  double sum = 0.0;
  for (int i = 0; i < samples; ++i) {
    const double u = (i + 0.5) / samples;
    const double r = depth * u * u * u;
    const double size = sized.start_size + sized.slope * r;
    double weight = 4.0 * pi * r * r;
    if (sized.facet.corner_count == 2) {
      weight = 2.0 * pi * r * (sized.facet.corners[1] - sized.facet.corners[0]).norm();
    } else if (sized.facet.corner_count == 3) {
      weight = area(sized.facet) * (1.0 + r / radius) * (1.0 + r / radius);
    }
    sum += weight / (size * size * size) * 3.0 * depth * u * u / samples;
  }
  return sum;
}

}  // namespace

double expected_tetrahedra(const StoredArray<SizedFacet>& facets, double size_limit,
                           const Box& box) {
  if (box.isEmpty()) {
    return 0.0;
  }
  const double volume = box.sizes().prod();
  double far = volume / std::pow(size_limit, 3.0);
  if (facets.empty()) {
    return tetrahedra_per_cube * far;
  }
  // A sample is enough, as for any estimate.
  constexpr std::size_t sample = 4096;
  const std::size_t stride = std::max<std::size_t>(1, facets.size() / sample);
  double areas = 0.0;
  for (std::size_t i = 0; i < facets.size(); i += stride) {
    areas += facets[i].facet.corner_count == 3 ? area(facets[i].facet) : 0.0;
  }
  const double radius =
      std::sqrt(std::max(areas * static_cast<double>(stride), 1e-300) / (4.0 * pi));
  double near = 0.0;
  double smallest = size_limit;
  std::size_t count = 0;
  for (std::size_t i = 0; i < facets.size(); i += stride, ++count) {
    const SizedFacet& facet = facets[i];
    smallest = std::min(smallest, facet.start_size);
    double depth = box.diagonal().norm();
    if (facet.slope > 0.0) {
      depth = std::min(depth, std::max(0.0, size_limit - facet.start_size) / facet.slope);
    }
    near += integral(facet, depth, radius);
  }
  near *= static_cast<double>(facets.size()) / static_cast<double>(count);
  return tetrahedra_per_cube * std::min(near + far, volume / std::pow(smallest, 3.0));
}

}  // namespace meshgrow
