#ifndef MESHGROW_CLI_OUTPUT_FILE_H
#define MESHGROW_CLI_OUTPUT_FILE_H

#include <filesystem>
#include <string>

namespace meshgrow::cli {

/// The ending, such as ".msh", of files in the format that Gmsh's option Mesh.Format asks for;
/// empty if a file's own ending decides. Throws UsageError for a format without one.
std::string ending_of_format();

/// Throws UsageError if the output file could not be written. Changes nothing.
void check_writable(const std::filesystem::path& output, const std::string& remedy);

/// Writes what Gmsh has, in the format that Mesh.Format asks for. An old file is replaced when the
/// new one is complete. Throws Error that names the file.
void write_mesh(const std::filesystem::path& output);

/// The same for a text.
void write_text(const std::filesystem::path& output, const std::string& text);

}  // namespace meshgrow::cli

#endif
