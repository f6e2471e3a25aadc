#ifndef MESHGROW_CLI_COMMANDS_H
#define MESHGROW_CLI_COMMANDS_H

#include <string>
#include <vector>

namespace meshgrow::cli {

struct FieldArguments {
  std::vector<std::string> size_functions;
  std::string file;
  double defaults_limit = 0.0;  ///< size limit of the default functions; 0: none of them
  double tolerance = 0.05;
  std::string evaluator = "auto";
  bool strict = false;
  bool calibrate = false;
};

struct MeshArguments {
  std::string model;
  std::string output;
  bool dim_1 = false;
  bool dim_2 = false;
  bool dim_3 = false;
  bool plan = false;
  bool remesh = false;
  int verbosity = 2;
};

struct ReportArguments {
  std::vector<std::string> meshes;
  int dim = 3;
  std::string entities;
  bool json = false;
};

/// `meshgrow mesh`, or with `plan` only what it would do. Throws Error; the output file is replaced
/// only when the new mesh is complete.
void mesh(const MeshArguments& arguments, const FieldArguments& field_arguments);

/// `meshgrow report`. Throws Error.
void report(const ReportArguments& arguments, const FieldArguments& field_arguments);

}  // namespace meshgrow::cli

#endif
