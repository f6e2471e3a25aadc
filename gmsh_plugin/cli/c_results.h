#ifndef MESHGROW_CLI_C_RESULTS_H
#define MESHGROW_CLI_C_RESULTS_H

#include <memory>
#include <string>

#include "error.h"
#include "meshgrow.h"

/// What the C interface returns, as C++ values: failures are thrown, memory is freed.
namespace meshgrow::cli {

inline void check(int failed) {
  if (failed != 0) {
    throw Error(meshgrow_last_error());
  }
}

inline std::string take_text(char* text) {
  check(text == nullptr ? 1 : 0);
  const std::unique_ptr<char, decltype(&meshgrow_free)> owner(text, &meshgrow_free);
  return text;
}

struct FieldDeleter {
  void operator()(meshgrow_field* field) const { meshgrow_field_destroy(field); }
};
using FieldPointer = std::unique_ptr<meshgrow_field, FieldDeleter>;

}  // namespace meshgrow::cli

#endif
