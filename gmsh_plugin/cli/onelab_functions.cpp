#include "onelab_functions.h"

#include <cstring>

#include "gmsh_api.h"

namespace meshgrow::cli {

namespace {

constexpr const char* prefix = "Size functions/";

bool is_empty(const std::string& text) {
  return text.find_first_not_of(" \t") == std::string::npos;
}

std::vector<std::string> parameter_names() { return gmsh::onelab_names(std::string("^") + prefix); }

}  // namespace

std::vector<OnelabFunction> onelab_functions() {
  std::vector<OnelabFunction> result;
  for (const std::string& parameter : parameter_names()) {
    const std::string text = gmsh::onelab_string(parameter);
    if (!is_empty(text)) {
      result.push_back({parameter.substr(std::strlen(prefix)), text});
    }
  }
  return result;
}

void warn_of_unusable_onelab_functions() {
  for (const std::string& parameter : parameter_names()) {
    if (is_empty(gmsh::onelab_string(parameter))) {
      gmsh::log(parameter + (gmsh::is_onelab_number(parameter) ? " is a number" : " is empty") +
                    " and makes no size function: give it the text of one, or remove it.",
                "warning");
    }
  }
}

void forget_onelab_functions() {
  for (const std::string& parameter : parameter_names()) {
    gmsh::remove_onelab(parameter);
  }
}

}  // namespace meshgrow::cli
