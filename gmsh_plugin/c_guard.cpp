#include "c_guard.h"

#include <cstdlib>
#include <cstring>

#include "error.h"

namespace meshgrow::c {

std::string& last_error() {
  thread_local std::string sentence;
  return sentence;
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
