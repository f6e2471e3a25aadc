// What a SizeField answers: sizes, and what it is made of.

#include <algorithm>

#include "size_field.h"

namespace meshgrow {

const SizeField::Group* SizeField::group(const Entity& entity) const {
  const auto found = group_of_.find(entity);
  return found == group_of_.end() ? nullptr : &groups_[found->second];
}

std::vector<std::size_t> SizeField::functions_on(const Entity& entity) const {
  std::vector<std::size_t> result;
  if (const Group* found = group(entity)) {
    for (const Action& action : found->actions) {
      result.push_back(action.function);
    }
  }
  return result;
}

double SizeField::size(const Entity& entity, const Vec3& p) const {
  const Group* found = group(entity);
  if (found == nullptr || !found->tree || !p.allFinite()) {
    return no_size;
  }
  bool interpolated = false;
  const double size =
      found->grid ? found->grid->size(p, interpolated) : found->tree->size(p, found->size_limit);
  found->answers->add(interpolated ? AnswerCount::grid : AnswerCount::exact);
  return size;
}

double SizeField::exact_size(const Entity& entity, const Vec3& p) const {
  const Group* found = group(entity);
  if (found == nullptr || !found->tree || !p.allFinite()) {
    return no_size;
  }
  return found->tree->size(p, found->size_limit);
}

/// `ask(group, points, count, sizes)` for stretches of points that are finite; `no_size` for the
/// others, and where no function acts.
template <typename Ask>
void SizeField::ask_at_finite(const Entity& entity, const Vec3* points, std::size_t count,
                              double* sizes, Ask ask) const {
  std::fill(sizes, sizes + count, no_size);
  const Group* found = group(entity);
  if (found == nullptr || !found->tree) {
    return;
  }
  for (std::size_t begin = 0; begin < count;) {
    std::size_t end = begin;
    while (end < count && points[end].allFinite()) {
      ++end;
    }
    if (end > begin) {
      ask(*found, points + begin, end - begin, sizes + begin);
    }
    begin = end + 1;
  }
}

void SizeField::sizes(const Entity& entity, const Vec3* points, std::size_t count,
                      double* sizes) const {
  ask_at_finite(entity, points, count, sizes,
                [](const Group& group, const Vec3* from, std::size_t n, double* to) {
                  std::size_t interpolated = 0;
                  if (group.grid) {
                    interpolated = group.grid->sizes(from, n, to);
                  } else {
                    group.tree->sizes(from, n, group.size_limit, to);
                  }
                  group.answers->add(AnswerCount::grid, interpolated);
                  group.answers->add(AnswerCount::exact, n - interpolated);
                });
}

void SizeField::exact_sizes(const Entity& entity, const Vec3* points, std::size_t count,
                            double* sizes) const {
  ask_at_finite(entity, points, count, sizes,
                [](const Group& group, const Vec3* from, std::size_t n, double* to) {
                  group.tree->sizes(from, n, group.size_limit, to);
                });
}

std::vector<SizeField::GroupSummary> SizeField::groups() const {
  std::vector<GroupSummary> result;
  for (const Group& group : groups_) {
    GroupSummary summary;
    summary.entities = group.entities;
    for (const Action& action : group.actions) {
      summary.functions.push_back(action.function);
    }
    summary.size_limit = group.size_limit;
    if (group.tree) {
      summary.facets = group.tree->facets().size();
      summary.tree_bytes = group.tree->memory_bytes();
      summary.tree_seconds = group.tree_seconds;
      summary.exact_answers = group.answers->total(AnswerCount::exact);
      summary.answers = summary.exact_answers + group.answers->total(AnswerCount::grid);
    }
    if (group.grid) {
      summary.has_grid = true;
      summary.grid = group.grid->statistics();
    }
    result.push_back(std::move(summary));
  }
  return result;
}

}  // namespace meshgrow
