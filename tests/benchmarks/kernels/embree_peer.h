#ifndef MESHGROW_BENCHMARKS_KERNELS_EMBREE_PEER_H
#define MESHGROW_BENCHMARKS_KERNELS_EMBREE_PEER_H

#include <embree3/rtcore.h>

#include <array>
#include <cstddef>
#include <vector>

#include "sized_facets.h"

namespace meshgrow::kernels {

/// Distances to triangles by Embree's point query, in single precision.
class EmbreePeer {
 public:
  /// Takes the triangles over and builds Embree's tree.
  explicit EmbreePeer(const SizedFacets& triangles);
  ~EmbreePeer();
  EmbreePeer(const EmbreePeer&) = delete;
  EmbreePeer& operator=(const EmbreePeer&) = delete;

  void distances(const Vec3* points, std::size_t count, double* distances) const;

 private:
  struct Float3 {
    float x, y, z;
  };
  using Corners = std::array<Float3, 3>;

  static bool shrink_query(RTCPointQueryFunctionArguments* arguments);
  static Float3 closest_point(const Corners& triangle, const Float3& p);

  std::vector<Corners> triangles_;
  RTCDevice device_;
  RTCScene scene_;
};

}  // namespace meshgrow::kernels

#endif
