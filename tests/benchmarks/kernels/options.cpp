#include "options.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "error.h"
#include "inputs.h"

namespace meshgrow::kernels {

namespace {

std::vector<std::string> split_at_commas(const std::string& text) {
  std::vector<std::string> parts;
  std::stringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) {
    parts.push_back(part);
  }
  return parts;
}

int positive(const std::string& option, const std::string& value) {
  const int number = std::atoi(value.c_str());
  if (number < 1) {
    throw Error(option + " needs a whole number of 1 or more, not '" + value + "'.");
  }
  return number;
}

}  // namespace

bool Options::wants(const std::string& name) const {
  return only.empty() || std::any_of(only.begin(), only.end(), [&](const std::string& prefix) {
           return name.compare(0, prefix.size(), prefix) == 0;
         });
}

bool Options::wants_any(std::initializer_list<const char*> names) const {
  return std::any_of(names.begin(), names.end(), [&](const char* name) { return wants(name); });
}

Options parse_options(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  Options options;
  options.quick = std::find(arguments.begin(), arguments.end(), "--quick") != arguments.end();
  options.inputs = input_names(options.quick);
  options.repetitions = options.quick ? 3 : 5;
  options.query_count = options.quick ? 5000 : 50000;
  options.eval_count = options.quick ? 50000 : 500000;
  options.sample_count = options.quick ? 100000 : 1000000;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& option = arguments[i];
    if (option == "--quick") {
      continue;
    }
    if (i + 1 == arguments.size()) {
      throw Error("'" + option + "' is no option, or its value is missing.");
    }
    const std::string& value = arguments[++i];
    if (option == "--only") {
      options.only.push_back(value);
    } else if (option == "--inputs") {
      options.inputs = split_at_commas(value);
    } else if (option == "--repetitions") {
      options.repetitions = positive(option, value);
    } else if (option == "--json") {
      options.json = value;
    } else if (option == "--peak-of") {
      options.peak_of = value;
    } else {
      throw Error("'" + option + "' is no option.");
    }
  }
  return options;
}

std::string usage() {
  return "usage: kernel_benchmarks [--quick] [--only PREFIX]... [--inputs NAME,NAME] "
         "[--repetitions 5] [--json FILE]\n";
}

}  // namespace meshgrow::kernels
