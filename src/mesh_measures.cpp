#include "mesh_measures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

namespace meshgrow {

namespace {

using Edge = std::array<int, 2>;
using Face =
    std::array<int, 4>;  // the last is -1 for a triangle or edge, so is the third for an edge

struct Shape {
  int corners;
  std::vector<Edge> edges;
  std::vector<Face> faces;  // in 2D the edges: what two neighbours share
};

const Shape& shape_of(ElementShape shape) {
  static const std::array<Shape, 6> shapes = {
      Shape{3, {{0, 1}, {1, 2}, {2, 0}}, {{0, 1, -1, -1}, {1, 2, -1, -1}, {2, 0, -1, -1}}},
      Shape{4,
            {{0, 1}, {1, 2}, {2, 3}, {3, 0}},
            {{0, 1, -1, -1}, {1, 2, -1, -1}, {2, 3, -1, -1}, {3, 0, -1, -1}}},
      Shape{4,
            {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}},
            {{0, 1, 2, -1}, {0, 1, 3, -1}, {1, 2, 3, -1}, {0, 2, 3, -1}}},
      Shape{8,
            {{0, 1},
             {1, 2},
             {2, 3},
             {3, 0},
             {4, 5},
             {5, 6},
             {6, 7},
             {7, 4},
             {0, 4},
             {1, 5},
             {2, 6},
             {3, 7}},
            {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}},
      Shape{6,
            {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}},
            {{0, 1, 2, -1}, {3, 4, 5, -1}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}},
      Shape{5,
            {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}},
            {{0, 1, 2, 3}, {0, 1, 4, -1}, {1, 2, 4, -1}, {2, 3, 4, -1}, {3, 0, 4, -1}}}};
  return shapes[static_cast<std::size_t>(shape)];
}

const Vec3& corner(const ReportMesh& mesh, const ReportElement& element, int i) {
  return mesh.nodes[element.corners[i]];
}

double element_size(const ReportMesh& mesh, const ReportElement& element) {
  const Shape& shape = shape_of(element.shape);
  double sum = 0.0;
  for (const auto& [i, j] : shape.edges) {
    sum += (corner(mesh, element, j) - corner(mesh, element, i)).norm();
  }
  return sum / static_cast<double>(shape.edges.size());
}

struct SimplexQuality {
  double gamma;
  double sicn;
};

SimplexQuality triangle_quality(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double ab = (b - a).norm();
  const double bc = (c - b).norm();
  const double ca = (a - c).norm();
  const double twice_area = (b - a).cross(c - a).norm();
  if (!(twice_area > 0.0)) {
    return {0.0, 0.0};
  }
  const double in_radius = twice_area / (ab + bc + ca);
  const double circum_radius = ab * bc * ca / (2.0 * twice_area);
  const double squares = ab * ab + bc * bc + ca * ca;
  return {2.0 * in_radius / circum_radius, 2.0 * std::sqrt(3.0) * twice_area / squares};
}

SimplexQuality tetrahedron_quality(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  Eigen::Matrix3d edges;
  edges << b - a, c - a, d - a;
  const double determinant = edges.determinant();
  if (determinant == 0.0) {
    return {0.0, 0.0};
  }
  const double volume = std::abs(determinant) / 6.0;
  const double surface = 0.5 * ((b - a).cross(c - a).norm() + (c - a).cross(d - a).norm() +
                                (d - a).cross(b - a).norm() + (c - b).cross(d - b).norm());
  const double in_radius = 3.0 * volume / surface;
  // Circumscribed radius by the products of opposite edges (Crelle's formula).
  const double p = (b - a).norm() * (d - c).norm();
  const double q = (c - a).norm() * (d - b).norm();
  const double r = (d - a).norm() * (c - b).norm();
  const double product = (p + q + r) * (p + q - r) * (p - q + r) * (-p + q + r);
  const double circum_radius = std::sqrt(std::max(product, 0.0)) / (24.0 * volume);
  // Jacobian of the map from the regular tetrahedron.
  Eigen::Matrix3d regular;
  regular << 1.0, 0.5, 0.5,                             //
      0.0, std::sqrt(3.0) / 2.0, std::sqrt(3.0) / 6.0,  //
      0.0, 0.0, std::sqrt(2.0 / 3.0);
  const Eigen::Matrix3d jacobian = edges * regular.inverse();
  const double condition = jacobian.norm() * jacobian.inverse().norm();
  const double gamma = circum_radius > 0.0 ? 3.0 * in_radius / circum_radius : 0.0;
  return {gamma, (determinant > 0.0 ? 3.0 : -3.0) / condition};
}

}  // namespace

int corner_count(ElementShape shape) { return shape_of(shape).corners; }

std::vector<double> element_sizes(const ReportMesh& mesh) {
  std::vector<double> sizes;
  sizes.reserve(mesh.elements.size());
  for (const ReportElement& element : mesh.elements) {
    sizes.push_back(element_size(mesh, element));
  }
  return sizes;
}

std::vector<NeighbourPair> neighbour_pairs(const ReportMesh& mesh,
                                           const std::vector<double>& sizes) {
  using Key = std::array<std::uint32_t, 4>;
  std::vector<std::pair<Key, std::uint32_t>> sides;
  for (std::uint32_t e = 0; e < mesh.elements.size(); ++e) {
    const ReportElement& element = mesh.elements[e];
    for (const Face& face : shape_of(element.shape).faces) {
      Key key;
      for (int i = 0; i < 4; ++i) {
        key[i] = face[i] < 0 ? 0xFFFFFFFFu : element.corners[face[i]];
      }
      std::sort(key.begin(), key.end());
      sides.emplace_back(key, e);
    }
  }
  std::sort(sides.begin(), sides.end());
  std::vector<NeighbourPair> pairs;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    for (std::size_t j = i + 1; j < sides.size() && sides[j].first == sides[i].first; ++j) {
      const double a = sizes[sides[i].second];
      const double b = sizes[sides[j].second];
      pairs.push_back({sides[i].second, sides[j].second, std::max(a, b) / std::min(a, b)});
    }
  }
  return pairs;
}

std::vector<MeasuredEdge> measured_edges(const ReportMesh& mesh, const SizeAsked& size_asked) {
  struct EntityEdge {
    Entity entity;
    std::uint32_t a, b, element;
    bool operator<(const EntityEdge& o) const {
      return std::tie(entity, a, b, element) < std::tie(o.entity, o.a, o.b, o.element);
    }
    bool operator==(const EntityEdge& o) const {
      return entity == o.entity && a == o.a && b == o.b;
    }
  };
  std::vector<EntityEdge> edges;
  for (std::uint32_t e = 0; e < mesh.elements.size(); ++e) {
    const ReportElement& element = mesh.elements[e];
    for (const auto& [i, j] : shape_of(element.shape).edges) {
      const auto [a, b] = std::minmax(element.corners[i], element.corners[j]);
      edges.push_back({element.entity, a, b, e});
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::vector<MeasuredEdge> result;
  for (const EntityEdge& edge : edges) {
    const Vec3& a = mesh.nodes[edge.a];
    const Vec3& b = mesh.nodes[edge.b];
    const double asked = size_asked(edge.entity, 0.5 * (a + b));
    if (std::isfinite(asked) && asked > 0.0) {
      result.push_back({edge.element, edge.a, edge.b, (b - a).norm() / asked});
    }
  }
  return result;
}

std::vector<ElementQuality> element_qualities(const ReportMesh& mesh) {
  std::vector<ElementQuality> qualities;
  for (std::uint32_t i = 0; i < mesh.elements.size(); ++i) {
    const ReportElement& e = mesh.elements[i];
    SimplexQuality quality;
    if (e.shape == ElementShape::triangle) {
      quality = triangle_quality(corner(mesh, e, 0), corner(mesh, e, 1), corner(mesh, e, 2));
    } else if (e.shape == ElementShape::tetrahedron) {
      quality = tetrahedron_quality(corner(mesh, e, 0), corner(mesh, e, 1), corner(mesh, e, 2),
                                    corner(mesh, e, 3));
    } else {
      continue;
    }
    qualities.push_back({i, quality.gamma, quality.sicn});
  }
  return qualities;
}

}  // namespace meshgrow
