#include "report_command.h"

#include <CLI/Validators.hpp>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "c_results.h"
#include "fail_conditions.h"
#include "field_arguments.h"
#include "gmsh_session.h"
#include "json_text.h"
#include "model_file.h"
#include "model_reader.h"
#include "size_function_text.h"
#include "usage_error.h"

namespace meshgrow::cli {

namespace {

struct ReportArguments {
  std::vector<std::string> meshes;
  int dim = 3;
  std::string entities;
  bool json = false;
  std::vector<std::string> fail_if;
  std::string sizes;  ///< a saved field, instead of size functions
  FieldArguments field;
};

std::vector<int> dim_tags(const std::string& entities) {
  std::vector<int> result;
  try {
    for (const Entity& entity : parse_entities(entities, read_topology())) {
      result.push_back(entity.dim);
      result.push_back(entity.tag);
    }
  } catch (const Error& error) {
    throw UsageError(error.what());
  }
  return result;
}

/// What edge lengths are compared with; null if there is nothing.
FieldPointer sizes_asked_for(const ReportArguments& arguments,
                             const std::vector<std::string>& texts) {
  FieldPointer field;
  if (!arguments.sizes.empty()) {
    check_no_field_options(arguments.sizes, arguments.field);
    field.reset(meshgrow_field_load(arguments.sizes.c_str()));
    check(field ? 0 : 1);
  } else if (has_size_functions(arguments.field, texts)) {
    field = make_field(arguments.field, texts);
  }
  return field;
}

/// The report of one file, as a row of the table; `acceptable` becomes false if a condition holds.
nlohmann::json report_row(const std::string& file, const ReportArguments& arguments,
                          const std::vector<std::string>& texts,
                          const std::vector<FailCondition>& conditions, bool& acceptable) {
  open_model(file);
  const FieldPointer field = sizes_asked_for(arguments, texts);
  ReportedPart part{arguments.dim, {}, field.get()};
  if (!arguments.entities.empty()) {
    part.dim_tags = dim_tags(arguments.entities);
  }
  nlohmann::json row = {
      {"name", file},
      {"report", nlohmann::json::parse(take_text(meshgrow_report_json(
                     part.dim, part.dim_tags.data(), part.dim_tags.size(), part.field)))}};
  if (row.at("report").at("elements") == 0) {
    throw UsageError(file + " has no elements of dimension " + std::to_string(arguments.dim) +
                     (arguments.entities.empty() ? "" : " on " + arguments.entities) +
                     ": mesh it first, or choose --dim.");
  }
  acceptable = check_report(conditions, part, row) && acceptable;
  return row;
}

void report(const ReportArguments& arguments) {
  const std::vector<std::string> texts = size_function_texts(arguments.field);
  const std::vector<FailCondition> conditions = parse_fail_conditions(arguments.fail_if);
  const GmshSession session;
  nlohmann::json rows = nlohmann::json::array();
  bool acceptable = true;
  for (const std::string& file : arguments.meshes) {
    rows.push_back(report_row(file, arguments, texts, conditions, acceptable));
  }
  if (arguments.json) {
    std::cout << json_text(rows, 2) << '\n';
  } else {
    std::cout << take_text(meshgrow_report_table(json_text(rows).c_str()));
  }
  if (!acceptable) {
    throw CLI::RuntimeError(ExitCode::work_failed);
  }
}

}  // namespace

void add_report_command(CLI::App& program) {
  const auto arguments = std::make_shared<ReportArguments>();
  CLI::App& command =
      *program.add_subcommand("report", "Gradation and quality of meshes, as a table");
  command.add_option("meshes", arguments->meshes, "Mesh files")->required();
  command.add_option("--dim", arguments->dim, "2 or 3")
      ->capture_default_str()
      ->check(CLI::Range(2, 3));
  command.add_option("--entities", arguments->entities, "Only these, for example 'Volume{2,3}'");
  command.add_flag("--json", arguments->json, "JSON instead of a table");
  command.add_option("--sizes", arguments->sizes,
                     "Against the sizes of a saved field (.mgf), instead of size functions");
  add_fail_option(command, arguments->fail_if);
  add_field_options(command, arguments->field);
  command.footer(std::string("Example:\n"
                             "  meshgrow report before.msh after.msh --entities 'Volume{2}' "
                             "--fail-if 'gamma_min < 0.1'\n") +
                 exit_codes_help);
  command.callback([arguments] { report(*arguments); });
}

}  // namespace meshgrow::cli
