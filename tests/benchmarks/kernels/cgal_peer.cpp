#include "cgal_peer.h"

#include <CGAL/AABB_segment_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <vector>

namespace meshgrow::kernels {

namespace {

// Plain doubles: the fastest of CGAL's kernels here, as squared distances need no exact predicates.
using Kernel = CGAL::Simple_cartesian<double>;
using Point = Kernel::Point_3;
using Triangle = Kernel::Triangle_3;
using Segment = Kernel::Segment_3;
using TrianglePrimitive =
    CGAL::AABB_triangle_primitive<Kernel, std::vector<Triangle>::const_iterator>;
using SegmentPrimitive = CGAL::AABB_segment_primitive<Kernel, std::vector<Segment>::const_iterator>;

Point point(const Vec3& p) { return Point(p.x(), p.y(), p.z()); }

void append(const Facet& facet, std::vector<Triangle>& triangles) {
  triangles.emplace_back(point(facet.corners[0]), point(facet.corners[1]), point(facet.corners[2]));
}

void append(const Facet& facet, std::vector<Segment>& segments) {
  segments.emplace_back(point(facet.corners[0]), point(facet.corners[1]));
}

}  // namespace

class CgalPeer::Tree {
 public:
  virtual ~Tree() = default;
  virtual void build() = 0;
  virtual void clear() = 0;
  virtual void squared_distances(const Vec3* points, std::size_t count, double* squared) const = 0;
};

template <typename Datum, typename Primitive>
class CgalPeer::TreeOf : public CgalPeer::Tree {
 public:
  explicit TreeOf(const SizedFacets& facets) {
    data_.reserve(facets.size());
    for (const SizedFacet& facet : facets) {
      append(facet.facet, data_);
    }
  }

  void build() override {
    tree_ = std::make_unique<AabbTree>(data_.cbegin(), data_.cend());
    tree_->build();
    tree_->accelerate_distance_queries();
    // Parts of the hints are made by the first query only: they belong to the building.
    first_ = tree_->squared_distance(Point(0.0, 0.0, 0.0));
  }

  void clear() override { tree_.reset(); }

  void squared_distances(const Vec3* points, std::size_t count, double* squared) const override {
    for (std::size_t i = 0; i < count; ++i) {
      squared[i] = tree_->squared_distance(point(points[i]));
    }
  }

 private:
  using AabbTree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

  std::vector<Datum> data_;
  std::unique_ptr<AabbTree> tree_;
  double first_ = 0.0;
};

CgalPeer::CgalPeer(const SizedFacets& facets) {
  if (facets.front().facet.corner_count == 3) {
    tree_ = std::make_unique<TreeOf<Triangle, TrianglePrimitive>>(facets);
  } else {
    tree_ = std::make_unique<TreeOf<Segment, SegmentPrimitive>>(facets);
  }
}

CgalPeer::~CgalPeer() = default;

void CgalPeer::build() { tree_->build(); }
void CgalPeer::clear() { tree_->clear(); }

void CgalPeer::squared_distances(const Vec3* points, std::size_t count, double* squared) const {
  tree_->squared_distances(points, count, squared);
}

}  // namespace meshgrow::kernels
