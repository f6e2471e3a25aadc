#ifndef MESHGROW_ERROR_H
#define MESHGROW_ERROR_H

#include <stdexcept>
#include <string>

namespace meshgrow {

/// The only exception type that meshgrow throws on purpose. Its message is one sentence that names
/// the entity or parameter concerned and the remedy.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& sentence) : std::runtime_error(sentence) {}
};

}  // namespace meshgrow

#endif
