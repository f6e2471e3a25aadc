#ifndef MESHGROW_C_GUARD_H
#define MESHGROW_C_GUARD_H

#include <cstddef>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include "c_field.h"
#include "entity.h"

/// What the functions of the C interface share.
namespace meshgrow::c {

constexpr const char* out_of_memory = "Out of memory: raise the tolerance or use fewer facets.";

/// The sentence of the last failure in this thread.
const char* last_error() noexcept;

/// Keeps a copy of the sentence; if there is no memory for one, `out_of_memory`.
void set_last_error(const char* sentence) noexcept;

/// Runs the body; its exceptions become the thread's last error and the result `failed`.
template <typename Result, typename Body>
Result guarded(Result failed, Body body) noexcept {
  try {
    set_last_error("");
    return body();
  } catch (const std::bad_alloc&) {
    set_last_error(out_of_memory);
  } catch (const std::length_error&) {  // more than there can ever be
    set_last_error(out_of_memory);
  } catch (const std::exception& error) {
    set_last_error(error.what());
  } catch (...) {
    set_last_error("An unknown error occurred.");
  }
  return failed;
}

/// For the caller, who gives it to meshgrow_free.
char* copy_text(const std::string& text);

void check_given(const void* pointer, const char* what);

/// Throws Error for a null pointer; `what` names it, such as "The name of a view".
template <typename T>
T* given(T* pointer, const char* what) {
  check_given(pointer, what);
  return pointer;
}

/// The same for an array, which may be null if it is empty.
template <typename T>
T* given(T* pointer, std::size_t count, const char* what) {
  return count == 0 ? pointer : given(pointer, what);
}

/// Of an array dim, tag, dim, tag, …. Throws Error if its length is odd.
std::vector<Entity> entities_of(const int* dim_tags, std::size_t count);

/// Throws Error for a null pointer.
ModelField& deref(meshgrow_field* field);

}  // namespace meshgrow::c

#endif
