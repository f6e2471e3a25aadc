#include "size_callback.h"

#include <utility>

#include "gmsh_api.h"
#include "gmsh_state.h"

namespace meshgrow {

namespace {

/// What Gmsh itself takes for "no size".
constexpr double gmsh_no_size = 1e22;

double callback_until_48(int dim, int tag, double x, double y, double z, void* field) {
  // 4.8 takes the minimum of all its sizes and this answer by itself.
  return answer_size(*static_cast<const SizeField*>(field), dim, tag, x, y, z, gmsh_no_size);
}

double callback_since_49(int dim, int tag, double x, double y, double z, double proposed,
                         void* field) {
  return answer_size(*static_cast<const SizeField*>(field), dim, tag, x, y, z, proposed);
}

}  // namespace

double answer_size(const SizeField& field, int dim, int tag, double x, double y, double z,
                   double proposed) noexcept {
  try {
    const double size = field.size({dim, tag}, Vec3(x, y, z));
    return size > 0.0 && size < proposed ? size : proposed;
  } catch (...) {
    return proposed;
  }
}

SizeCallback::SizeCallback(const SizeField& field, std::string model) : model_(std::move(model)) {
  const CurrentModel current(model_);
  gmsh::set_size_callback(callback_until_48, callback_since_49, const_cast<SizeField*>(&field));
}

SizeCallback::~SizeCallback() {
  try {
    const CurrentModel current(model_);
    gmsh::remove_size_callback();
  } catch (...) {
    // Gmsh was finalized or the model removed: the callback is gone with it.
  }
}

}  // namespace meshgrow
