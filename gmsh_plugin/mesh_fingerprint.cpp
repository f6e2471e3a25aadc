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
  const std::vector<gmsh::Elements> elements = gmsh::elements(entity);
  std::vector<std::uint64_t> parts;
  for (const gmsh::Elements& of_type : elements) {
    if (!of_type.tags.empty()) {
      parts.push_back(static_cast<std::uint64_t>(of_type.type));
      parts.push_back(checksum_of(of_type.node_tags));
    }
  }
  if (parts.empty()) {
    return 0;
  }
  const gmsh::Nodes nodes = gmsh::nodes(entity);
  parts.push_back(checksum_of(nodes.tags));
  parts.push_back(checksum_of(nodes.coordinates));
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
