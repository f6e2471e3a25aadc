#ifndef MESHGROW_CLI_FIELD_ARGUMENTS_H
#define MESHGROW_CLI_FIELD_ARGUMENTS_H

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "c_results.h"

namespace meshgrow::cli {

/// What a command is told about the size field.
struct FieldArguments {
  std::vector<std::string> size_functions;
  std::string file;
  double defaults_limit = 0.0;  ///< size limit of the default functions; 0: none of them
  double tolerance = 0.05;
  double max_cells = 0.0;  ///< of a background grid; 0: as half of the memory holds
  std::string evaluator = "auto";
  bool strict = false;
  bool calibrate = false;
};

/// Gives the command options that fill `arguments`, which must outlive the parsing.
void add_field_options(CLI::App& command, FieldArguments& arguments);

/// The size functions of the arguments by their one-line texts, those of the file last. Throws
/// UsageError if the file cannot be read.
std::vector<std::string> size_function_texts(const FieldArguments& arguments);

/// For a saved field (.mgf): throws UsageError if the arguments tell anything that only a field of
/// a model can heed.
void check_no_field_options(const std::string& path, const FieldArguments& arguments);

/// Whether there is any size function, be it in the current model, among the texts or by default.
bool has_size_functions(const FieldArguments& arguments, const std::vector<std::string>& texts);

/// The size field of the current model with the functions that the model itself defines
/// (onelab_functions.h) and these. Throws UsageError if one of them is unusable.
FieldPointer make_field(const FieldArguments& arguments, const std::vector<std::string>& texts);

}  // namespace meshgrow::cli

#endif
