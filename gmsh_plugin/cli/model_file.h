#ifndef MESHGROW_CLI_MODEL_FILE_H
#define MESHGROW_CLI_MODEL_FILE_H

#include <string>
#include <vector>

namespace meshgrow::cli {

/// Makes Gmsh open the first file as its current model and merge the others into it, with the size
/// functions that they define (onelab_functions.h). Throws UsageError that names the file if one
/// cannot be read or the model holds nothing.
void open_model(const std::vector<std::string>& files);
void open_model(const std::string& file);

}  // namespace meshgrow::cli

#endif
