#ifndef MESHGROW_BOUNDARY_DISTANCE_H
#define MESHGROW_BOUNDARY_DISTANCE_H

#include <vector>

#include "facet_tree.h"
#include "topology.h"

namespace meshgrow {

/// Distance to the mesh on all surfaces that bound some volumes or are embedded in them. Queries
/// may come from any thread.
class BoundaryDistance {
 public:
  /// Reads the meshes of the surfaces as they are in Gmsh's current model now.
  BoundaryDistance(const std::vector<Entity>& volumes, const Topology& topology);

  /// The distance from p, or `at_most` where it is larger; a small bound makes it fast.
  double operator()(const Vec3& p, double at_most) const { return tree_.size(p, at_most); }

 private:
  FacetTree tree_;
};

}  // namespace meshgrow

#endif
