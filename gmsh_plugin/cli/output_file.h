#ifndef MESHGROW_CLI_OUTPUT_FILE_H
#define MESHGROW_CLI_OUTPUT_FILE_H

#include <filesystem>

namespace meshgrow::cli {

/// Throws Error if the output file could not be written. Changes nothing.
void check_writable(const std::filesystem::path& output);

/// Writes what Gmsh has in the format that the file's ending tells. An old file is replaced when
/// the new one is complete. Throws Error that names the file.
void write_mesh(const std::filesystem::path& output);

}  // namespace meshgrow::cli

#endif
