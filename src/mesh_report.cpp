#include "mesh_report.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "mesh_measures.h"
#include "number_text.h"
#include "text_table.h"

namespace meshgrow {

namespace {

/// Value at the fraction of the sorted values; reorders them.
double quantile(std::vector<double>& values, double fraction) {
  if (values.empty()) {
    return MeshReport::unknown;
  }
  const auto at = static_cast<std::size_t>(fraction * static_cast<double>(values.size() - 1) + 0.5);
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(at);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

/// Share of the values for which `counts` holds.
template <typename Condition>
double share(const std::vector<double>& values, Condition counts) {
  if (values.empty()) {
    return MeshReport::unknown;
  }
  const auto count = std::count_if(values.begin(), values.end(), counts);
  return static_cast<double>(count) / static_cast<double>(values.size());
}

void measure_ratios(const ReportMesh& mesh, const std::vector<double>& sizes, MeshReport& report) {
  std::vector<double> ratios;
  for (const NeighbourPair& pair : neighbour_pairs(mesh, sizes)) {
    ratios.push_back(pair.size_ratio);
  }
  if (!ratios.empty()) {
    report.ratio_99 = quantile(ratios, 0.99);
    report.ratio_max = *std::max_element(ratios.begin(), ratios.end());
  }
}

void measure_lengths(const ReportMesh& mesh, const SizeAsked& size_asked, MeshReport& report) {
  std::vector<double> lengths;
  for (const MeasuredEdge& edge : measured_edges(mesh, size_asked)) {
    lengths.push_back(edge.relative_length);
  }
  report.length_share_good = share(
      lengths, [](double length) { return length >= std::sqrt(0.5) && length <= std::sqrt(2.0); });
  report.length_share_over_2 = share(lengths, [](double length) { return length > 2.0; });
  report.length_median = quantile(lengths, 0.5);
}

void measure_quality(const ReportMesh& mesh, MeshReport& report) {
  const std::vector<ElementQuality> qualities = element_qualities(mesh);
  if (qualities.empty()) {
    return;
  }
  report.gamma_min = report.sicn_min = std::numeric_limits<double>::infinity();
  report.gamma_mean = report.sicn_mean = 0.0;
  for (const ElementQuality& quality : qualities) {
    report.gamma_min = std::min(report.gamma_min, quality.gamma);
    report.sicn_min = std::min(report.sicn_min, quality.sicn);
    report.gamma_mean += quality.gamma / static_cast<double>(qualities.size());
    report.sicn_mean += quality.sicn / static_cast<double>(qualities.size());
  }
}

std::string percent(double share_value) {
  return std::isnan(share_value) ? "-" : rounded(100.0 * share_value, 1) + " %";
}

std::string significant(double value) {
  if (std::isnan(value)) {
    return "-";
  }
  return shortest(value, 3);
}

}  // namespace

MeshReport make_report(const ReportMesh& mesh, const SizeAsked& size_asked) {
  MeshReport report;
  report.elements = mesh.elements.size();
  if (mesh.elements.empty()) {
    return report;
  }
  const std::vector<double> sizes = element_sizes(mesh);
  report.smallest_size = *std::min_element(sizes.begin(), sizes.end());
  report.largest_size = *std::max_element(sizes.begin(), sizes.end());
  measure_ratios(mesh, sizes, report);
  if (size_asked) {
    measure_lengths(mesh, size_asked, report);
  }
  measure_quality(mesh, report);
  return report;
}

std::string report_table(const std::vector<NamedReport>& reports) {
  std::vector<std::vector<std::string>> rows = {{"mesh", "elements", "size min", "max", "ratio max",
                                                 "99 %", "length/size", "good", "> 2", "gamma min",
                                                 "mean", "SICN min", "mean"}};
  for (const auto& [name, r] : reports) {
    rows.push_back({name, grouped_digits(r.elements), significant(r.smallest_size),
                    significant(r.largest_size), rounded(r.ratio_max, 2), rounded(r.ratio_99, 2),
                    rounded(r.length_median, 2), percent(r.length_share_good),
                    percent(r.length_share_over_2), rounded(r.gamma_min, 3),
                    rounded(r.gamma_mean, 3), rounded(r.sicn_min, 3), rounded(r.sicn_mean, 3)});
  }
  return text_table(rows);
}

}  // namespace meshgrow
