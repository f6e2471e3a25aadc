#ifndef MESHGROW_TESTS_SHORT_NAMES_H
#define MESHGROW_TESTS_SHORT_NAMES_H

#include <string>
#include <vector>

#include "entity.h"

namespace meshgrow::test {

/// "C1 C2 S7 ": a letter for point, curve, surface or volume, and the tag.
inline std::string short_names(const std::vector<Entity>& entities) {
  std::string result;
  for (const Entity& entity : entities) {
    result += std::string(1, "PCSV"[entity.dim]) + std::to_string(entity.tag) + ' ';
  }
  return result;
}

}  // namespace meshgrow::test

#endif
