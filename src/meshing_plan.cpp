#include "meshing_plan.h"

#include <algorithm>
#include <deque>
#include <map>

#include "error.h"
#include "text_stream.h"
#include "volume_nesting.h"

namespace meshgrow {

namespace {

/// Why an entity has to wait.
struct Wait {
  static constexpr std::size_t boundary = static_cast<std::size_t>(-1);
  static constexpr std::size_t master = static_cast<std::size_t>(-2);

  Entity target;                    ///< that has to be meshed before
  std::size_t function = boundary;  ///< whose source it is, or `boundary` or `master`
};

class Planner {
 public:
  Planner(const MeshingTask& task, int dim) : task_(task), dim_(dim), done_(task.meshed) {
    find_actions();
    find_waits();
    keep_together();
  }

  std::vector<MeshingPass> plan() {
    while (!waits_.empty()) {
      const std::vector<Entity> stage = next_stage();
      if (stage.empty()) {
        throw Error(cycle_in_words());
      }
      add_passes(stage);
      ++stage_count_;
      for (const Entity& entity : stage) {
        done_.insert(entity);
        waits_.erase(entity);
      }
    }
    return std::move(passes_);
  }

 private:
  const std::vector<SizeFunction>& functions() const { return task_.functions; }
  bool is_open(const Entity& entity) const { return waits_.count(entity) > 0; }

  void find_actions() {
    for (std::size_t i = 0; i < functions().size(); ++i) {
      for (const Entity& entity : task_.topology.closure(functions()[i].attachments)) {
        acting_[entity].push_back(i);
      }
    }
  }

  void find_waits() {
    for (const Entity& entity : task_.topology.entities()) {
      if (entity.dim >= 1 && entity.dim <= dim_ && task_.meshed.count(entity) == 0) {
        waits_[entity];
      }
    }
    std::vector<std::set<Entity>> own;
    for (const SizeFunction& function : functions()) {
      own.push_back(closure_with_masters(function.sources, task_.topology, task_.masters));
    }
    for (auto& [entity, waits] : waits_) {
      for (const Entity& lower : task_.topology.lower(entity)) {
        if (is_open(lower)) {
          waits.push_back({lower, Wait::boundary});
        }
      }
      const auto master = task_.masters.find(entity);
      if (master != task_.masters.end()) {
        if (is_open(master->second)) {
          waits.push_back({master->second, Wait::master});
        }
        continue;
      }
      const auto acting = acting_.find(entity);
      if (acting == acting_.end() || task_.companions.count(entity) > 0) {
        continue;
      }
      for (const std::size_t i : acting->second) {
        if (functions()[i].kind != Kind::mesh || own[i].count(entity) > 0) {
          continue;
        }
        for (const Entity& source : functions()[i].sources) {
          if (is_open(source)) {
            waits.push_back({source, i});
          }
        }
      }
    }
  }

  /// All that an entity waits for, directly or not.
  std::set<Entity> awaited_by(const std::vector<Entity>& entities) const {
    std::set<Entity> found;
    std::vector<Entity> open = entities;
    while (!open.empty()) {
      const Entity entity = open.back();
      open.pop_back();
      for (const Wait& wait : waits_.at(entity)) {
        if (is_open(wait.target) && found.insert(wait.target).second) {
          open.push_back(wait.target);
        }
      }
    }
    return found;
  }

  void keep_together() {
    for (const std::vector<Entity>& set : task_.together) {
      std::vector<Entity> members;
      std::copy_if(set.begin(), set.end(), std::back_inserter(members),
                   [this](const Entity& member) { return is_open(member); });
      const std::set<Entity> awaited = awaited_by(members);
      if (std::any_of(members.begin(), members.end(),
                      [&awaited](const Entity& member) { return awaited.count(member) > 0; })) {
        continue;
      }
      std::vector<Wait> all;
      for (const Entity& member : members) {
        all.insert(all.end(), waits_[member].begin(), waits_[member].end());
      }
      for (const Entity& member : members) {
        waits_[member] = all;
      }
    }
  }

  bool is_ready(const Entity& entity) const {
    const std::vector<Wait>& waits = waits_.at(entity);
    return std::none_of(waits.begin(), waits.end(),
                        [this](const Wait& wait) { return is_open(wait.target); });
  }

  /// Entities of the lowest dimension that has any ready; of these, if lower ones are still open,
  /// those only that are waited for by them.
  std::vector<Entity> next_stage() const {
    for (int dim = 1; dim <= dim_; ++dim) {
      std::vector<Entity> lower;
      for (const auto& [entity, waits] : waits_) {
        if (entity.dim < dim) {
          lower.push_back(entity);
        }
      }
      const std::set<Entity> awaited = awaited_by(lower);
      std::vector<Entity> stage;
      for (const auto& [entity, waits] : waits_) {
        const bool in_turn =
            lower.empty() || awaited.count(entity) > 0 || task_.companions.count(entity) > 0;
        if (entity.dim == dim && in_turn && is_ready(entity)) {
          stage.push_back(entity);
        }
      }
      if (!stage.empty()) {
        return stage;
      }
    }
    return {};
  }

  bool is_effective(std::size_t function) const {
    const SizeFunction& definition = functions()[function];
    return definition.kind != Kind::mesh ||
           std::any_of(definition.sources.begin(), definition.sources.end(),
                       [this](const Entity& source) { return done_.count(source) > 0; });
  }

  std::vector<std::size_t> effective_on(const Entity& entity) const {
    std::vector<std::size_t> result;
    const auto acting = acting_.find(entity);
    if (acting != acting_.end()) {
      std::copy_if(acting->second.begin(), acting->second.end(), std::back_inserter(result),
                   [this](std::size_t function) { return is_effective(function); });
    }
    return result;
  }

  void add_passes(const std::vector<Entity>& stage) {
    std::set<Entity> attached;
    for (const Entity& entity : stage) {
      if (!effective_on(entity).empty()) {
        attached.insert(entity);
      }
    }
    if (stage.front().dim == 3) {
      for (const std::vector<Entity>& volumes : volume_passes(stage, attached, task_.topology)) {
        add_pass(volumes, attached.count(volumes.front()) > 0);
      }
      return;
    }
    std::vector<Entity> others;
    std::set_difference(stage.begin(), stage.end(), attached.begin(), attached.end(),
                        std::back_inserter(others));
    add_pass({attached.begin(), attached.end()}, true);
    add_pass(others, false);
  }

  void add_pass(const std::vector<Entity>& entities, bool attached) {
    if (entities.empty()) {
      return;
    }
    MeshingPass pass;
    pass.stage = stage_count_;
    pass.dim = entities.front().dim;
    pass.attached = attached;
    pass.entities = entities;
    std::set<std::size_t> acting;
    for (const Entity& entity : entities) {
      const std::vector<std::size_t> more = effective_on(entity);
      acting.insert(more.begin(), more.end());
    }
    pass.functions.assign(acting.begin(), acting.end());
    std::set<Entity> sources;
    for (const std::size_t function : acting) {
      for (const Entity& source : functions()[function].sources) {
        const bool readable = functions()[function].kind != Kind::mesh || done_.count(source) > 0;
        if (readable && read_.insert({function, source}).second) {
          sources.insert(source);
        }
      }
    }
    pass.sources.assign(sources.begin(), sources.end());
    passes_.push_back(std::move(pass));
  }

  /// A shortest way from an entity back to itself.
  std::vector<Wait> cycle_through(const Entity& start) const {
    std::map<Entity, std::pair<Entity, Wait>> reached_from;
    std::deque<Entity> open{start};
    while (!open.empty()) {
      const Entity entity = open.front();
      open.pop_front();
      for (const Wait& wait : waits_.at(entity)) {
        if (!is_open(wait.target) || !reached_from.insert({wait.target, {entity, wait}}).second) {
          continue;
        }
        if (wait.target == start) {
          std::vector<Wait> steps;
          Entity at = start;
          do {
            steps.push_back(reached_from.at(at).second);
            at = reached_from.at(at).first;
          } while (at != start);
          std::reverse(steps.begin(), steps.end());
          return steps;
        }
        open.push_back(wait.target);
      }
    }
    return {};
  }

  std::string cycle_in_words() const {
    // Told from a source on, so that the steps between read "source grows from source".
    std::vector<Wait> shortest;
    Entity start;
    for (const SizeFunction& function : functions()) {
      for (const Entity& source : function.sources) {
        if (!is_open(source)) {
          continue;
        }
        const std::vector<Wait> steps = cycle_through(source);
        if (!steps.empty() && (shortest.empty() || steps.size() < shortest.size())) {
          shortest = steps;
          start = source;
        }
      }
    }
    TextStream text;
    text << "The size functions wait for each other: " << entity_name(start);
    const char* separator = " ";
    std::string via;
    for (const Wait& step : shortest) {
      if (step.function == Wait::boundary) {
        via = entity_name(step.target);
        continue;
      }
      if (step.function == Wait::master) {
        text << separator << "is a periodic copy of " << entity_name(step.target);
      } else {
        text << separator << "grows from " << entity_name(step.target) << " by "
             << function_name(functions()[step.function], step.function);
      }
      text << (via.empty() ? "" : " (at its " + via + ")");
      via.clear();
      separator = ", which ";
    }
    text << (via.empty() ? "" : ", which " + via + " bounds")
         << "; mesh one of them beforehand, attach less, or name them as sources of one function.";
    return text.str();
  }

  const MeshingTask& task_;
  int dim_;
  int stage_count_ = 0;
  std::map<Entity, std::vector<std::size_t>> acting_;
  std::map<Entity, std::vector<Wait>> waits_;  ///< of all that is not meshed yet
  std::set<Entity> done_;
  std::set<std::pair<std::size_t, Entity>> read_;
  std::vector<MeshingPass> passes_;
};

}  // namespace

std::set<Entity> closure_with_masters(std::vector<Entity> entities, const Topology& topology,
                                      const std::map<Entity, Entity>& masters) {
  std::set<Entity> result = topology.closure(entities);
  while (true) {
    for (const Entity& entity : result) {
      const auto master = masters.find(entity);
      if (master != masters.end()) {
        entities.push_back(master->second);
      }
    }
    std::set<Entity> wider = topology.closure(entities);
    if (wider.size() == result.size()) {
      return result;
    }
    result = std::move(wider);
  }
}

std::vector<MeshingPass> plan_meshing(const MeshingTask& task, int dim) {
  if (dim < 1 || dim > 3) {
    throw Error("Cannot mesh dimension " + std::to_string(dim) + ": give 1, 2 or 3.");
  }
  return Planner(task, dim).plan();
}

std::string plan_text(const std::vector<MeshingPass>& plan,
                      const std::vector<SizeFunction>& functions) {
  if (plan.empty()) {
    return "Nothing to mesh: everything has a mesh already.\n";
  }
  TextStream text;
  int number = 0;
  for (const MeshingPass& pass : plan) {
    text << "Pass " << ++number << ": dimension " << pass.dim << ", "
         << entity_names(pass.entities, 8) << '\n';
    if (!pass.attached) {
      text << "    Gmsh's own sizes\n";
      continue;
    }
    text << "    sizes from ";
    const char* separator = "";
    for (const std::size_t function : pass.functions) {
      text << separator << function_name(functions[function], function);
      separator = ", ";
    }
    text << '\n';
    if (!pass.sources.empty()) {
      text << "    reads " << entity_names(pass.sources, 8) << '\n';
    }
  }
  return text.str();
}

}  // namespace meshgrow
