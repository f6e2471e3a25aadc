#include "volume_nesting.h"

#include <algorithm>
#include <map>
#include <utility>

namespace meshgrow {

namespace {

std::vector<Entity> faces_of(const Entity& volume, const Topology& topology) {
  std::vector<Entity> faces;
  for (const Entity& lower : topology.lower(volume)) {
    if (lower.dim == 2) {
      faces.push_back(lower);
    }
  }
  return faces;
}

}  // namespace

std::set<Entity> enclosed_volumes(const Entity& volume, const Topology& topology) {
  const std::vector<Entity> own = faces_of(volume, topology);
  const std::set<Entity> own_faces(own.begin(), own.end());
  std::map<Entity, std::vector<Entity>> volumes_at;
  for (const Entity& other : topology.entities(3)) {
    for (const Entity& face : faces_of(other, topology)) {
      volumes_at[face].push_back(other);
    }
  }
  std::set<Entity> visited{volume};
  std::set<Entity> enclosed;
  for (const Entity& face : own) {
    for (const Entity& start : volumes_at[face]) {
      // All that hangs together with `start` through faces that are not the volume's own.
      std::set<Entity> component;
      bool closed = true;
      std::vector<Entity> open;
      if (visited.insert(start).second) {
        open.push_back(start);
      }
      while (!open.empty()) {
        const Entity other = open.back();
        open.pop_back();
        component.insert(other);
        for (const Entity& side : faces_of(other, topology)) {
          if (own_faces.count(side) > 0) {
            continue;
          }
          closed = closed && volumes_at[side].size() > 1;
          for (const Entity& next : volumes_at[side]) {
            if (visited.insert(next).second) {
              open.push_back(next);
            }
          }
        }
      }
      if (closed) {
        enclosed.insert(component.begin(), component.end());
      }
    }
  }
  return enclosed;
}

std::vector<std::vector<Entity>> volume_passes(const std::vector<Entity>& volumes,
                                               const std::set<Entity>& attached,
                                               const Topology& topology) {
  std::map<Entity, std::set<Entity>> inside;
  for (const Entity& volume : volumes) {
    inside[volume] = enclosed_volumes(volume, topology);
  }
  // A volume encloses all that the volumes in it enclose: fewer inside first is innermost first.
  std::vector<Entity> innermost_first = volumes;
  std::stable_sort(
      innermost_first.begin(), innermost_first.end(),
      [&](const Entity& a, const Entity& b) { return inside[a].size() < inside[b].size(); });
  std::map<Entity, int> level;
  std::map<std::pair<int, bool>, std::vector<Entity>> passes;
  for (const Entity& volume : innermost_first) {
    const bool is_attached = attached.count(volume) > 0;
    int own_level = 0;
    for (const Entity& inner : inside[volume]) {
      const auto found = level.find(inner);
      if (found != level.end()) {
        const bool differs = (attached.count(inner) > 0) != is_attached;
        own_level = std::max(own_level, found->second + (differs ? 1 : 0));
      }
    }
    level[volume] = own_level;
    passes[{own_level, !is_attached}].push_back(volume);
  }
  std::vector<std::vector<Entity>> result;
  for (auto& [key, members] : passes) {
    std::sort(members.begin(), members.end());
    result.push_back(std::move(members));
  }
  return result;
}

}  // namespace meshgrow
