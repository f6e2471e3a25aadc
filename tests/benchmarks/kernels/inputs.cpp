#include "inputs.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>

#include "error.h"
#include "faceted_source.h"
#include "graded_sphere.h"
#include "growth_law.h"
#include "start_sizes/mesh_start_sizes.h"

namespace meshgrow::kernels {

namespace {

constexpr double grading = 20.0;
const double pi = std::acos(-1.0);

FacetedSource sphere(std::size_t facet_count) {
  FacetedSource source;
  source.triangles = test::graded_sphere(facet_count, grading);
  return source;
}

/// Two walls with a narrow gap, fine against coarse everywhere: the nearest facet is often not the
/// one that rules.
FacetedSource two_spheres(std::size_t facet_count) {
  FacetedSource source = sphere(facet_count / 2);
  const std::size_t outer_count = source.triangles.size();
  const Vec3 mirrored(0.9, 0.9, -0.9);
  for (std::size_t i = 0; i < outer_count; ++i) {
    const auto [a, b, c] = source.triangles[i];
    source.triangles.push_back(
        {a.cwiseProduct(mirrored), c.cwiseProduct(mirrored), b.cwiseProduct(mirrored)});
  }
  return source;
}

void add_quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, FacetedSource& source) {
  source.triangles.push_back({a, b, c});
  source.triangles.push_back({a, c, d});
}

/// A plate of square tiles of edge 1, each with a round hole of another radius in its centre.
class PlateWithHoles {
 public:
  /// Elements around each hole: a multiple of four, so that nodes meet the tiles' corners.
  explicit PlateWithHoles(int elements_around) : elements_around_(elements_around) {
    int hole = 0;
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column) {
        // 12 radii from 0.03 to 0.35, small and large ones next to each other.
        const int step = hole++ * 5 % (rows * columns);
        add_tile(Vec3(column + 0.5, row + 0.5, 0.0), 0.03 * std::pow(0.35 / 0.03, step / 11.0));
      }
    }
  }

  FacetedSource source;

 private:
  static constexpr int columns = 4;
  static constexpr int rows = 3;
  static constexpr double thickness = 0.05;

  /// The O-grid's rings grow by their own number of elements around: its elements are about square
  /// everywhere, the smallest ones at the hole.
  void add_tile(const Vec3& centre, double radius) {
    const int layers = std::max(
        1, static_cast<int>(std::lround(std::log(0.5 / radius) * elements_around_ / (2.0 * pi))));
    std::vector<std::vector<Vec3>> rings;
    for (int layer = 0; layer <= layers; ++layer) {
      rings.push_back(ring(centre, radius, static_cast<double>(layer) / layers));
    }
    for (int layer = 0; layer < layers; ++layer) {
      for (int i = 0; i < elements_around_; ++i) {
        add_both_sides(rings[layer][i], rings[layer][i + 1], rings[layer + 1][i + 1],
                       rings[layer + 1][i]);
      }
    }
    for (int i = 0; i < elements_around_; ++i) {
      add_wall(rings.front()[i], rings.front()[i + 1]);
      if (on_border(rings.back()[i], rings.back()[i + 1])) {
        add_wall(rings.back()[i], rings.back()[i + 1]);
      }
    }
  }

  /// From the hole (progress 0) to the tile's border (1), spaced geometrically.
  std::vector<Vec3> ring(const Vec3& centre, double radius, double progress) const {
    std::vector<Vec3> nodes;
    for (int i = 0; i < elements_around_; ++i) {
      const double angle = 0.25 * pi + 2.0 * pi * i / elements_around_;
      const Vec3 direction(std::cos(angle), std::sin(angle), 0.0);
      const double border = 0.5 / direction.cwiseAbs().maxCoeff();
      nodes.push_back(centre + radius * std::pow(border / radius, progress) * direction);
    }
    nodes.push_back(nodes.front());
    return nodes;
  }

  void add_both_sides(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const Vec3 up(0.0, 0.0, thickness);
    add_quad(a, b, c, d, source);
    add_quad(d + up, c + up, b + up, a + up, source);
  }

  void add_wall(const Vec3& a, const Vec3& b) {
    const int layers = std::max(1, static_cast<int>(std::lround(thickness / (b - a).norm())));
    for (int layer = 0; layer < layers; ++layer) {
      const Vec3 low(0.0, 0.0, thickness * layer / layers);
      const Vec3 high(0.0, 0.0, thickness * (layer + 1) / layers);
      add_quad(a + low, b + low, b + high, a + high, source);
    }
  }

  static bool on_border(const Vec3& a, const Vec3& b) {
    const auto both_at = [&](int axis, double value) {
      return std::abs(a[axis] - value) < 1e-9 && std::abs(b[axis] - value) < 1e-9;
    };
    return both_at(0, 0.0) || both_at(0, columns) || both_at(1, 0.0) || both_at(1, rows);
  }

  int elements_around_;
};

/// A wireframe globe: meridians whose nodes are bunched towards one pole, and parallels through
/// some of those nodes with segments as long as the meridians' there. As many of the ones as of the
/// others.
FacetedSource wireframe_globe(std::size_t wires, double smallest) {
  const auto at = [](double theta, double phi) {
    return Vec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
  };
  const auto length_at = [&](double theta) { return smallest * std::pow(grading, theta / pi); };
  std::vector<double> thetas{0.0};
  while (thetas.back() + 1.5 * length_at(thetas.back()) < pi) {
    thetas.push_back(thetas.back() + length_at(thetas.back()));
  }
  thetas.push_back(pi);
  FacetedSource source;
  for (std::size_t meridian = 0; meridian < wires; ++meridian) {
    const double phi = 2.0 * pi * static_cast<double>(meridian) / static_cast<double>(wires);
    for (std::size_t i = 1; i < thetas.size(); ++i) {
      source.segments.push_back({at(thetas[i - 1], phi), at(thetas[i], phi)});
    }
  }
  for (std::size_t parallel = 1; parallel <= wires; ++parallel) {
    const double theta = thetas[parallel * (thetas.size() - 1) / (wires + 1)];
    const int count = std::max(6, static_cast<int>(2.0 * pi * std::sin(theta) / length_at(theta)));
    for (int i = 0; i < count; ++i) {
      source.segments.push_back(
          {at(theta, 2.0 * pi * i / count), at(theta, 2.0 * pi * (i + 1) / count)});
    }
  }
  return source;
}

FacetedSource plate(std::size_t facet_count) {
  int elements_around = 12;
  FacetedSource best = PlateWithHoles(elements_around).source;
  for (;;) {
    elements_around += 4;
    FacetedSource next = PlateWithHoles(elements_around).source;
    if (next.triangles.size() > facet_count) {
      return best;
    }
    best = std::move(next);
  }
}

FacetedSource curves(std::size_t facet_count) {
  const auto wires = static_cast<std::size_t>(
      std::max(8.0, 64.0 * std::sqrt(static_cast<double>(facet_count) / 1e5)));
  double low = 1e-6;
  double high = 0.2;
  for (int i = 0; i < 40; ++i) {
    const double middle = std::sqrt(low * high);
    // Shorter ones would fill the memory before they are found to be too many.
    const bool far_too_many =
        static_cast<double>(wires) / middle > 20.0 * static_cast<double>(facet_count);
    const bool too_many =
        far_too_many || wireframe_globe(wires, middle).segments.size() > facet_count;
    (too_many ? low : high) = middle;
  }
  return wireframe_globe(wires, high);
}

using Maker = std::function<FacetedSource(std::size_t)>;

FacetedSource make_source(const std::string& name) {
  static const std::map<std::string, Maker> makers = {
      {"sphere", sphere}, {"plate", plate}, {"two_spheres", two_spheres}, {"curves", curves}};
  const std::size_t underscore = name.rfind('_');
  const auto maker = makers.find(name.substr(0, underscore));
  const double count =
      underscore == std::string::npos ? 0.0 : std::atof(name.c_str() + underscore + 1);
  if (maker == makers.end() || !(count >= 1000.0 && count <= 1e8)) {
    throw Error("There is no input '" + name +
                "': give one of sphere, plate, two_spheres and curves with a number of facets from "
                "1e3 to 1e8, for example sphere_2e5.");
  }
  return maker->second(static_cast<std::size_t>(count));
}

}  // namespace

std::vector<std::string> input_names(bool quick) {
  if (quick) {
    return {"sphere_5e3", "plate_5e3", "two_spheres_5e3", "curves_5e3"};
  }
  return {"sphere_2e4", "sphere_2e5", "plate_1e5", "two_spheres_2e5",
          "curves_1e5", "sphere_1e6", "sphere_1e7"};
}

Input make_input(const std::string& name) {
  Input input;
  input.name = name;
  {
    const FacetedSource source = make_source(name);
    input.facets.reserve(source.triangles.size() + source.segments.size());
    append_mesh_start_sizes(source, QuadSize::triangles, growth_slope(growth_rate), input.facets);
  }
  for (const SizedFacet& facet : input.facets) {
    input.box.extend(facet.facet.box());
  }
  const Vec3 half = 0.75 * input.box.sizes();
  input.query_box = Box(input.box.center() - half, input.box.center() + half);
  return input;
}

}  // namespace meshgrow::kernels
