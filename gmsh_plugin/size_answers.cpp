#include "size_answers.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include "calibration.h"
#include "gmsh_api.h"

namespace meshgrow {

namespace {

/// Whose user's sizes this thread is asking for.
thread_local const SizeAnswers* asking_user = nullptr;

/// Marks the thread for the life of this object.
class AskingUser {
 public:
  explicit AskingUser(const SizeAnswers* answers) : before_(std::exchange(asking_user, answers)) {}
  ~AskingUser() { asking_user = before_; }
  AskingUser(const AskingUser&) = delete;
  AskingUser& operator=(const AskingUser&) = delete;

 private:
  const SizeAnswers* before_;
};

bool is_size(double value) { return value > 0.0 && value < SizeField::no_size; }

/// Length of the segment whose middle is nearest.
double length_at(const std::vector<std::array<Vec3, 2>>& mesh, const Vec3& p) {
  double nearest = SizeField::no_size;
  double length = SizeField::no_size;
  for (const auto& [a, b] : mesh) {
    const double distance = (0.5 * (a + b) - p).squaredNorm();
    if (distance < nearest) {
      nearest = distance;
      length = (b - a).norm();
    }
  }
  return length;
}

}  // namespace

void SizeAnswers::set_scales(std::map<Entity, Scale> scales, const Range& range, double unit) {
  scales_ = std::move(scales);
  range_ = range;
  unit_ = unit;
}

void SizeAnswers::set_reader(std::function<void(int dim)> reader,
                             std::function<bool(const Entity& curve)> has_mesh) {
  reader_ = std::move(reader);
  has_mesh_ = std::move(has_mesh);
  highest_dim_ = 0;
}

void SizeAnswers::follow_run(const Entity& entity) const {
  if (entity.dim == highest_dim_ || entity.dim == 0) {
    return;
  }
  // Gmsh asks for curves while it meshes surfaces, too: those have a mesh by then.
  const std::unique_lock<std::shared_mutex> lock(mutex_);
  if (entity.dim > highest_dim_) {
    reader_(entity.dim);
    highest_dim_ = entity.dim;
  } else if (entity.dim == 1 && highest_dim_ > 1 && !has_mesh_(entity)) {
    reader_(1);
    highest_dim_ = 1;
  }
}

bool SizeAnswers::is_asking_user() const { return asking_user == this; }

double SizeAnswers::calibrated(int dim, const Vec3& p, double size) const {
  if (!algorithms_ || !is_size(size)) {
    return size;
  }
  const int algorithm = algorithms_->at(static_cast<std::size_t>(dim));
  const double factor =
      dim == 3 && boundary_
          ? calibration_factor(dim, algorithm, (*boundary_)(p, calibration_depth * size) / size)
          : calibration_factor(dim, algorithm);
  return factor * size;
}

double SizeAnswers::combined(const Entity& entity, double x, double y, double z,
                             double proposed) const {
  double result = proposed;
  const Vec3 p(x, y, z);
  const double size = calibrated(entity.dim, p, field_.size(entity, p));
  if (is_size(size) && size < result) {
    result = size;
  }
  if (user_sizes_ && !is_asking_user()) {
    const AskingUser asking(this);
    const double users = user_sizes_(entity.dim, entity.tag, x, y, z, result);
    if (is_size(users) && users < result) {
      result = users;
    }
  }
  return result;
}

double SizeAnswers::scaled(const Scale& scale, const Entity& entity, double x, double y, double z,
                           double proposed) const {
  const double wanted = combined(entity, x, y, z, SizeField::no_size);
  const double size = is_size(wanted) ? range_.factor * std::clamp(wanted, range_.min, range_.max)
                                      : length_at(scale.mesh, Vec3(x, y, z));
  return is_size(size) ? scale.factor * size / unit_ : proposed;
}

double SizeAnswers::answer(int dim, int tag, double x, double y, double z,
                           double proposed) const noexcept {
  if (dim < 0 || dim > 3) {
    return proposed;
  }
  try {
    Entity entity{dim, tag};
    if (tag > gmsh::compound_offset && !field_.topology().contains(entity)) {
      entity.tag -= gmsh::compound_offset;  // a compound has the sizes of its first part
    }
    if (!scales_.empty()) {
      const auto scale = scales_.find(entity);
      return scale == scales_.end() ? combined(entity, x, y, z, proposed)
                                    : scaled(scale->second, entity, x, y, z, proposed);
    }
    if (!reader_ || is_asking_user()) {  // who asks holds the lock
      return combined(entity, x, y, z, proposed);
    }
    follow_run(entity);
    const std::shared_lock<std::shared_mutex> lock(mutex_);
    return combined(entity, x, y, z, proposed);
  } catch (const std::exception& error) {
    tell_problem(error.what());
    return proposed;
  } catch (...) {
    return proposed;
  }
}

void SizeAnswers::tell_problem(const char* sentence) const noexcept {
  if (has_told_problem_.exchange(true)) {
    return;
  }
  try {
    gmsh::log(std::string("The size field cannot answer: ") + sentence, "warning");
  } catch (...) {
    // Nobody is left to tell.
  }
}

}  // namespace meshgrow
