#include "opened_field.h"

#include <iostream>

#include "c_field.h"
#include "field_file.h"
#include "model_file.h"
#include "usage_error.h"

namespace meshgrow::cli {

OpenedField::OpenedField(const std::string& path, const FieldArguments& arguments, int mesh_dim) {
  if (is_field_file(path)) {
    check_no_field_options(path, arguments);
    if (mesh_dim > 0) {
      throw UsageError(path + " is a saved size field and no model: leave out -1, -2 and -3.");
    }
    field_.reset(meshgrow_field_load(path.c_str()));
    check(field_ ? 0 : 1);
    return;
  }
  const std::vector<std::string> texts = size_function_texts(arguments);
  session_.emplace();
  open_model(path);
  if (!has_size_functions(arguments, texts)) {
    throw UsageError("No size function is given for " + path +
                     ": give some by --size-function, --size-functions or --defaults.");
  }
  field_ = make_field(arguments, texts);
  check(meshgrow_field_set_progress(
      field_.get(),
      [](const char* line, void*) {
        std::cerr << line << std::endl;
        return 0;
      },
      nullptr));
  if (mesh_dim > 0) {
    check(meshgrow_field_generate(field_.get(), mesh_dim, 0));
  }
  check(meshgrow_field_refresh(field_.get()));
}

const SizeField& OpenedField::field() const { return field_->model_field.field(); }

}  // namespace meshgrow::cli
