#ifndef MESHGROW_CLI_MODEL_FILE_H
#define MESHGROW_CLI_MODEL_FILE_H

#include <string>

namespace meshgrow::cli {

/// Makes Gmsh open the file as its current model. Throws Error that names the file if it cannot be
/// read or holds nothing.
void open_model(const std::string& file);

}  // namespace meshgrow::cli

#endif
