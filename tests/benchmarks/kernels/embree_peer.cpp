#include "embree_peer.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include "error.h"

namespace meshgrow::kernels {

EmbreePeer::EmbreePeer(const SizedFacets& triangles)
    : device_(rtcNewDevice("threads=1")), scene_(rtcNewScene(device_)) {
  triangles_.reserve(triangles.size() + 1);  // Embree reads a little behind the last vertex
  for (const SizedFacet& triangle : triangles) {
    Corners corners;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3f corner = triangle.facet.corners[i].cast<float>();
      corners[i] = {corner.x(), corner.y(), corner.z()};
    }
    triangles_.push_back(corners);
  }
  const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                             triangles_.data(), 0, sizeof(Float3), 3 * triangles_.size());
  auto* const indices = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(std::uint32_t), triangles_.size()));
  std::iota(indices, indices + 3 * triangles_.size(), 0U);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene_);
  if (rtcGetDeviceError(device_) != RTC_ERROR_NONE) {
    throw Error("Embree could not build its tree.");
  }
}

EmbreePeer::~EmbreePeer() {
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

void EmbreePeer::distances(const Vec3* points, std::size_t count, double* distances) const {
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3f p = points[i].cast<float>();
    RTCPointQuery query{p.x(), p.y(), p.z(), 0.0F, std::numeric_limits<float>::infinity()};
    rtcPointQuery(scene_, &query, &context, shrink_query, const_cast<Corners*>(triangles_.data()));
    distances[i] = query.radius;
  }
}

/// Called for each triangle that may be within the query's radius.
bool EmbreePeer::shrink_query(RTCPointQueryFunctionArguments* arguments) {
  RTCPointQuery& query = *arguments->query;
  const Corners& triangle = static_cast<const Corners*>(arguments->userPtr)[arguments->primID];
  const Float3 p{query.x, query.y, query.z};
  const Float3 q = closest_point(triangle, p);
  const Float3 d{q.x - p.x, q.y - p.y, q.z - p.z};
  const float distance = std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
  if (!(distance < query.radius)) {
    return false;
  }
  query.radius = distance;
  return true;
}

/// By the Voronoi regions of corners, sides and face (Ericson: Real-Time Collision Detection,
/// section 5.1.5), as in Embree's own example.
EmbreePeer::Float3 EmbreePeer::closest_point(const Corners& triangle, const Float3& p) {
  const auto minus = [](const Float3& u, const Float3& v) {
    return Float3{u.x - v.x, u.y - v.y, u.z - v.z};
  };
  const auto dot = [](const Float3& u, const Float3& v) {
    return u.x * v.x + u.y * v.y + u.z * v.z;
  };
  const auto plus = [](const Float3& u, float s, const Float3& v) {
    return Float3{u.x + s * v.x, u.y + s * v.y, u.z + s * v.z};
  };
  const auto& [a, b, c] = triangle;
  const Float3 ab = minus(b, a);
  const Float3 ac = minus(c, a);
  const Float3 ap = minus(p, a);
  const float d1 = dot(ab, ap);
  const float d2 = dot(ac, ap);
  if (d1 <= 0.0F && d2 <= 0.0F) {
    return a;
  }
  const Float3 bp = minus(p, b);
  const float d3 = dot(ab, bp);
  const float d4 = dot(ac, bp);
  if (d3 >= 0.0F && d4 <= d3) {
    return b;
  }
  const Float3 cp = minus(p, c);
  const float d5 = dot(ab, cp);
  const float d6 = dot(ac, cp);
  if (d6 >= 0.0F && d5 <= d6) {
    return c;
  }
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0F && d1 >= 0.0F && d3 <= 0.0F) {
    return plus(a, d1 / (d1 - d3), ab);
  }
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0F && d2 >= 0.0F && d6 <= 0.0F) {
    return plus(a, d2 / (d2 - d6), ac);
  }
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0.0F && d4 - d3 >= 0.0F && d5 - d6 >= 0.0F) {
    return plus(b, (d4 - d3) / ((d4 - d3) + (d5 - d6)), minus(c, b));
  }
  const float share = 1.0F / (va + vb + vc);
  return plus(plus(a, vb * share, ab), vc * share, ac);
}

}  // namespace meshgrow::kernels
