#ifndef MESHGROW_WORST_PLACES_H
#define MESHGROW_WORST_PLACES_H

#include <string>
#include <vector>

#include "mesh_report.h"

namespace meshgrow {

/// A place in a mesh that decides a number of its report.
struct WorstPlace {
  double value = 0.0;  ///< what was measured there
  /// By Gmsh's tags: both of a pair of neighbours, one of those that an edge belongs to.
  std::vector<std::size_t> elements;
  Entity entity;  ///< of the first of them
  Vec3 point;     ///< middle of the element, of what a pair shares about, or of the edge
};

/// At most `count` places that decide the number `name` of a report, by its name in JSON, such as
/// "ratio_99": neighbours with their size ratio, elements with their size, gamma or SICN, edges
/// with their length over the size asked for. Those with the largest values come first if `largest`
/// holds, else those with the smallest; for "length_share_good", whose large values are good, edges
/// whose length is furthest from the size asked for come first unless `largest` holds. None for
/// "elements". Throws Error if a report has no such number. Thread-safe.
std::vector<WorstPlace> worst_places(const ReportMesh& mesh, const SizeAsked& size_asked,
                                     const std::string& name, bool largest, std::size_t count);

}  // namespace meshgrow

#endif
