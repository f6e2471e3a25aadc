#ifndef MESHGROW_SIZE_CALLBACK_H
#define MESHGROW_SIZE_CALLBACK_H

#include <atomic>
#include <string>

#include "size_field.h"

namespace meshgrow {

/// What Gmsh is told on a question for the entity (dim, tag) at (x, y, z), where it proposes the
/// size `proposed`: the smaller of the proposal and the field's size; the proposal itself where no
/// function acts and for anything unusual (an unknown dimension, a point that is not finite). Never
/// throws; may be called from any thread while the field is not being changed.
double answer_size(const SizeField& field, int dim, int tag, double x, double y, double z,
                   double proposed) noexcept;

/// Registers a field as the size callback of a Gmsh model for the life of this object (of
/// all models, in Gmsh 4.8). There is one size callback in Gmsh at a time: a second registration
/// replaces the first, and one that the user set before is gone (Gmsh cannot be asked for it).
class SizeCallback {
 public:
  SizeCallback(const SizeField& field, std::string model);
  ~SizeCallback();
  SizeCallback(const SizeCallback&) = delete;
  SizeCallback& operator=(const SizeCallback&) = delete;

  /// What Gmsh holds a pointer to.
  struct Slot {
    std::atomic<const SizeField*> field{nullptr};
    std::string model;
  };

 private:
  std::string model_;
  Slot* slot_;  ///< owned while Gmsh can be told to forget it, else left to Gmsh, empty
};

}  // namespace meshgrow

#endif
