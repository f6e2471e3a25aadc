#include "plane_cut.h"

#include <algorithm>
#include <cmath>

namespace meshgrow {

namespace {

constexpr int most_divisions = 6;

/// A plane with axes, along those of the model where it can be.
struct Frame {
  Vec3 origin;
  Vec3 u;
  Vec3 v;

  Vec3 at(double a, double b) const { return origin + a * u + b * v; }
};

Frame frame_of(const Vec3& point, const Vec3& normal) {
  const Vec3 n = normal.normalized();
  int least = 0;
  n.cwiseAbs().minCoeff(&least);
  const Vec3 u = (Vec3::Unit(least) - n[least] * n).normalized();
  return {point, u, n.cross(u)};
}

/// Where the plane cuts the edges of the box, in the frame.
std::vector<Eigen::Vector2d> crossings(const Box& box, const Frame& frame) {
  const Vec3 n = frame.u.cross(frame.v);
  const double reach = 1e-9 * (box.diagonal().norm() + (frame.origin - box.center()).norm());
  std::vector<Eigen::Vector2d> result;
  for (int i = 0; i < 8; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      if ((i >> axis & 1) != 0) {
        continue;
      }
      const Vec3 a = box.corner(static_cast<Box::CornerType>(i));
      const Vec3 b = box.corner(static_cast<Box::CornerType>(i | 1 << axis));
      const double from = n.dot(a - frame.origin);
      const double to = n.dot(b - frame.origin);
      const auto add = [&](const Vec3& p) {
        result.emplace_back(frame.u.dot(p - frame.origin), frame.v.dot(p - frame.origin));
      };
      if (std::abs(from) <= reach) {
        add(a);
      }
      if (std::abs(to) <= reach) {
        add(b);
      } else if (from * to < 0.0) {
        add(a + from / (from - to) * (b - a));
      }
    }
  }
  return result;
}

struct OpenSquare {
  double a;  ///< of its middle, in the frame
  double b;
  Eigen::Vector2d half;  ///< sides
  int divisions;
  std::array<double, 4> sizes;
};

/// Corners, then middles of the sides that begin at them, then the middle.
constexpr std::array<std::array<int, 2>, 9> places = {
    {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {0, -1}, {1, 0}, {0, 1}, {-1, 0}, {0, 0}}};

}  // namespace

std::vector<CutSquare> cut_by_plane(const Box& box, const Vec3& point, const Vec3& normal,
                                    int resolution, double tolerance, const SizesAt& sizes_at) {
  const auto differs = [tolerance](double size, double interpolated) {
    return std::abs(size - interpolated) > tolerance * std::abs(size);
  };
  const Frame frame = frame_of(point, normal);
  Eigen::AlignedBox2d cut;
  for (const Eigen::Vector2d& crossing : crossings(box, frame)) {
    cut.extend(crossing);
  }
  std::vector<CutSquare> result;
  if (cut.isEmpty() || cut.sizes().maxCoeff() <= 0.0) {
    return result;
  }
  // As square as may be.
  const double edge = cut.sizes().maxCoeff() / resolution;
  const Eigen::Array2i count = (cut.sizes() / edge).array().round().max(1.0).cast<int>();
  const Eigen::Vector2d half = 0.5 * (cut.sizes().array() / count.cast<double>()).matrix();
  // An oblique plane cuts less than a rectangle out of the box.
  const auto is_in_box = [&](const OpenSquare& square) {
    return box.exteriorDistance(frame.at(square.a, square.b)) <= square.half.norm();
  };
  std::vector<OpenSquare> open;
  std::vector<Vec3> points;
  std::vector<double> sizes;
  for (int j = 0; j < count[1]; ++j) {
    for (int i = 0; i < count[0]; ++i) {
      const OpenSquare square = {cut.min().x() + (2 * i + 1) * half.x(),
                                 cut.min().y() + (2 * j + 1) * half.y(),
                                 half,
                                 0,
                                 {}};
      if (is_in_box(square)) {
        open.push_back(square);
      }
    }
  }
  const auto ask = [&](const std::vector<OpenSquare>& squares, int first, int end) {
    points.clear();
    for (const OpenSquare& square : squares) {
      for (int k = first; k < end; ++k) {
        points.push_back(frame.at(square.a + places[k][0] * square.half.x(),
                                  square.b + places[k][1] * square.half.y()));
      }
    }
    sizes.resize(points.size());
    sizes_at(points, sizes.data());
  };
  ask(open, 0, 4);
  for (std::size_t i = 0; i < open.size(); ++i) {
    std::copy_n(sizes.begin() + 4 * i, 4, open[i].sizes.begin());
  }
  while (!open.empty()) {
    ask(open, 4, 9);
    std::vector<OpenSquare> next;
    for (std::size_t i = 0; i < open.size(); ++i) {
      const OpenSquare& square = open[i];
      const double* between = &sizes[5 * i];
      const auto& s = square.sizes;
      bool bends = differs(between[4], 0.25 * (s[0] + s[1] + s[2] + s[3]));
      for (int side = 0; side < 4; ++side) {
        bends = bends || differs(between[side], 0.5 * (s[side] + s[(side + 1) % 4]));
      }
      if (!bends || square.divisions == most_divisions) {
        CutSquare done;
        done.sizes = s;
        for (int k = 0; k < 4; ++k) {
          done.corners[k] = frame.at(square.a + places[k][0] * square.half.x(),
                                     square.b + places[k][1] * square.half.y());
        }
        if (std::all_of(s.begin(), s.end(), [](double size) { return std::isfinite(size); })) {
          result.push_back(done);
        }
        continue;
      }
      for (int k = 0; k < 4; ++k) {
        // Corner k of the square, the middles of its two sides there, and its own middle.
        OpenSquare quarter = {square.a + 0.5 * places[k][0] * square.half.x(),
                              square.b + 0.5 * places[k][1] * square.half.y(),
                              0.5 * square.half,
                              square.divisions + 1,
                              {}};
        quarter.sizes[k] = s[k];
        quarter.sizes[(k + 1) % 4] = between[k];
        quarter.sizes[(k + 2) % 4] = between[4];
        quarter.sizes[(k + 3) % 4] = between[(k + 3) % 4];
        if (is_in_box(quarter)) {
          next.push_back(quarter);
        }
      }
    }
    open = std::move(next);
  }
  return result;
}

}  // namespace meshgrow
