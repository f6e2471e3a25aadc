#ifndef MESHGROW_TESTS_WALL_SHAPES_H
#define MESHGROW_TESTS_WALL_SHAPES_H

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "faceted_source.h"
#include "geometry.h"

/// Faces and curves of simple shapes, whose facets fit together to the bit.
namespace meshgrow::test {

using Sources = std::vector<FacetedSource>;

constexpr double pi = 3.14159265358979323846;

inline Sources joined(Sources a, const Sources& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

inline std::set<Entity> entities_of(const Sources& sources) {
  std::set<Entity> entities;
  for (const FacetedSource& source : sources) {
    entities.insert(source.entity);
  }
  return entities;
}

template <typename Map>
Sources moved(Sources sources, Map map) {
  for (FacetedSource& source : sources) {
    for (auto& facet : source.segments) {
      std::transform(facet.begin(), facet.end(), facet.begin(), map);
    }
    for (auto& facet : source.triangles) {
      std::transform(facet.begin(), facet.end(), facet.begin(), map);
    }
    for (auto& facet : source.quads) {
      std::transform(facet.begin(), facet.end(), facet.begin(), map);
    }
  }
  return sources;
}

/// The same surface, each triangle the other way round with probability one half.
template <typename Random>
Sources with_mixed_orientation(Sources sources, Random& random) {
  for (FacetedSource& source : sources) {
    for (auto& triangle : source.triangles) {
      if (random() % 2 == 0) {
        std::swap(triangle[0], triangle[1]);
      }
    }
  }
  return sources;
}

/// A face of rows × columns cells, two triangles each, at(i, j) for i up to rows, j up to columns.
template <typename At>
FacetedSource patch(int tag, int rows, int columns, At at) {
  FacetedSource face;
  face.entity = {2, tag};
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      const Vec3 a = at(i, j);
      const Vec3 b = at(i + 1, j);
      const Vec3 c = at(i + 1, j + 1);
      const Vec3 d = at(i, j + 1);
      face.triangles.push_back({a, b, c});
      face.triangles.push_back({a, c, d});
    }
  }
  return face;
}

/// The six faces of a box with the tags first_tag (x low), …+1 (x high), … +5 (z high), n × n
/// cells.
inline Sources box_faces(const Vec3& low, const Vec3& high, int n = 1, int first_tag = 1) {
  Sources faces;
  for (int axis = 0; axis < 3; ++axis) {
    for (int end = 0; end < 2; ++end) {
      faces.push_back(patch(first_tag + 2 * axis + end, n, n, [&](int i, int j) {
        const double s[3] = {static_cast<double>(end), static_cast<double>(i) / n,
                             static_cast<double>(j) / n};
        Vec3 p;
        for (int k = 0; k < 3; ++k) {
          const double t = s[(k - axis + 3) % 3];
          p[k] = t == 1.0 ? high[k] : low[k] + t * (high[k] - low[k]);
        }
        return p;
      }));
    }
  }
  return faces;
}

/// One face; an icosahedron whose sides are halved `levels` times: 20 · 4^levels triangles.
inline FacetedSource sphere_face(int tag, const Vec3& centre, double radius, int levels) {
  const double t = 0.5 * (1.0 + std::sqrt(5.0));
  std::vector<Vec3> corners = {{-1, t, 0}, {1, t, 0}, {-1, -t, 0}, {1, -t, 0},
                               {0, -1, t}, {0, 1, t}, {0, -1, -t}, {0, 1, -t},
                               {t, 0, -1}, {t, 0, 1}, {-t, 0, -1}, {-t, 0, 1}};
  const int faces[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                            {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                            {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                            {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  std::vector<std::array<Vec3, 3>> triangles;
  for (const auto& face : faces) {
    triangles.push_back({corners[face[0]].normalized(), corners[face[1]].normalized(),
                         corners[face[2]].normalized()});
  }
  for (int level = 0; level < levels; ++level) {
    std::vector<std::array<Vec3, 3>> finer;
    for (const auto& [a, b, c] : triangles) {
      const Vec3 ab = (a + b).normalized();
      const Vec3 bc = (b + c).normalized();
      const Vec3 ca = (c + a).normalized();
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    triangles = std::move(finer);
  }
  FacetedSource face;
  face.entity = {2, tag};
  for (const auto& [a, b, c] : triangles) {
    face.triangles.push_back({centre + radius * a, centre + radius * b, centre + radius * c});
  }
  return face;
}

using Outline = std::vector<Vec3>;  ///< closed, z = 0

/// Two outlines with as many points, joined point by point: the ring between them.
inline FacetedSource ring_face(int tag, const Outline& inner, const Outline& outer, int cells = 1) {
  const auto n = static_cast<int>(inner.size());
  return patch(tag, n, cells, [&](int i, int j) {
    const Vec3& a = inner[i % n];
    const Vec3& b = outer[i % n];
    return j == 0 ? a : j == cells ? b : Vec3(a + (static_cast<double>(j) / cells) * (b - a));
  });
}

/// The wall above an outline, from z = 0 to the height.
inline FacetedSource mantle_face(int tag, const Outline& outline, double height, int cells = 1) {
  const auto n = static_cast<int>(outline.size());
  return patch(tag, n, cells, [&](int i, int j) {
    return Vec3(outline[i % n].x(), outline[i % n].y(), j == cells ? height : height * j / cells);
  });
}

inline Outline circle(const Vec3& centre, double radius, int count) {
  Outline outline;
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * pi * i / count;
    outline.push_back(centre + radius * Vec3(std::cos(angle), std::sin(angle), 0.0));
  }
  return outline;
}

/// The square |x|, |y| ≤ half, seen from a point inside in `count` even directions; its corners
/// replace the points next to them.
inline Outline square_around(const Vec3& centre, double half, int count) {
  Outline outline;
  for (const Vec3& d : circle(Vec3::Zero(), 1.0, count)) {
    double t = 1e300;
    for (int k = 0; k < 2; ++k) {
      if (std::abs(d[k]) > 1e-12) {
        t = std::min(t, (std::copysign(half, d[k]) - centre[k]) / d[k]);
      }
    }
    Vec3 p = centre + t * d;
    for (int k = 0; k < 2; ++k) {
      p[k] = std::abs(std::abs(p[k]) - half) < 1e-9 ? std::copysign(half, p[k]) : p[k];
    }
    outline.push_back(p);
  }
  for (const double x : {-half, half}) {
    for (const double y : {-half, half}) {
      const Vec3 corner(x, y, 0.0);
      *std::min_element(outline.begin(), outline.end(), [&](const Vec3& a, const Vec3& b) {
        return (a - corner).norm() < (b - corner).norm();
      }) = corner;
    }
  }
  return outline;
}

/// A square plate with a round hole: two caps (1, 2), the hole's wall (3) and the outer wall (4).
inline Sources plate_with_hole(const Outline& hole, const Outline& outline, double height) {
  const FacetedSource bottom = ring_face(1, hole, outline);
  FacetedSource top = bottom;
  top.entity.tag = 2;
  top = moved({top}, [height](const Vec3& p) { return Vec3(p.x(), p.y(), height); }).front();
  return {bottom, top, mantle_face(3, hole, height), mantle_face(4, outline, height)};
}

/// A prism over a convex outline: two caps (1, 2), then a face for each side of the outline (3 …),
/// n cells along and up each.
inline Sources prism(const Outline& outline, double height, int n = 1) {
  Sources faces(2);
  const auto count = static_cast<int>(outline.size());
  const auto up = [&](Vec3 p, int j) {
    p.z() = j == n ? height : height * j / n;
    return p;
  };
  const auto along = [&](int side, int i) {
    const Vec3& a = outline[side];
    const Vec3& b = outline[(side + 1) % count];
    return i == 0 ? a : i == n ? b : Vec3(a + (static_cast<double>(i) / n) * (b - a));
  };
  Vec3 centre = Vec3::Zero();
  for (const Vec3& p : outline) {
    centre += p / count;
  }
  for (int cap = 0; cap < 2; ++cap) {
    faces[cap].entity = {2, cap + 1};
    for (int side = 0; side < count; ++side) {
      for (int i = 0; i < n; ++i) {
        faces[cap].triangles.push_back(
            {up(centre, cap * n), up(along(side, i), cap * n), up(along(side, i + 1), cap * n)});
      }
    }
  }
  for (int side = 0; side < count; ++side) {
    faces.push_back(patch(3 + side, n, n, [&](int i, int j) { return up(along(side, i), j); }));
  }
  return faces;
}

inline FacetedSource curve_of(int tag, const Outline& outline, bool closed = true) {
  FacetedSource curve;
  curve.entity = {1, tag};
  for (std::size_t i = 0; i + 1 < outline.size() + (closed ? 1 : 0); ++i) {
    curve.segments.push_back({outline[i], outline[(i + 1) % outline.size()]});
  }
  return curve;
}

}  // namespace meshgrow::test

#endif
