// A SizeField taken apart for a file, and put together again.

#include "error.h"
#include "size_field.h"

namespace meshgrow {

SizeField::Parts SizeField::parts() const {
  Parts parts = {options_.tolerance, *topology_, functions_, effective_, facet_counts_, {}};
  for (const Group& group : groups_) {
    if (group.changed || !group.tree) {
      throw Error("The size field has changed since it was built: build it before saving it.");
    }
    parts.groups.push_back({group.actions, group.entities, group.size_limit, group.limit,
                            group.origins, group.tree, group.grid});
  }
  return parts;
}

SizeField::SizeField(Parts parts)
    : topology_(std::make_shared<Topology>(std::move(parts.topology))),
      functions_(std::move(parts.functions)),
      facets_(functions_.size()),
      facet_counts_(std::move(parts.facet_counts)),
      origins_(functions_.size()),
      effective_(std::move(parts.effective)) {
  options_.tolerance = parts.tolerance;
  for (Part& part : parts.groups) {
    for (const Entity& entity : part.entities) {
      group_of_[entity] = groups_.size();
    }
    Group group;
    group.actions = std::move(part.actions);
    group.entities = std::move(part.entities);
    group.changed = false;
    group.size_limit = part.size_limit;
    group.limit = part.limit;
    group.origins = std::move(part.origins);
    group.tree = std::move(part.tree);
    group.grid = std::move(part.grid);
    groups_.push_back(std::move(group));
  }
}

}  // namespace meshgrow
