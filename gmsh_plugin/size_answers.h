#ifndef MESHGROW_SIZE_ANSWERS_H
#define MESHGROW_SIZE_ANSWERS_H

#include <array>
#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <shared_mutex>
#include <vector>

#include "boundary_distance.h"
#include "size_field.h"

namespace meshgrow {

/// What Gmsh itself takes for "no size".
constexpr double gmsh_no_size = 1e22;

/// A user's own sizes: (dim, tag, x, y, z, size so far) -> size, called from several threads.
using UserSizes = std::function<double(int, int, double, double, double, double)>;

/// What Gmsh is told when it asks for sizes: the field's size where functions act, made smaller by
/// the user's own sizes, and corrected where Gmsh needs it.
///
/// Thread safety: `answer` may be called from any thread at any time between the calls of other
/// functions, also by the user's own sizes, which are left out then; it never throws.
class SizeAnswers {
 public:
  explicit SizeAnswers(const SizeField& field) : field_(field) {}
  SizeAnswers(const SizeAnswers&) = delete;
  SizeAnswers& operator=(const SizeAnswers&) = delete;

  /// The size on the entity (dim, tag) at (x, y, z), where Gmsh proposes `proposed`: the smaller of
  /// the proposal, the field's and the user's size; the proposal itself for anything unusual (an
  /// unknown dimension, a point that is not finite), or if a part of a saved field is damaged, of
  /// which Gmsh's log warns.
  double answer(int dim, int tag, double x, double y, double z, double proposed) const noexcept;

  /// The user's own sizes beside the field; none if empty.
  void combine(UserSizes sizes) { user_sizes_ = std::move(sizes); }

  /// Multiplies the field's sizes by measured factors (calibration.h) for these meshers: Gmsh's
  /// numbers by dimension. None, without the argument.
  void calibrate(const std::optional<std::array<int, 4>>& algorithms) { algorithms_ = algorithms; }
  bool is_calibrated() const { return algorithms_.has_value(); }
  /// The boundary of the volumes that are meshed next, for the factors beside it; none if null.
  void set_boundary(std::unique_ptr<const BoundaryDistance> boundary) {
    boundary_ = std::move(boundary);
  }

  /// How much longer than asked the elements of a curve, or at a point at its end, are to be.
  /// `mesh` is a mesh of it by Gmsh's own sizes, which are scaled where neither field nor user has
  /// any.
  struct Scale {
    double factor = 1.0;
    std::vector<std::array<Vec3, 2>> mesh;
  };

  /// What Gmsh does to all sizes: Mesh.MeshSizeMin, Max and Factor of the user.
  struct Range {
    double min = 0.0;
    double max = 1e22;
    double factor = 1.0;
  };

  /// Answers for these entities scaled, in units of `unit`, with the user's range already applied:
  /// Gmsh with Mesh.MeshSizeFactor = `unit` and no range of its own obeys them to the letter.
  void set_scales(std::map<Entity, Scale> scales, const Range& range, double unit);
  void clear_scales() { scales_.clear(); }

  /// Called, under a lock, before the first answer in a dimension higher than all before in one run
  /// of Gmsh; may change the field. A question for a curve that has no mesh after one of a higher
  /// dimension begins another run; `has_mesh` tells that.
  void set_reader(std::function<void(int dim)> reader,
                  std::function<bool(const Entity& curve)> has_mesh);

  /// Whether this thread is within the user's own sizes, asked for an answer.
  bool is_asking_user() const;

  /// Held while the field is asked, and exclusively while it changes, as long as there is a reader.
  std::shared_mutex& mutex() const { return mutex_; }

 private:
  /// The first one, as a warning in Gmsh's log.
  void tell_problem(const char* sentence) const noexcept;
  double calibrated(int dim, const Vec3& p, double size) const;
  double combined(const Entity& entity, double x, double y, double z, double proposed) const;
  double scaled(const Scale& scale, const Entity& entity, double x, double y, double z,
                double proposed) const;
  void follow_run(const Entity& entity) const;

  const SizeField& field_;
  UserSizes user_sizes_;
  std::optional<std::array<int, 4>> algorithms_;
  std::unique_ptr<const BoundaryDistance> boundary_;
  std::map<Entity, Scale> scales_;
  Range range_;
  double unit_ = 1.0;
  std::function<void(int)> reader_;
  std::function<bool(const Entity&)> has_mesh_;
  mutable std::atomic<bool> has_told_problem_{false};
  mutable std::atomic<int> highest_dim_{0};
  mutable std::shared_mutex mutex_;
};

}  // namespace meshgrow

#endif
