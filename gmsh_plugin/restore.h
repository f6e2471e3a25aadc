#ifndef MESHGROW_RESTORE_H
#define MESHGROW_RESTORE_H

namespace meshgrow {

/// Does what restores something, a second time if it fails, and throws nothing: for destructors,
/// and where an error is passing already. Nobody else could restore it later.
template <typename Action>
void restore(const Action& action) noexcept {
  for (int attempt = 0; attempt < 2; ++attempt) {
    try {
      action();
      return;
    } catch (...) {
      // Gmsh refused it, or was finalized meanwhile, and nothing is left to restore.
    }
  }
}

}  // namespace meshgrow

#endif
