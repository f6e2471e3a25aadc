#include "onelab_functions.h"

#include <cstring>

#include "gmsh_api.h"

namespace meshgrow::cli {

namespace {

constexpr const char* prefix = "Size functions/";

std::vector<std::string> parameter_names() { return gmsh::onelab_names(std::string("^") + prefix); }

}  // namespace

std::vector<OnelabFunction> onelab_functions() {
  std::vector<OnelabFunction> result;
  for (const std::string& parameter : parameter_names()) {
    const std::string text = gmsh::onelab_string(parameter);
    if (text.find_first_not_of(" \t") != std::string::npos) {
      result.push_back({parameter.substr(std::strlen(prefix)), text});
    }
  }
  return result;
}

void forget_onelab_functions() {
  for (const std::string& parameter : parameter_names()) {
    gmsh::remove_onelab(parameter);
  }
}

}  // namespace meshgrow::cli
