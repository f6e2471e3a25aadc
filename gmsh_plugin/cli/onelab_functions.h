#ifndef MESHGROW_CLI_ONELAB_FUNCTIONS_H
#define MESHGROW_CLI_ONELAB_FUNCTIONS_H

#include <string>
#include <vector>

namespace meshgrow::cli {

/// A size function that a .geo defines, a string parameter of ONELAB under "Size functions/":
///
///     DefineConstant[ sf = {"mesh source Surface{7} attach Volume{2} growth 1.2 limit 2",
///                           Name "Size functions/inner", ReadOnly 1} ];
struct OnelabFunction {
  std::string name;  ///< such as "inner"
  std::string text;
};

/// Those that were defined since `forget_onelab_functions`, by name, which is the order of ONELAB;
/// empty texts and numbers are left out.
std::vector<OnelabFunction> onelab_functions();

/// Warns, in Gmsh's log, of those that are left out.
void warn_of_unusable_onelab_functions();

/// Removes what models that were opened before have defined: ONELAB has one database for all.
void forget_onelab_functions();

}  // namespace meshgrow::cli

#endif
