#include "probe_command.h"

#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "entity_text.h"
#include "json_text.h"
#include "opened_field.h"
#include "probe_json.h"
#include "usage_error.h"

namespace meshgrow::cli {

namespace {

struct ProbeArguments {
  std::string file;
  std::vector<std::string> points;  ///< "x,y,z" each
  std::string entity;               ///< "3,2"; empty: one of the group with the smallest size
  bool dim_1 = false;
  bool dim_2 = false;
  bool dim_3 = false;
  bool json = false;
  FieldArguments field;
};

void probe(const ProbeArguments& arguments) {
  std::vector<Vec3> points;
  for (const std::string& text : arguments.points) {
    points.push_back(read_point(text));
  }
  const int mesh_dim = arguments.dim_3 ? 3 : arguments.dim_2 ? 2 : arguments.dim_1 ? 1 : 0;
  const OpenedField opened(arguments.file, arguments.field, mesh_dim);
  const SizeField& field = opened.field();
  nlohmann::json probes = nlohmann::json::array();
  for (const Vec3& p : points) {
    const Probe found = arguments.entity.empty()
                            ? field.probe(p)
                            : field.probe(read_entity(arguments.entity, field.topology()), p);
    if (found.rule == Rule::nothing && arguments.entity.empty()) {
      throw UsageError(
          "No size function has an effect at this point: mesh the sources first, with -1, "
          "-2 or -3, or name another --entity.");
    }
    probes.push_back(probe_json(field, found, p, opened.has_model()));
  }
  if (arguments.json) {
    std::cout << json_text(probes, 2) << '\n';
  } else {
    for (const nlohmann::json& one : probes) {
      std::cout << probe_text(one);
    }
  }
}

}  // namespace

void add_probe_command(CLI::App& program) {
  const auto arguments = std::make_shared<ProbeArguments>();
  CLI::App& command = *program.add_subcommand("probe", "Tell what decides the size at a point");
  command.add_option("model", arguments->file, "A model, a mesh or a saved field (.mgf)")
      ->required();
  command
      .add_option("--at", arguments->points,
                  "Where, for example 0.5,1,-2; may be given several times")
      ->required()
      ->allow_extra_args(false);
  command.add_option("--entity", arguments->entity,
                     "On this entity, for example 3,2 (default: where the size is smallest)");
  command.add_flag("-1", arguments->dim_1, "Mesh curves first");
  command.add_flag("-2", arguments->dim_2, "Mesh curves and surfaces first");
  command.add_flag("-3", arguments->dim_3, "Mesh all first");
  command.add_flag("--json", arguments->json, "JSON instead of words");
  add_field_options(command, arguments->field);
  command.footer(std::string("Example:\n"
                             "  meshgrow probe model.geo -2 --at 0.5,1,0 --entity 3,2 "
                             "--size-functions sizes.txt\n") +
                 exit_codes_help);
  command.callback([arguments] { probe(*arguments); });
}

}  // namespace meshgrow::cli
