#include "size_callback.h"

#include <algorithm>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "error.h"
#include "gmsh_api.h"
#include "gmsh_state.h"

namespace meshgrow {

namespace {

/// The slots that live, for each model, the one that Gmsh holds last; 4.8 holds one for all models.
std::map<std::string, std::vector<SizeCallback::Slot*>>& registered_slots() {
  static std::map<std::string, std::vector<SizeCallback::Slot*>> slots;
  return slots;
}

std::string key_of(const std::string& model) { return gmsh::is_4_8() ? "" : model; }

double answer_from(void* slot, int dim, int tag, double x, double y, double z, double proposed) {
  const SizeAnswers* answers = static_cast<const SizeCallback::Slot*>(slot)->answers;
  return answers == nullptr ? proposed : answers->answer(dim, tag, x, y, z, proposed);
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

/// The slots of this model whose objects live, without those that a finalized Gmsh left behind.
std::vector<SizeCallback::Slot*>& living_slots(const std::string& model) {
  std::vector<SizeCallback::Slot*>& slots = registered_slots()[key_of(model)];
  slots.erase(
      std::remove_if(slots.begin(), slots.end(),
                     [](const SizeCallback::Slot* slot) { return slot->answers == nullptr; }),
      slots.end());
  return slots;
}

void hand_to_gmsh(SizeCallback::Slot* slot) {
  const CurrentModel current(slot->model);
  gmsh::set_size_callback(callback_until_48, callback_since_49, slot);
}

}  // namespace

void SizeCallback::check_free_for(const std::string& model) {
  if (!gmsh::is_4_8()) {
    return;
  }
  const std::vector<std::string> models = gmsh::models();
  for (const Slot* slot : living_slots(model)) {
    if (slot->model != model && std::count(models.begin(), models.end(), slot->model) > 0) {
      throw Error("Gmsh 4.8 has one size callback for all models, and the field of model \"" +
                  slot->model + "\" is registered: unregister that one first.");
    }
  }
}

SizeCallback::SizeCallback(const SizeAnswers& answers, std::string model)
    : model_(std::move(model)) {
  auto slot = std::make_unique<Slot>();
  slot->answers = &answers;
  slot->model = model_;
  std::vector<Slot*>& slots = living_slots(model_);
  slots.reserve(slots.size() + 1);
  hand_to_gmsh(slot.get());
  slot_ = slot.release();
  slots.push_back(slot_);
}

SizeCallback::~SizeCallback() {
  slot_->answers = nullptr;
  try {
    const std::vector<Slot*>& all = registered_slots()[key_of(model_)];
    const bool is_held = !all.empty() && all.back() == slot_;
    const std::vector<Slot*>& slots = living_slots(model_);
    if (is_held && !slots.empty()) {
      hand_to_gmsh(slots.back());
    } else if (is_held) {
      const CurrentModel current(model_);
      gmsh::remove_size_callback();
    }
    delete slot_;
  } catch (...) {
    // Gmsh was finalized or the model removed. Gmsh 4.8 may call back all the same later on: the
    // empty slot stays for it.
  }
}

}  // namespace meshgrow
