// The entities of Gmsh's model and its physical groups.

#include <array>

#include "changed_option.h"
#include "dim_tags.h"
#include "gmsh_api.h"
#include "gmsh_memory.h"

namespace meshgrow::gmsh {

std::vector<Entity> entities() {
  GmshArray<int> dim_tags;
  library().call("gmshModelGetEntities", dim_tags.data(), dim_tags.size(), -1);
  return to_entities(dim_tags.copy());
}

std::vector<Entity> boundary(const Entity& entity) {
  std::array<int, 2> dim_tag = {entity.dim, entity.tag};
  GmshArray<int> result;
  // Not combined, or seams would cancel out; not oriented, or tags would be signed.
  library().call("gmshModelGetBoundary", dim_tag.data(), dim_tag.size(), result.data(),
                 result.size(), 0, 0, 0);
  return to_entities(result.copy());
}

std::vector<Entity> embedded(const Entity& entity) {
  GmshArray<int> result;
  library().call("gmshModelMeshGetEmbedded", entity.dim, entity.tag, result.data(), result.size());
  return to_entities(result.copy());
}

Box bounding_box(const Entity& entity) {
  Vec3 low;
  Vec3 high;
  const Silence silence;  // or a box that is empty would be an error in the user's log
  try {
    library().call("gmshModelGetBoundingBox", entity.dim, entity.tag, &low.x(), &low.y(), &low.z(),
                   &high.x(), &high.y(), &high.z());
  } catch (const Error&) {
    // A discrete entity without a mesh of its own, as when only some physical groups were saved.
    return Box();
  }
  return (low.array() <= high.array()).all() ? Box(low, high) : Box();
}

std::string entity_type(const Entity& entity) {
  GmshString type;
  library().call("gmshModelGetType", entity.dim, entity.tag, type.data());
  return type.copy();
}

bool is_discrete(const Entity& entity) {
  return entity_type(entity).find("Discrete") != std::string::npos;
}

Entity add_discrete_point() {
  const int* no_boundary = nullptr;
  return {0, library().call_int("gmshModelAddDiscreteEntity", 0, -1, no_boundary, std::size_t{0})};
}

void remove_entity(const Entity& entity) {
  std::array<int, 2> dim_tag = {entity.dim, entity.tag};
  library().call("gmshModelRemoveEntities", dim_tag.data(), dim_tag.size(), 0);
  // Gmsh's own kernel keeps a discrete point otherwise, and makes it again when it synchronizes.
  library().call("gmshModelGeoRemove", dim_tag.data(), dim_tag.size(), 0);
}

std::vector<Entity> physical_groups() {
  GmshArray<int> dim_tags;
  library().call("gmshModelGetPhysicalGroups", dim_tags.data(), dim_tags.size(), -1);
  return to_entities(dim_tags.copy());
}

std::string physical_name(const Entity& group) {
  GmshString name;
  library().call("gmshModelGetPhysicalName", group.dim, group.tag, name.data());
  return name.copy();
}

std::vector<Entity> entities_of_physical_group(const Entity& group) {
  GmshArray<int> tags;
  library().call("gmshModelGetEntitiesForPhysicalGroup", group.dim, group.tag, tags.data(),
                 tags.size());
  std::vector<Entity> result;
  for (const int tag : tags.copy()) {
    result.push_back({group.dim, tag});
  }
  return result;
}

bool visible(const Entity& entity) {
  int value = 0;
  library().call("gmshModelGetVisibility", entity.dim, entity.tag, &value);
  return value != 0;
}

void set_visible(const Entity& entity, bool visible) {
  std::array<int, 2> dim_tag = {entity.dim, entity.tag};
  library().call("gmshModelSetVisibility", dim_tag.data(), dim_tag.size(), visible ? 1 : 0, 0);
}

void set_visible(const std::vector<Entity>& entities, bool visible) {
  std::vector<int> dim_tags = to_dim_tags(entities);
  library().call("gmshModelSetVisibility", dim_tags.data(), dim_tags.size(), visible ? 1 : 0, 0);
}

}  // namespace meshgrow::gmsh
