#ifndef MESHGROW_CLI_FAIL_CONDITIONS_H
#define MESHGROW_CLI_FAIL_CONDITIONS_H

#include <CLI/App.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "meshgrow.h"

namespace meshgrow::cli {

/// What makes a mesh unacceptable, such as "ratio_p99 > 1.4".
struct FailCondition {
  std::string text;  ///< as given
  std::string name;  ///< of the number, as given
  std::string key;   ///< of the report in JSON
  std::string comparison;
  double bound = 0.0;
};

/// Throws UsageError that lists the names if one is unknown, or tells the form.
FailCondition parse_fail_condition(const std::string& text);
std::vector<FailCondition> parse_fail_conditions(const std::vector<std::string>& texts);

/// Gives the command the option --fail-if.
void add_fail_option(CLI::App& command, std::vector<std::string>& texts);

/// A part of the current model's mesh that a report is about.
struct ReportedPart {
  int dim = 3;
  std::vector<int> dim_tags;  ///< entities; all of the dimension if there are none
  meshgrow_field* field = nullptr;
};

/// Checks the report of this part, with its numbers in JSON. Adds to `row` under "failed" what
/// holds, with the places that decide it, and tells it on standard error under the mesh's name.
/// Returns whether the mesh is acceptable. A number that is not known makes it unacceptable.
bool check_report(const std::vector<FailCondition>& conditions, const ReportedPart& part,
                  nlohmann::json& row);

}  // namespace meshgrow::cli

#endif
