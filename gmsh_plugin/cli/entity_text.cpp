#include "entity_text.h"

#include <cmath>
#include <locale>
#include <sstream>

#include "usage_error.h"

namespace meshgrow::cli {

namespace {

/// Reads "a,b,…" into the values; false if anything else stands there.
template <typename Value>
bool read_list(const std::string& text, Value* values, int count) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  for (int i = 0; i < count; ++i) {
    char comma = ',';
    if ((i > 0 && !(stream >> comma)) || comma != ',' || !(stream >> values[i])) {
      return false;
    }
  }
  return (stream >> std::ws).eof();
}

}  // namespace

Entity read_entity(const std::string& text, const Topology& topology) {
  int numbers[2] = {0, 0};
  if (!read_list(text, numbers, 2) || numbers[0] < 0 || numbers[0] > 3) {
    throw UsageError("'" + text +
                     "' is no entity: give its dimension (0 to 3) and tag, for example 3,2.");
  }
  const Entity entity{numbers[0], numbers[1]};
  if (!topology.contains(entity)) {
    throw UsageError(entity_name(entity) + " is not in the model: check its dimension and tag.");
  }
  return entity;
}

Vec3 read_point(const std::string& text) {
  Vec3 p;
  if (!read_list(text, p.data(), 3) || !p.allFinite()) {
    throw UsageError("'" + text + "' is no point: give its coordinates, for example 0.5,1,-2.");
  }
  return p;
}

}  // namespace meshgrow::cli
