// Gmsh itself: its session, files, options, parameters, models and log.

#include "gmsh_api.h"

#include <cstdio>

#include "changed_option.h"
#include "gmsh_memory.h"

namespace meshgrow::gmsh {

Version require_gmsh() {
  // Resolved first, so that a missing library is told as such.
  GmshLibrary& gmsh = library();
  std::string told;
  try {
    told = version_text();
  } catch (const Error&) {
    told.clear();
  }
  if (told.empty()) {  // depending on how it was built, Gmsh fails or says nothing
    throw Error("Gmsh is not initialized: call gmsh.initialize() first.");
  }
  Version version;
  if (std::sscanf(told.c_str(), "%d.%d", &version.major, &version.minor) != 2) {
    throw Error("The libgmsh in use (" + gmsh.path() +
                ") tells no version: install Gmsh 4.8 or "
                "later.");
  }
  if (std::make_pair(version.major, version.minor) < std::make_pair(4, 8)) {
    throw Error("The libgmsh in use (" + gmsh.path() + ") is version " + told +
                ": install Gmsh 4.8 or later.");
  }
  return version;
}

bool is_4_8() {
  const Version version = require_gmsh();
  return version.major == 4 && version.minor == 8;
}

void initialize(const std::vector<std::string>& arguments) {
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  for (const std::string& argument : arguments) {
    argv.push_back(const_cast<char*>(argument.c_str()));
  }
  const auto argc = static_cast<int>(argv.size());
  argv.push_back(nullptr);
  // Gmsh 4.9 added both this function and the argument `run`.
  if (library().has("gmshModelMeshGetMaxNodeTag")) {
    library().call("gmshInitialize", argc, argv.data(), 1, 0);
  } else {
    library().call("gmshInitialize", argc, argv.data(), 1);
  }
  require_gmsh();
}

void finalize() { library().call("gmshFinalize"); }

std::string version_text() {
  GmshString text;
  library().call("gmshOptionGetString", static_cast<const char*>("General.Version"), text.data());
  return text.copy();
}

std::string library_path() { return library().path(); }
void open(const std::string& file) { library().call("gmshOpen", file.c_str()); }
void merge(const std::string& file) { library().call("gmshMerge", file.c_str()); }
void write(const std::string& file) { library().call("gmshWrite", file.c_str()); }

double option(const std::string& name) {
  double value = 0.0;
  library().call("gmshOptionGetNumber", name.c_str(), &value);
  return value;
}

double option_or(const std::string& name, double otherwise) {
  const Silence silence;  // or the missing option would be an error in the user's log
  try {
    return option(name);
  } catch (const Error&) {
    return otherwise;  // this version has no such option
  }
}

void set_option(const std::string& name, double value) {
  library().call("gmshOptionSetNumber", name.c_str(), value);
}

std::vector<std::string> onelab_names(const std::string& expression) {
  GmshStrings names;
  library().call("gmshOnelabGetNames", names.data(), names.size(), expression.c_str());
  return names.copy();
}

std::string onelab_string(const std::string& name) {
  GmshStrings values;
  library().call("gmshOnelabGetString", name.c_str(), values.data(), values.size());
  const std::vector<std::string> all = values.copy();
  return all.empty() ? "" : all.front();
}

bool is_onelab_number(const std::string& name) {
  GmshArray<double> values;
  library().call("gmshOnelabGetNumber", name.c_str(), values.data(), values.size());
  return *values.size() > 0;
}

void remove_onelab(const std::string& name) { library().call("gmshOnelabClear", name.c_str()); }

void set_onelab_string(const std::string& name, const std::string& value) {
  const char* values[] = {value.c_str()};
  library().call("gmshOnelabSetString", name.c_str(), static_cast<const char* const*>(values),
                 std::size_t{1});
}

std::string current_model() {
  GmshString name;
  library().call("gmshModelGetCurrent", name.data());
  return name.copy();
}

void set_current_model(const std::string& name) {
  library().call("gmshModelSetCurrent", name.c_str());
}

std::vector<std::string> models() {
  GmshStrings names;
  library().call("gmshModelList", names.data(), names.size());
  return names.copy();
}

void log(const std::string& message, const std::string& level) {
  library().call("gmshLoggerWrite", message.c_str(), level.c_str());
}

}  // namespace meshgrow::gmsh
