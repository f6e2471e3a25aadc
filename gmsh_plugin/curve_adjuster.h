#ifndef MESHGROW_CURVE_ADJUSTER_H
#define MESHGROW_CURVE_ADJUSTER_H

#include <functional>
#include <map>
#include <set>
#include <vector>

#include "interval_matching.h"
#include "mesh_constraints.h"
#include "size_answers.h"
#include "topology.h"

namespace meshgrow {

/// Brings the curves of mapped (transfinite) surfaces to matching numbers of intervals after Gmsh
/// has meshed them by their sizes (the "adjusted" meshes of the paper, section 5.2; DESIGN.md,
/// section 5, line 11). Gmsh gives a curve as many intervals as its sizes integrate to: the sizes
/// are scaled, which keeps their grading, and the curve is meshed again, until the number fits.
class CurveAdjuster {
 public:
  /// Of the mapped surfaces among `constraints` that have no mesh. The arguments must outlive this.
  CurveAdjuster(const Topology& topology, const MeshConstraints& constraints);

  /// Sets of curves whose numbers depend on each other.
  std::vector<std::vector<Entity>> connected_curves() const;

  /// Meshes these curves again, with these scales on their sizes.
  using MeshAgain =
      std::function<void(const std::vector<Entity>&, std::map<Entity, SizeAnswers::Scale>)>;

  /// Adjusts the curves of `stage`, which are meshed by now; other curves that have a mesh keep it.
  /// Returns those that were meshed again. Throws Error naming surface and curves if the numbers
  /// cannot be matched.
  std::vector<Entity> adjust(const std::vector<Entity>& stage, const MeshAgain& mesh_again) const;

 private:
  std::map<Entity, CurveIntervals> intervals_now(const std::set<Entity>& stage) const;

  const Topology& topology_;
  const MeshConstraints& constraints_;
  std::vector<OppositeSides> sides_;
};

}  // namespace meshgrow

#endif
