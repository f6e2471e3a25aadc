#include "report_command.h"

#include <CLI/Validators.hpp>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "c_results.h"
#include "error.h"
#include "field_arguments.h"
#include "gmsh_session.h"
#include "model_file.h"
#include "model_reader.h"
#include "size_function_text.h"

namespace meshgrow::cli {

namespace {

struct ReportArguments {
  std::vector<std::string> meshes;
  int dim = 3;
  std::string entities;
  bool json = false;
  FieldArguments field;
};

void report(const ReportArguments& arguments) {
  const std::vector<std::string> texts = size_function_texts(arguments.field);
  const GmshSession session(2);
  nlohmann::json rows = nlohmann::json::array();
  for (const std::string& file : arguments.meshes) {
    open_model(file);
    const bool has_functions = !texts.empty() || arguments.field.defaults_limit != 0.0;
    const FieldPointer field = has_functions ? make_field(arguments.field, texts) : FieldPointer();
    std::vector<int> dim_tags;
    if (!arguments.entities.empty()) {
      for (const Entity& entity : parse_entities(arguments.entities, read_topology())) {
        dim_tags.push_back(entity.dim);
        dim_tags.push_back(entity.tag);
      }
    }
    const std::string measured = take_text(
        meshgrow_report_json(arguments.dim, dim_tags.data(), dim_tags.size(), field.get()));
    nlohmann::json values = nlohmann::json::parse(measured);
    if (values.at("elements") == 0) {
      throw Error(file + " has no elements of dimension " + std::to_string(arguments.dim) +
                  (arguments.entities.empty() ? "" : " on " + arguments.entities) +
                  ": mesh it first, or choose --dim.");
    }
    rows.push_back({{"name", file}, {"report", std::move(values)}});
  }
  if (arguments.json) {
    std::cout << rows.dump(2) << '\n';
  } else {
    std::cout << take_text(meshgrow_report_table(rows.dump().c_str()));
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
  add_field_options(command, arguments->field);
  command.callback([arguments] { report(*arguments); });
}

}  // namespace meshgrow::cli
