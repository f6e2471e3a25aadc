// What a ModelField tells of its work, and how it is asked to stop.

#include <iostream>

#include "error.h"
#include "gmsh_api.h"
#include "model_field.h"
#include "simd/refused_kernels.h"

namespace meshgrow {

/// A field from a file may be used without any Gmsh.
void ModelField::warn(const std::string& sentence) const {
  try {
    gmsh::require_gmsh();
    gmsh::log(sentence, "warning");
  } catch (const Error&) {
    if (listener_) {
      listener_("Warning: " + sentence);
    } else {
      std::cerr << "meshgrow: " << sentence << std::endl;
    }
  }
}

/// Once for each process.
void ModelField::warn_of_refused_kernels() const {
  static const std::string refused = simd::refused_kernels();
  static bool has_warned = false;
  if (!refused.empty() && !has_warned) {
    has_warned = true;
    warn("MESHGROW_SIMD is \"" + refused +
         "\", which is nothing that this processor runs, and is ignored: set it to plain, avx2 or "
         "avx512, or unset it.");
  }
}

void ModelField::stop_if_asked() const {
  if (wants_stop_ && wants_stop_()) {
    throw Error("Stopped as asked; what was meshed before is kept.");
  }
}

void ModelField::tell(const std::string& line) const {
  stop_if_asked();
  if (listener_) {
    listener_(line);
  } else {
    gmsh::log("Meshgrow: " + line);
  }
}

void ModelField::tell_grid(const std::string& what, double done) {
  stop_if_asked();
  const auto now = std::chrono::steady_clock::now();
  if (what != grid_told_of_) {
    grid_told_of_ = what;
    grid_told_at_ = now;
  }
  if (done == 1.0) {
    tell(what + ": done");
    grid_told_of_.clear();
  } else if (now - grid_told_at_ > std::chrono::seconds(1)) {
    tell(what + ": " + std::to_string(static_cast<int>(100.0 * done)) + " %");
    grid_told_at_ = now;
  }
}

}  // namespace meshgrow
