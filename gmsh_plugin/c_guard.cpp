#include "c_guard.h"

#include <cstdlib>
#include <cstring>

#include "error.h"

namespace meshgrow::c {

namespace {

struct LastError {
  std::string text;
  const char* sentence = "";  ///< that of the text, or a fixed one
};

LastError& of_this_thread() noexcept {
  thread_local LastError error;
  return error;
}

}  // namespace

const char* last_error() noexcept { return of_this_thread().sentence; }

void set_last_error(const char* sentence) noexcept {
  LastError& error = of_this_thread();
  try {
    error.text = sentence;
    error.sentence = error.text.c_str();
  } catch (...) {
    error.sentence = out_of_memory;
  }
}

void check_given(const void* pointer, const char* what) {
  if (pointer == nullptr) {
    throw Error(std::string(what) + " is a null pointer: give one.");
  }
}

char* copy_text(const std::string& text) {
  char* copy = static_cast<char*>(std::malloc(text.size() + 1));
  if (copy == nullptr) {
    throw std::bad_alloc();
  }
  std::memcpy(copy, text.c_str(), text.size() + 1);
  return copy;
}

std::vector<Entity> entities_of(const int* dim_tags, size_t count) {
  if (count % 2 != 0) {
    throw Error("A list of entities has an odd number of ints: give pairs of dimension and tag.");
  }
  given(dim_tags, count, "A list of entities");
  std::vector<Entity> result;
  for (size_t i = 0; i < count; i += 2) {
    result.push_back({dim_tags[i], dim_tags[i + 1]});
  }
  return result;
}

ModelField& deref(meshgrow_field* field) {
  if (field == nullptr) {
    throw Error("There is no size field: create one first.");
  }
  return field->model_field;
}

}  // namespace meshgrow::c
