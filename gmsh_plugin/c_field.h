#ifndef MESHGROW_C_FIELD_H
#define MESHGROW_C_FIELD_H

#include <string>

#include "meshgrow.h"
#include "model_field.h"

/// What the C interface's handle points to.
struct meshgrow_field {
  meshgrow_field() = default;
  explicit meshgrow_field(const char* file) : model_field(std::string(file)) {}

  meshgrow::ModelField model_field;
};

#endif
