#include "mesh_fingerprint.h"

#include <vector>

#include "checked_blocks.h"
#include "gmsh_api.h"

namespace meshgrow {

namespace {

template <typename T>
std::uint64_t checksum_of(const std::vector<T>& values) {
  return checksum(values.data(), values.size() * sizeof(T));
}

std::uint64_t fingerprint(const Entity& entity) {
  const std::vector<int> types = gmsh::element_types(entity);
  if (types.empty()) {
    return 0;
  }
  const gmsh::Nodes nodes = gmsh::nodes_without_parameters(entity);
  const std::vector<std::uint64_t> parts = {checksum_of(types), checksum_of(nodes.tags),
                                            checksum_of(nodes.coordinates)};
  return checksum_of(parts) | 1;
}

}  // namespace

std::uint64_t MeshFingerprints::of(const Entity& entity) {
  const auto [found, is_new] = known_.emplace(entity, 0);
  if (is_new) {
    found->second = fingerprint(entity);
  }
  return found->second;
}

}  // namespace meshgrow
