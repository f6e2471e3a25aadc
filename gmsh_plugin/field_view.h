#ifndef MESHGROW_FIELD_VIEW_H
#define MESHGROW_FIELD_VIEW_H

#include <optional>
#include <string>

#include "model_field.h"

namespace meshgrow {

enum class ViewKind {
  cells,  ///< of the background grid, as hexahedra
  plane,  ///< a plane cut, as quadrangles
  mesh    ///< the nodes of the mesh that the model has
};

/// "cells", "plane" or "mesh". Throws Error for anything else.
ViewKind view_kind(const std::string& name);

struct CutPlane {
  Vec3 point;
  Vec3 normal;  ///< of any length
};

struct ViewRequest {
  std::string name = "sizes";
  ViewKind kind = ViewKind::cells;
  /// Whose field it is; without one, the smallest size that any group asks for.
  std::optional<Entity> entity;
  /// Of a plane view: by default through the middle of the box of the entity (or model), square to
  /// its shortest side, to z where sides are equal.
  std::optional<CutPlane> plane;
  /// Of a plane view: so many squares along the longer side, divided further where sizes bend.
  int resolution = 32;
};

/// Puts the field into Gmsh as a post-processing view and returns the view's tag. Reads the sources
/// if that was not done yet; the field stays as it is. Throws Error where there is nothing to show;
/// no view is left behind then. Not thread-safe.
int add_view(ModelField& model_field, const ViewRequest& request);

/// Writes the field into a file that other programs read: .vtu (ParaView), .pos and .msh (Gmsh), by
/// its ending; see field_files.h. The file is there completely, or as before. Returns how many
/// cells it holds.
std::size_t write_view(ModelField& model_field, const std::optional<Entity>& entity,
                       const std::string& path);

/// Throws Error unless `path` has one of these endings.
void check_view_ending(const std::string& path);

}  // namespace meshgrow

#endif
