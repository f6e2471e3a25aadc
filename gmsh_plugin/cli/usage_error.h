#ifndef MESHGROW_CLI_USAGE_ERROR_H
#define MESHGROW_CLI_USAGE_ERROR_H

#include <string>

#include "error.h"

namespace meshgrow::cli {

/// What the user typed is wrong, in contrast to work that failed. Ends the program with another
/// exit code.
class UsageError : public Error {
 public:
  explicit UsageError(const std::string& sentence) : Error(sentence) {}
};

/// Exit codes of the program; an interrupt (Ctrl-C) makes 130, as in a shell.
enum ExitCode { done = 0, work_failed = 1, wrong_use = 2 };

/// For the end of each command's help.
constexpr const char* exit_codes_help =
    "Exit codes: 0 done; 1 meshing or a check failed; 2 wrong use (options, size functions, files "
    "that cannot be read or written); 130 interrupted.";

}  // namespace meshgrow::cli

#endif
