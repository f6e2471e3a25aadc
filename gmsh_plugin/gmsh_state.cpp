#include "gmsh_state.h"

#include <algorithm>

#include "error.h"
#include "gmsh_api.h"
#include "restore.h"

namespace meshgrow {

CurrentModel::CurrentModel(const std::string& name) {
  gmsh::require_gmsh();
  before_ = gmsh::current_model();
  if (before_ == name) {
    return;
  }
  const std::vector<std::string> models = gmsh::models();
  if (std::find(models.begin(), models.end(), name) == models.end()) {
    throw Error("The model \"" + name +
                "\" of this size field is not in Gmsh any more: make a new field.");
  }
  gmsh::set_current_model(name);
}

CurrentModel::~CurrentModel() {
  bool is_current = false;
  restore([&] { is_current = gmsh::current_model() == before_; });
  if (!is_current) {  // or not known for want of memory, which setting does not need
    restore([this] { gmsh::set_current_model(before_); });
  }
}

GmshState::~GmshState() {
  for (const auto& [name, value] : options_) {
    restore([&name = name, value = value] { gmsh::set_option(name, value); });
  }
  for (const auto& [entity, visible] : visibility_) {
    // One by one, since that needs no memory.
    restore([&entity = entity, visible = visible] { gmsh::set_visible(entity, visible); });
  }
}

void GmshState::set_option(const std::string& name, double value) {
  options_.emplace(name, gmsh::option(name));
  gmsh::set_option(name, value);
}

double GmshState::user_option(const std::string& name) const {
  const auto changed = options_.find(name);
  return changed != options_.end() ? changed->second : gmsh::option(name);
}

void GmshState::show_only(const std::vector<Entity>& shown, const std::vector<Entity>& all) {
  for (const Entity& entity : all) {
    if (visibility_.count(entity) == 0) {
      visibility_[entity] = gmsh::visible(entity);
    }
  }
  gmsh::set_visible(all, false);
  gmsh::set_visible(shown, true);
}

}  // namespace meshgrow
