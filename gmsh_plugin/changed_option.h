#ifndef MESHGROW_CHANGED_OPTION_H
#define MESHGROW_CHANGED_OPTION_H

#include "gmsh_api.h"
#include "restore.h"

namespace meshgrow::gmsh {

/// Changes an option for the life of this object.
class ChangedOption {
 public:
  ChangedOption(const char* name, double value) : name_(name), before_(option(name)) {
    set_option(name_, value);
  }
  ~ChangedOption() {
    restore([this] { set_option(name_, before_); });
  }
  ChangedOption(const ChangedOption&) = delete;
  ChangedOption& operator=(const ChangedOption&) = delete;

 private:
  const char* name_;
  double before_;
};

/// Keeps what Gmsh says out of the user's log.
class Silence : ChangedOption {
 public:
  Silence() : ChangedOption("General.Verbosity", 0.0) {}
};

}  // namespace meshgrow::gmsh

#endif
