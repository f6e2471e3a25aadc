#ifndef MESHGROW_MESH_FINGERPRINT_H
#define MESHGROW_MESH_FINGERPRINT_H

#include <cstdint>
#include <map>

#include "entity.h"

namespace meshgrow {

/// What tells whether an entity of the current model was meshed anew: a number made of the types of
/// its elements, and the tags and coordinates of the nodes on it, boundary not included; 0 without
/// elements. The elements themselves take Gmsh ten times as long to tell, and do not change alone,
/// unless edges are swapped.
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
