#include "mesh_report.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "number_text.h"
#include "text_table.h"

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

/// Value at the fraction of the sorted values; reorders them.
double quantile(std::vector<double>& values, double fraction) {
  if (values.empty()) {
    return MeshReport::unknown;
  }
  const auto at = static_cast<std::size_t>(fraction * static_cast<double>(values.size() - 1) + 0.5);
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(at);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

/// Share of the values for which `counts` holds.
template <typename Condition>
double share(const std::vector<double>& values, Condition counts) {
  if (values.empty()) {
    return MeshReport::unknown;
  }
  const auto count = std::count_if(values.begin(), values.end(), counts);
  return static_cast<double>(count) / static_cast<double>(values.size());
}

void measure_ratios(const ReportMesh& mesh, const std::vector<double>& sizes, MeshReport& report) {
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
  std::vector<double> ratios;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    // Three and more elements may meet at an edge of a surface mesh: each pair counts.
    for (std::size_t j = i + 1; j < sides.size() && sides[j].first == sides[i].first; ++j) {
      const double a = sizes[sides[i].second];
      const double b = sizes[sides[j].second];
      ratios.push_back(std::max(a, b) / std::min(a, b));
    }
  }
  if (!ratios.empty()) {
    report.ratio_99 = quantile(ratios, 0.99);
    report.ratio_max = *std::max_element(ratios.begin(), ratios.end());
  }
}

void measure_lengths(const ReportMesh& mesh, const SizeAsked& size_asked, MeshReport& report) {
  struct EntityEdge {
    Entity entity;
    std::uint32_t a, b;
    bool operator<(const EntityEdge& o) const {
      return std::tie(entity, a, b) < std::tie(o.entity, o.a, o.b);
    }
    bool operator==(const EntityEdge& o) const {
      return entity == o.entity && a == o.a && b == o.b;
    }
  };
  std::vector<EntityEdge> edges;
  for (const ReportElement& element : mesh.elements) {
    for (const auto& [i, j] : shape_of(element.shape).edges) {
      const auto [a, b] = std::minmax(element.corners[i], element.corners[j]);
      edges.push_back({element.entity, a, b});
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::vector<double> lengths;
  for (const EntityEdge& edge : edges) {
    const Vec3& a = mesh.nodes[edge.a];
    const Vec3& b = mesh.nodes[edge.b];
    const double asked = size_asked(edge.entity, 0.5 * (a + b));
    if (std::isfinite(asked) && asked > 0.0) {
      lengths.push_back((b - a).norm() / asked);
    }
  }
  report.length_share_good = share(
      lengths, [](double length) { return length >= std::sqrt(0.5) && length <= std::sqrt(2.0); });
  report.length_share_over_2 = share(lengths, [](double length) { return length > 2.0; });
  report.length_median = quantile(lengths, 0.5);
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

void measure_quality(const ReportMesh& mesh, MeshReport& report) {
  std::vector<SimplexQuality> qualities;
  for (const ReportElement& e : mesh.elements) {
    if (e.shape == ElementShape::triangle) {
      qualities.push_back(
          triangle_quality(corner(mesh, e, 0), corner(mesh, e, 1), corner(mesh, e, 2)));
    } else if (e.shape == ElementShape::tetrahedron) {
      qualities.push_back(tetrahedron_quality(corner(mesh, e, 0), corner(mesh, e, 1),
                                              corner(mesh, e, 2), corner(mesh, e, 3)));
    }
  }
  if (qualities.empty()) {
    return;
  }
  report.gamma_min = report.sicn_min = std::numeric_limits<double>::infinity();
  report.gamma_mean = report.sicn_mean = 0.0;
  for (const SimplexQuality& quality : qualities) {
    report.gamma_min = std::min(report.gamma_min, quality.gamma);
    report.sicn_min = std::min(report.sicn_min, quality.sicn);
    report.gamma_mean += quality.gamma / static_cast<double>(qualities.size());
    report.sicn_mean += quality.sicn / static_cast<double>(qualities.size());
  }
}

std::string percent(double share_value) {
  return std::isnan(share_value) ? "-" : rounded(100.0 * share_value, 1) + " %";
}

std::string significant(double value) {
  if (std::isnan(value)) {
    return "-";
  }
  return shortest(value, 3);
}

}  // namespace

int corner_count(ElementShape shape) { return shape_of(shape).corners; }

MeshReport make_report(const ReportMesh& mesh, const SizeAsked& size_asked) {
  MeshReport report;
  report.elements = mesh.elements.size();
  if (mesh.elements.empty()) {
    return report;
  }
  std::vector<double> sizes;
  sizes.reserve(mesh.elements.size());
  for (const ReportElement& element : mesh.elements) {
    sizes.push_back(element_size(mesh, element));
  }
  report.smallest_size = *std::min_element(sizes.begin(), sizes.end());
  report.largest_size = *std::max_element(sizes.begin(), sizes.end());
  measure_ratios(mesh, sizes, report);
  if (size_asked) {
    measure_lengths(mesh, size_asked, report);
  }
  measure_quality(mesh, report);
  return report;
}

std::string report_table(const std::vector<NamedReport>& reports) {
  std::vector<std::vector<std::string>> rows = {{"mesh", "elements", "size min", "max", "ratio max",
                                                 "99 %", "length/size", "good", "> 2", "gamma min",
                                                 "mean", "SICN min", "mean"}};
  for (const auto& [name, r] : reports) {
    rows.push_back({name, grouped_digits(r.elements), significant(r.smallest_size),
                    significant(r.largest_size), rounded(r.ratio_max, 2), rounded(r.ratio_99, 2),
                    rounded(r.length_median, 2), percent(r.length_share_good),
                    percent(r.length_share_over_2), rounded(r.gamma_min, 3),
                    rounded(r.gamma_mean, 3), rounded(r.sicn_min, 3), rounded(r.sicn_mean, 3)});
  }
  return text_table(rows);
}

}  // namespace meshgrow
