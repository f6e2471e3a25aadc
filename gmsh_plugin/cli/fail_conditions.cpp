#include "fail_conditions.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <sstream>

#include "c_results.h"
#include "entity.h"
#include "number_text.h"
#include "text_stream.h"
#include "usage_error.h"

namespace meshgrow::cli {

namespace {

constexpr std::size_t places_told = 10;

const std::vector<std::string>& keys() {
  static const std::vector<std::string> all = {
      "elements",  "smallest_size", "largest_size",      "ratio_max",
      "ratio_99",  "length_median", "length_share_good", "length_share_over_2",
      "gamma_min", "gamma_mean",    "sicn_min",          "sicn_mean"};
  return all;
}

bool holds(double value, const std::string& comparison, double bound) {
  if (comparison == ">") {
    return value > bound;
  }
  if (comparison == ">=") {
    return value >= bound;
  }
  return comparison == "<" ? value < bound : value <= bound;
}

std::string place_text(const nlohmann::json& place) {
  TextStream text;
  const nlohmann::json& elements = place.at("elements");
  text << (place.at("value").is_null() ? "-" : shortest(place.at("value").get<double>(), 4))
       << ": element" << (elements.size() > 1 ? "s " : " ");
  for (std::size_t i = 0; i < elements.size(); ++i) {
    text << (i == 0 ? "" : " and ") << elements[i];
  }
  text << " of "
       << entity_name({place.at("entity")[0].get<int>(), place.at("entity")[1].get<int>()})
       << " at (";
  for (int i = 0; i < 3; ++i) {
    text << (i == 0 ? "" : ", ") << shortest(place.at("point")[i].get<double>(), 5);
  }
  return text.str() + ")";
}

std::string why_unknown(const std::string& key, const nlohmann::json& report, bool has_field) {
  if (report.at("elements") == 0) {
    return "there are no elements";
  }
  if (key.rfind("length_", 0) == 0) {
    return has_field ? "no size is asked for where there are elements"
                     : "no size function is given that edges could be compared with";
  }
  if (key.rfind("ratio_", 0) == 0) {
    return "no two elements are neighbours";
  }
  return "there are no triangles or tetrahedra";
}

std::string report_number_names() {
  std::string text;
  for (const std::string& key : keys()) {
    text += (text.empty() ? "" : ", ") + (key == "ratio_99" ? "ratio_p99" : key);
  }
  return text;
}

}  // namespace

void add_fail_option(CLI::App& command, std::vector<std::string>& texts) {
  command
      .add_option("--fail-if", texts,
                  "A condition such as 'ratio_p99 > 1.4' that makes the mesh unacceptable: the "
                  "places that decide it are told, and the exit code is 1. Operators: > >= < <=; "
                  "numbers: " +
                      report_number_names() + ". May be given several times")
      ->allow_extra_args(false);
}

FailCondition parse_fail_condition(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  const std::size_t operation = text.find_first_of("<>");
  const UsageError wrong_form("'" + text +
                              "' is no condition: give a number of the report, one of > >= < <= "
                              "and a bound, such as 'ratio_p99 > 1.4'.");
  if (begin == std::string::npos || operation == std::string::npos || operation <= begin) {
    throw wrong_form;
  }
  FailCondition result;
  result.text = text;
  result.name = text.substr(begin, text.find_last_not_of(" \t", operation - 1) + 1 - begin);
  result.key = result.name == "ratio_p99" ? "ratio_99" : result.name;
  if (std::count(keys().begin(), keys().end(), result.key) == 0) {
    throw UsageError("A report has no number '" + result.name + "' as in '" + text +
                     "': give one of " + report_number_names() + ".");
  }
  std::size_t rest = operation + 1;
  result.comparison = text.substr(operation, 1);
  if (rest < text.size() && text[rest] == '=') {
    result.comparison += text[rest++];
  }
  std::istringstream bound(text.substr(rest));
  std::string more;
  if (!(bound >> result.bound) || bound >> more) {
    throw wrong_form;
  }
  return result;
}

std::vector<FailCondition> parse_fail_conditions(const std::vector<std::string>& texts) {
  std::vector<FailCondition> result;
  result.reserve(texts.size());
  for (const std::string& text : texts) {
    result.push_back(parse_fail_condition(text));
  }
  return result;
}

bool check_report(const std::vector<FailCondition>& conditions, const ReportedPart& part,
                  nlohmann::json& row) {
  nlohmann::json failed = nlohmann::json::array();
  const nlohmann::json& report = row.at("report");
  for (const FailCondition& condition : conditions) {
    const nlohmann::json& value = report.at(condition.key);
    const std::string start =
        "meshgrow: " + row.at("name").get<std::string>() + ": " + condition.name + " is ";
    if (!value.is_number()) {
      const std::string reason = why_unknown(condition.key, report, part.field != nullptr);
      std::cerr << start << "unknown, since " << reason << ", so that '" << condition.text
                << "' cannot be checked.\n";
      failed.push_back({{"condition", condition.text}, {"value", nullptr}, {"reason", reason}});
    } else if (holds(value.get<double>(), condition.comparison, condition.bound)) {
      const bool largest = condition.comparison[0] == '>';
      const nlohmann::json places = nlohmann::json::parse(take_text(meshgrow_report_worst_json(
          part.dim, part.dim_tags.data(), part.dim_tags.size(), part.field, condition.key.c_str(),
          largest ? 1 : 0, places_told)));
      std::cerr << start << value << ", so that '" << condition.text << "' holds.\n";
      for (const nlohmann::json& place : places) {
        std::cerr << "  " << place_text(place) << '\n';
      }
      failed.push_back({{"condition", condition.text}, {"value", value}, {"places", places}});
    }
  }
  const bool acceptable = failed.empty();
  if (!conditions.empty()) {
    row["failed"] = std::move(failed);
  }
  return acceptable;
}

}  // namespace meshgrow::cli
