#include "size_callback.h"

#include <map>
#include <memory>
#include <utility>

#include "gmsh_api.h"
#include "gmsh_state.h"

namespace meshgrow {

namespace {

/// What Gmsh itself takes for "no size".
constexpr double gmsh_no_size = 1e22;

/// The slot that Gmsh holds for a model; 4.8 holds one for all models.
std::map<std::string, SizeCallback::Slot*>& registered_slots() {
  static std::map<std::string, SizeCallback::Slot*> slots;
  return slots;
}

std::string key_of(const std::string& model) {
  const gmsh::Version version = gmsh::require_gmsh();
  return version.major == 4 && version.minor == 8 ? "" : model;
}

double answer_from(void* slot, int dim, int tag, double x, double y, double z, double proposed) {
  const SizeField* field = static_cast<const SizeCallback::Slot*>(slot)->field;
  return field == nullptr ? proposed : answer_size(*field, dim, tag, x, y, z, proposed);
}

double callback_until_48(int dim, int tag, double x, double y, double z, void* slot) {
  // 4.8 takes the minimum of all its sizes and this answer by itself. It has one callback for all
  // models, so the current one may be another.
  try {
    if (gmsh::current_model() != static_cast<const SizeCallback::Slot*>(slot)->model) {
      return gmsh_no_size;
    }
  } catch (...) {
    return gmsh_no_size;
  }
  return answer_from(slot, dim, tag, x, y, z, gmsh_no_size);
}

double callback_since_49(int dim, int tag, double x, double y, double z, double proposed,
                         void* slot) {
  return answer_from(slot, dim, tag, x, y, z, proposed);
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
  auto slot = std::make_unique<Slot>();
  slot->field = &field;
  slot->model = model_;
  gmsh::set_size_callback(callback_until_48, callback_since_49, slot.get());
  slot_ = slot.release();
  registered_slots()[key_of(model_)] = slot_;
}

SizeCallback::~SizeCallback() {
  slot_->field = nullptr;
  try {
    Slot*& registered = registered_slots()[key_of(model_)];
    if (registered == slot_) {
      const CurrentModel current(model_);
      gmsh::remove_size_callback();
      registered = nullptr;
    }
    delete slot_;
  } catch (...) {
    // Gmsh was finalized or the model removed. Gmsh 4.8 may call back all the same later on: the
    // empty slot stays for it.
  }
}

}  // namespace meshgrow
