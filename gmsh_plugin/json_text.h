#ifndef MESHGROW_JSON_TEXT_H
#define MESHGROW_JSON_TEXT_H

#include <nlohmann/json.hpp>
#include <string>

namespace meshgrow {

/// As text, with bytes of names that are no UTF-8 replaced; `indent` -1 for one line.
inline std::string json_text(const nlohmann::json& value, int indent = -1) {
  return value.dump(indent, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace meshgrow

#endif
