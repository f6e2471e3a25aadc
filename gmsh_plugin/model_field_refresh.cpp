// How a ModelField comes up to date with the model.

#include <algorithm>
#include <mutex>
#include <numeric>
#include <shared_mutex>
#include <system_error>

#include "error.h"
#include "gmsh_api.h"
#include "gmsh_state.h"
#include "model_field.h"

namespace meshgrow {

void ModelField::check_model() const {
  std::vector<Entity> now = gmsh::entities();
  now.erase(std::remove_if(now.begin(), now.end(),
                           [this](const Entity& entity) {
                             return !field_.topology().contains(entity) &&
                                    field_.topology().contains(
                                        {entity.dim, entity.tag - gmsh::compound_offset});
                           }),
            now.end());
  std::sort(now.begin(), now.end());
  if (now != field_.topology().entities()) {
    throw Error(
        "The model has other entities than when this size field was made: make a new field "
        "after changing the geometry.");
  }
}

void ModelField::check_places() const {
  for (const auto& [point, place] : points_) {
    if (gmsh::points_at(point, {}) != std::vector<Vec3>{place} && !gmsh::is_discrete(point)) {
      throw Error(entity_name(point) +
                  " is not where it was when this size field was made, so the model was built anew "
                  "or moved: make a new field after changing the geometry.");
    }
  }
}

void ModelField::change(const std::function<void()>& body) {
  std::unique_lock<std::shared_mutex> lock(answers_.mutex(), std::defer_lock);
  try {
    if (answers_.is_asking_user()) {
      throw std::system_error(std::make_error_code(std::errc::resource_deadlock_would_occur));
    }
    lock.lock();
  } catch (const std::system_error&) {
    throw Error(
        "The size field is at work, and called this: let your own sizes and the listener of "
        "progress not change it.");
  }
  body();
}

void ModelField::refresh() {
  if (file_.empty()) {  // else it has all that it will ever have
    change([this] { refresh_unlocked(); });
  }
}

void ModelField::refresh_unlocked() {
  const CurrentModel current(model_);
  all_or_nothing([this] { read_all(is_registered() || ready_for_calls_); });
}

void ModelField::read_all(bool wait_for_meshes) {
  check_model();
  check_places();
  forget_kept_sources();
  std::vector<std::size_t> all(field_.functions().size());
  std::iota(all.begin(), all.end(), 0U);
  read_sources(all);
  reported_.clear();
  expect_late_sources(wait_for_meshes);
  for (const std::size_t function : all) {
    if (!waits_for_meshes(function)) {
      report_unmeshed(function);
    }
  }
  field_.build({}, wait_for_meshes ? sizes_per_tetrahedron() : 0.0);
}

void ModelField::read_if_needed() {
  if (!file_.empty()) {
    return;
  }
  const CurrentModel current(model_);
  if (gmsh::option("Mesh.MeshSizeFactor") != size_factor_ && !read_as_.empty()) {
    refresh_unlocked();
    return;
  }
  // Within a run of Gmsh, which has thrown meshes away, a user's own callback may ask.
  const bool may_run = is_registered() || ready_for_calls_;
  if (!may_run) {
    check_model();
    for (std::size_t i = 0; strict_ && i < field_.functions().size(); ++i) {
      report_unmeshed(i);
    }
  }
  const std::vector<std::size_t> unread = unread_functions(may_run);
  if (unread.empty()) {
    return;
  }
  if (may_run) {
    check_model();
  }
  check_places();
  forget_kept_sources();
  all_or_nothing([&] {
    read_sources(unread);
    for (const std::size_t function : unread) {
      reported_.erase(function);
      report_unmeshed(function);
    }
    field_.build();
  });
}

void ModelField::ask(const std::function<void(const SizeField&)>& question) {
  if (answers_.is_asking_user()) {
    question(field_);
    return;
  }
  change([this] { refresh_if_needed(); });
  const std::shared_lock<std::shared_mutex> lock(answers_.mutex());
  question(field_);
}

void ModelField::refresh_if_needed() {
  read_if_needed();
  field_.build();
}

}  // namespace meshgrow
