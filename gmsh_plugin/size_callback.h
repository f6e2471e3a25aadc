#ifndef MESHGROW_SIZE_CALLBACK_H
#define MESHGROW_SIZE_CALLBACK_H

#include <atomic>
#include <string>

#include "size_answers.h"

namespace meshgrow {

/// Registers sizes as the size callback of a Gmsh model for the life of this object (of all models,
/// in Gmsh 4.8). There is one size callback in Gmsh at a time: a second object stands in for the
/// first while it lives, and a callback that the user set before is gone (Gmsh cannot be asked for
/// it).
class SizeCallback {
 public:
  SizeCallback(const SizeAnswers& answers, std::string model);
  ~SizeCallback();
  SizeCallback(const SizeCallback&) = delete;
  SizeCallback& operator=(const SizeCallback&) = delete;

  /// Throws Error if Gmsh has one size callback for all models and the field of another model has
  /// it.
  static void check_free_for(const std::string& model);

  /// What Gmsh holds a pointer to.
  struct Slot {
    std::atomic<const SizeAnswers*> answers{nullptr};
    std::string model;
  };

 private:
  std::string model_;
  Slot* slot_;  ///< owned while Gmsh can be told to forget it, else left to Gmsh, empty
};

}  // namespace meshgrow

#endif
