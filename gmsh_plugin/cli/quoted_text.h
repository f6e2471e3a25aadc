#ifndef MESHGROW_CLI_QUOTED_TEXT_H
#define MESHGROW_CLI_QUOTED_TEXT_H

#include <string>

/// Names of files in what a user may copy.
namespace meshgrow::cli {

/// For a shell: as it is if it has none but harmless characters, else in single quotes.
std::string shell_quoted(const std::string& text);

/// Between the double quotes of Python or of a .geo, which are added.
std::string double_quoted(const std::string& text);

}  // namespace meshgrow::cli

#endif
