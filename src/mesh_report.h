#ifndef MESHGROW_MESH_REPORT_H
#define MESHGROW_MESH_REPORT_H

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "entity.h"
#include "geometry.h"

namespace meshgrow {

enum class ElementShape { triangle, quad, tetrahedron, hexahedron, prism, pyramid };

int corner_count(ElementShape shape);

/// One element by its corner nodes (indices into ReportMesh::nodes), in Gmsh's order.
struct ReportElement {
  ElementShape shape = ElementShape::tetrahedron;
  Entity entity;
  std::array<std::uint32_t, 8> corners{};
  std::size_t tag = 0;  ///< Gmsh's
};

/// The elements to report on, all of one dimension.
struct ReportMesh {
  std::vector<Vec3> nodes;
  std::vector<ReportElement> elements;
};

/// Gradation and quality of a mesh (DESIGN.md, section 6). Element size is the mean edge length.
/// What could not be measured is not a number.
struct MeshReport {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  std::size_t elements = 0;
  double smallest_size = unknown;
  double largest_size = unknown;
  /// Larger over smaller size of two elements that share a face (an edge, in 2D).
  double ratio_max = unknown;
  double ratio_99 = unknown;
  /// Edge length over the size asked for at the edge's midpoint; each edge once per entity.
  double length_median = unknown;
  double length_share_good = unknown;  ///< within [1/√2, √2]
  double length_share_over_2 = unknown;
  /// Gmsh's measures, of triangles and tetrahedra: inscribed over circumscribed radius, and signed
  /// inverse condition number; both 1 for the regular simplex.
  double gamma_min = unknown;
  double gamma_mean = unknown;
  double sicn_min = unknown;
  double sicn_mean = unknown;
};

/// Size asked for on the entity at a point; infinite or not a number: none, the edge is left out.
using SizeAsked = std::function<double(const Entity&, const Vec3&)>;

/// `size_asked` may be empty. Thread-safe.
MeshReport make_report(const ReportMesh& mesh, const SizeAsked& size_asked = {});

struct NamedReport {
  std::string name;
  MeshReport report;
};

/// The reports as a table for people, a line each.
std::string report_table(const std::vector<NamedReport>& reports);

}  // namespace meshgrow

#endif
