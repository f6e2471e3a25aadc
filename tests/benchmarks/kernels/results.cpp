#include "results.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "bars.h"
#include "error.h"

namespace meshgrow::kernels {

namespace {

std::string joined(const Path& path) {
  std::string text;
  for (std::size_t i = 1; i < path.size(); ++i) {
    text += (i > 1 ? "/" : "") + path[i];
  }
  return text;
}

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

nlohmann::json read_object(const std::string& file) {
  std::ifstream stream(file);
  if (!stream) {
    return nlohmann::json::object();
  }
  nlohmann::json object = nlohmann::json::parse(stream, nullptr, false);
  if (!object.is_object()) {
    throw Error("'" + file + "' holds no JSON object: give another file.");
  }
  return object;
}

}  // namespace

Spread spread_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  const double median =
      values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
  return {median, values.front(), values.back()};
}

void Results::add(const Path& path, double value) {
  const auto known = std::find_if(series_.begin(), series_.end(),
                                  [&](const Series& series) { return series.path == path; });
  if (known != series_.end()) {
    known->values.push_back(value);
  } else {
    series_.push_back({path, {value}});
  }
}

std::vector<double> Results::values(const Path& path) const {
  const auto known = std::find_if(series_.begin(), series_.end(),
                                  [&](const Series& series) { return series.path == path; });
  return known == series_.end() ? std::vector<double>() : known->values;
}

void Results::print() const {
  std::vector<Series> sorted = series_;
  std::stable_sort(sorted.begin(), sorted.end(), [](const Series& a, const Series& b) {
    return a.path.front() < b.path.front();
  });
  std::printf("%-30s %-28s %10s  %-21s %8s\n", "number", "input", "median", "low - high", "bar");
  for (const Series& series : sorted) {
    const Spread spread = spread_of(series.values);
    const std::optional<Bar> bar = bar_of(series.path);
    const std::string range = short_number(spread.low) + " - " + short_number(spread.high);
    std::printf("%-30s %-28s %10s  %-21s", series.path.front().c_str(), joined(series.path).c_str(),
                short_number(spread.median).c_str(), range.c_str());
    if (bar) {
      const std::string limit = (bar->at_least ? ">= " : "<= ") + short_number(bar->value);
      std::printf(" %8s  %s", limit.c_str(), bar->met_by(spread.median) ? "met" : "below");
    }
    std::printf("\n");
  }
  std::fflush(stdout);
}

void Results::merge_into(const std::string& json_file) const {
  nlohmann::json merged = read_object(json_file);
  for (const Series& series : series_) {
    const Spread spread = spread_of(series.values);
    nlohmann::json* place = &merged;
    for (const std::string& key : series.path) {
      place = &(*place)[key];
    }
    *place = {{"median", spread.median}, {"low", spread.low}, {"high", spread.high}};
  }
  std::ofstream stream(json_file);
  stream << merged.dump(2) << "\n";
  if (!stream.flush()) {
    throw Error("'" + json_file + "' cannot be written.");
  }
}

}  // namespace meshgrow::kernels
