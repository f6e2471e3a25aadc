#include "field_arguments.h"

#include <CLI/Validators.hpp>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>

#include "background_grid.h"
#include "onelab_functions.h"
#include "size_function.h"
#include "usage_error.h"

namespace meshgrow::cli {

namespace {

void check_usage(int failed, const std::string& where = "") {
  if (failed != 0) {
    throw UsageError(where + meshgrow_last_error());
  }
}

/// What is wrong with it, if anything: for runs, too, that build no field.
template <typename Check>
std::string what_is_wrong(const std::string& text, Check check) {
  try {
    check(std::strtod(text.c_str(), nullptr));
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

std::string wrong_tolerance(const std::string& text) {
  return what_is_wrong(text, check_tolerance);
}

std::string wrong_max_cells(const std::string& text) {
  return what_is_wrong(text, check_max_cells);
}

}  // namespace

void add_field_options(CLI::App& command, FieldArguments& arguments) {
  command
      .add_option("--size-function", arguments.size_functions,
                  "A size function, one line of text such as 'mesh source Surface{7} attach "
                  "Volume{2} growth 1.2 limit 2'; may be given several times")
      ->allow_extra_args(false);
  command.add_option("--size-functions", arguments.file,
                     "A file of size functions, one a line; # begins a comment");
  command
      .add_option("--defaults", arguments.defaults_limit,
                  "Curvature (18 degrees) and proximity (3 cells per gap) of everything, "
                  "growth 1.2, up to this size")
      ->check(CLI::PositiveNumber);
  command
      .add_option("--tolerance", arguments.tolerance, "Relative tolerance of the background grid")
      ->check(wrong_tolerance)
      ->capture_default_str();
  command
      .add_option("--max-cells", arguments.max_cells,
                  "Most cells of a background grid; 0: as many as half of the memory holds")
      ->check(wrong_max_cells);
  command
      .add_option("--evaluator", arguments.evaluator,
                  "Who answers sizes: exact (a tree of facets), grid (a background grid) or "
                  "auto (a grid where it pays)")
      ->check(CLI::IsMember({"auto", "grid", "exact"}))
      ->capture_default_str();
  command.add_flag("--strict", arguments.strict,
                   "A source without a mesh is an error, not a warning");
  command.add_flag("--calibrate", arguments.calibrate,
                   "Correct sizes by measured factors: Gmsh's edges get the length asked for");
}

namespace {

/// Of a file of size functions; more is a wrong file, and might fill the memory.
constexpr std::size_t most_bytes = 64 << 20;

std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text;
  std::array<char, 1 << 16> part;
  while (file && text.size() <= most_bytes) {
    file.read(part.data(), part.size());
    text.append(part.data(), static_cast<std::size_t>(file.gcount()));
  }
  if (text.size() > most_bytes) {
    throw UsageError(path + " has more than 64 MB: give a file of size functions, one a line.");
  }
  if (!file.eof()) {
    throw UsageError("Cannot read " + path + " (" + std::strerror(errno) +
                     "): give a file of size functions, one a line.");
  }
  return text;
}

}  // namespace

std::vector<std::string> size_function_texts(const FieldArguments& arguments) {
  std::vector<std::string> result = arguments.size_functions;
  if (!arguments.file.empty()) {
    std::istringstream lines(text_of(arguments.file));
    for (std::string line; std::getline(lines, line);) {
      const std::size_t first = line.find_first_not_of(" \t\r");
      if (first != std::string::npos && line[first] != '#') {
        result.push_back(line.substr(first, line.find_last_not_of(" \t\r") + 1 - first));
      }
    }
  }
  return result;
}

void check_no_field_options(const std::string& path, const FieldArguments& arguments) {
  const FieldArguments standard;
  if (!arguments.size_functions.empty() || !arguments.file.empty() ||
      arguments.defaults_limit != 0.0 || arguments.tolerance != standard.tolerance ||
      arguments.max_cells != standard.max_cells || arguments.evaluator != standard.evaluator ||
      arguments.strict || arguments.calibrate) {
    throw UsageError(path +
                     " is a saved size field with functions and options of its own: leave out "
                     "--size-function, --defaults, --tolerance, --evaluator and the like.");
  }
}

bool has_size_functions(const FieldArguments& arguments, const std::vector<std::string>& texts) {
  return !texts.empty() || arguments.defaults_limit != 0.0 || !onelab_functions().empty();
}

FieldPointer make_field(const FieldArguments& arguments, const std::vector<std::string>& texts) {
  FieldPointer field(meshgrow_field_create());
  check(field ? 0 : 1);
  check_usage(meshgrow_field_set_option(field.get(), "tolerance", arguments.tolerance));
  check_usage(meshgrow_field_set_option(field.get(), "max_cells", arguments.max_cells));
  const double evaluator = arguments.evaluator == "exact"  ? 2.0
                           : arguments.evaluator == "grid" ? 1.0
                                                           : 0.0;
  check_usage(meshgrow_field_set_option(field.get(), "evaluator", evaluator));
  check_usage(meshgrow_field_set_option(field.get(), "strict", arguments.strict ? 1.0 : 0.0));
  check_usage(meshgrow_field_set_option(field.get(), "calibrate", arguments.calibrate ? 1.0 : 0.0));
  for (const OnelabFunction& function : onelab_functions()) {
    const std::string where = "Size functions/" + function.name + ": ";
    check_usage(meshgrow_field_add(field.get(), function.text.c_str()), where);
    const std::string given = take_text(
        meshgrow_field_function_name(field.get(), meshgrow_field_function_count(field.get()) - 1));
    if (is_number_name(given) && !is_number_name(function.name)) {  // the text gives it no name
      check_usage(meshgrow_field_rename(field.get(), given.c_str(), function.name.c_str()), where);
    }
  }
  for (const std::string& text : texts) {
    check_usage(meshgrow_field_add(field.get(), text.c_str()));
  }
  if (arguments.defaults_limit != 0.0) {
    constexpr double growth_rate = 1.2;
    check_usage(meshgrow_field_create_defaults(field.get(), nullptr, 0, growth_rate,
                                               arguments.defaults_limit, 0.0));
  }
  return field;
}

}  // namespace meshgrow::cli
