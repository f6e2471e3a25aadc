#ifndef MESHGROW_C_GUARD_H
#define MESHGROW_C_GUARD_H

#include <cstddef>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "c_field.h"
#include "entity.h"

/// What the functions of the C interface share.
namespace meshgrow::c {

/// The sentence of the last failure in this thread.
std::string& last_error();

/// Runs the body; its exceptions become the thread's last error and the result `failed`.
template <typename Result, typename Body>
Result guarded(Result failed, Body body) noexcept {
  try {
    last_error().clear();
    return body();
  } catch (const std::bad_alloc&) {
    last_error() = "Out of memory: raise the tolerance or use fewer facets.";
  } catch (const std::exception& error) {
    last_error() = error.what();
  } catch (...) {
    last_error() = "An unknown error occurred.";
  }
  return failed;
}

/// For the caller, who gives it to meshgrow_free.
char* copy_text(const std::string& text);

/// Of an array dim, tag, dim, tag, …. Throws Error if its length is odd.
std::vector<Entity> entities_of(const int* dim_tags, std::size_t count);

/// Throws Error for a null pointer.
ModelField& deref(meshgrow_field* field);

}  // namespace meshgrow::c

#endif
