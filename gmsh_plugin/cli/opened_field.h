#ifndef MESHGROW_CLI_OPENED_FIELD_H
#define MESHGROW_CLI_OPENED_FIELD_H

#include <optional>
#include <string>

#include "field_arguments.h"
#include "gmsh_session.h"
#include "size_field.h"

namespace meshgrow::cli {

/// A size field from a file, ready to answer, for as long as this object lives: from a saved field,
/// or from a model or mesh whose size functions the arguments tell, or it itself.
class OpenedField {
 public:
  /// Sources without a mesh are warned of by Gmsh's log; with `mesh_dim` > 0, the model is meshed
  /// up to this dimension first. Progress goes to standard error. Throws Error.
  OpenedField(const std::string& path, const FieldArguments& arguments, int mesh_dim = 0);

  const SizeField& field() const;
  /// Whether Gmsh has the model that the field is of.
  bool has_model() const { return session_.has_value(); }

 private:
  std::optional<GmshSession> session_;
  FieldPointer field_;
};

}  // namespace meshgrow::cli

#endif
