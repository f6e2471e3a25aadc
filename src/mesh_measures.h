#ifndef MESHGROW_MESH_MEASURES_H
#define MESHGROW_MESH_MEASURES_H

#include <cstdint>
#include <vector>

#include "mesh_report.h"

/// What a mesh report is made of (DESIGN.md, section 6), element by element. All thread-safe.
namespace meshgrow {

/// Mean edge length of each element.
std::vector<double> element_sizes(const ReportMesh& mesh);

/// Two elements that share a face (an edge, in 2D), by index. Where three and more meet at an edge,
/// each pair counts.
struct NeighbourPair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  double size_ratio = 1.0;  ///< larger over smaller size
};
std::vector<NeighbourPair> neighbour_pairs(const ReportMesh& mesh,
                                           const std::vector<double>& sizes);

/// An edge of the mesh, once for each entity that it is in.
struct MeasuredEdge {
  std::uint32_t element = 0;  ///< one that it belongs to
  std::uint32_t a = 0;        ///< its nodes
  std::uint32_t b = 0;
  double relative_length = 0.0;  ///< over the size asked for at its midpoint
};
/// Those for which a size is asked for.
std::vector<MeasuredEdge> measured_edges(const ReportMesh& mesh, const SizeAsked& size_asked);

/// Gmsh's measures of a triangle or tetrahedron, see MeshReport.
struct ElementQuality {
  std::uint32_t element = 0;
  double gamma = 0.0;
  double sicn = 0.0;
};
std::vector<ElementQuality> element_qualities(const ReportMesh& mesh);

}  // namespace meshgrow

#endif
