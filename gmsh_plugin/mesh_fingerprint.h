#ifndef MESHGROW_MESH_FINGERPRINT_H
#define MESHGROW_MESH_FINGERPRINT_H

#include <cstdint>
#include <map>

#include "entity.h"

namespace meshgrow {

/// What tells whether an entity of the current model was meshed anew: a number made of node tags,
/// coordinates, and the elements' types and nodes; 0 without elements. Element tags do not count,
/// since Gmsh changes them on its own.
///
/// Reads each entity once. Not thread-safe.
class MeshFingerprints {
 public:
  std::uint64_t of(const Entity& entity);

 private:
  std::map<Entity, std::uint64_t> known_;
};

}  // namespace meshgrow

#endif
