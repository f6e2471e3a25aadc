#include "worst_places.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "error.h"
#include "mesh_measures.h"

namespace meshgrow {

namespace {

/// A place, and where it stands in the order: the largest first.
struct Ranked {
  double rank;
  double value;
  std::vector<std::uint32_t> elements;
  Vec3 point;
};

Vec3 middle(const ReportMesh& mesh, std::uint32_t index) {
  const ReportElement& element = mesh.elements[index];
  const int corners = corner_count(element.shape);
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < corners; ++i) {
    sum += mesh.nodes[element.corners[i]];
  }
  return sum / corners;
}

std::vector<Ranked> neighbours(const ReportMesh& mesh) {
  std::vector<Ranked> result;
  for (const NeighbourPair& pair : neighbour_pairs(mesh, element_sizes(mesh))) {
    result.push_back({pair.size_ratio,
                      pair.size_ratio,
                      {pair.a, pair.b},
                      0.5 * (middle(mesh, pair.a) + middle(mesh, pair.b))});
  }
  return result;
}

std::vector<Ranked> sizes(const ReportMesh& mesh) {
  std::vector<Ranked> result;
  const std::vector<double> all = element_sizes(mesh);
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    result.push_back({all[i], all[i], {i}, middle(mesh, i)});
  }
  return result;
}

std::vector<Ranked> qualities(const ReportMesh& mesh, double ElementQuality::*measure) {
  std::vector<Ranked> result;
  for (const ElementQuality& quality : element_qualities(mesh)) {
    const double value = quality.*measure;
    result.push_back({value, value, {quality.element}, middle(mesh, quality.element)});
  }
  return result;
}

/// Ranked by length, or by how well the length fits.
std::vector<Ranked> edges(const ReportMesh& mesh, const SizeAsked& size_asked, bool by_fit) {
  std::vector<Ranked> result;
  if (size_asked) {
    for (const MeasuredEdge& edge : measured_edges(mesh, size_asked)) {
      const double length = edge.relative_length;
      result.push_back({by_fit ? -std::abs(std::log(length)) : length,
                        length,
                        {edge.element},
                        0.5 * (mesh.nodes[edge.a] + mesh.nodes[edge.b])});
    }
  }
  return result;
}

std::vector<Ranked> ranked_places(const ReportMesh& mesh, const SizeAsked& size_asked,
                                  const std::string& name) {
  if (name == "elements") {
    return {};
  }
  if (name == "ratio_max" || name == "ratio_99") {
    return neighbours(mesh);
  }
  if (name == "smallest_size" || name == "largest_size") {
    return sizes(mesh);
  }
  if (name == "gamma_min" || name == "gamma_mean") {
    return qualities(mesh, &ElementQuality::gamma);
  }
  if (name == "sicn_min" || name == "sicn_mean") {
    return qualities(mesh, &ElementQuality::sicn);
  }
  if (name == "length_median" || name == "length_share_over_2" || name == "length_share_good") {
    return edges(mesh, size_asked, name == "length_share_good");
  }
  throw Error("A report has no number \"" + name + "\": give one of its names in JSON.");
}

}  // namespace

std::vector<WorstPlace> worst_places(const ReportMesh& mesh, const SizeAsked& size_asked,
                                     const std::string& name, bool largest, std::size_t count) {
  std::vector<Ranked> ranked = ranked_places(mesh, size_asked, name);
  for (Ranked& place : ranked) {
    if (std::isnan(place.rank)) {  // between two elements without extent
      place.rank = std::numeric_limits<double>::infinity();
    }
  }
  const std::size_t shown = std::min(count, ranked.size());
  // Equal ones in the order of the mesh, so that the result is always the same.
  std::stable_sort(ranked.begin(), ranked.end(), [largest](const Ranked& a, const Ranked& b) {
    return largest ? a.rank > b.rank : a.rank < b.rank;
  });
  std::vector<WorstPlace> result;
  for (std::size_t i = 0; i < shown; ++i) {
    WorstPlace place;
    place.value = ranked[i].value;
    place.entity = mesh.elements[ranked[i].elements.front()].entity;
    place.point = ranked[i].point;
    for (const std::uint32_t element : ranked[i].elements) {
      place.elements.push_back(mesh.elements[element].tag);
    }
    result.push_back(place);
  }
  return result;
}

}  // namespace meshgrow
