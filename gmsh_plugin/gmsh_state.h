#ifndef MESHGROW_GMSH_STATE_H
#define MESHGROW_GMSH_STATE_H

#include <map>
#include <string>
#include <vector>

#include "entity.h"

namespace meshgrow {

/// Makes a model current for the life of this object, then the one that was.
class CurrentModel {
 public:
  /// Throws Error if Gmsh was finalized or there is no such model any more.
  explicit CurrentModel(const std::string& name);
  ~CurrentModel();
  CurrentModel(const CurrentModel&) = delete;
  CurrentModel& operator=(const CurrentModel&) = delete;

 private:
  std::string before_;
};

/// Changes Gmsh's options and the visibility of entities for the life of this object and restores
/// them at its end, also when an exception passes.
class GmshState {
 public:
  GmshState() = default;
  ~GmshState();
  GmshState(const GmshState&) = delete;
  GmshState& operator=(const GmshState&) = delete;

  void set_option(const std::string& name, double value);
  /// The user's value of an option, changed here or not.
  double user_option(const std::string& name) const;

  /// Makes exactly these entities of `all` visible.
  void show_only(const std::vector<Entity>& shown, const std::vector<Entity>& all);

 private:
  std::map<std::string, double> options_;
  std::map<Entity, bool> visibility_;
};

}  // namespace meshgrow

#endif
