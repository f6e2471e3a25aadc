#ifndef MESHGROW_FIELD_FILES_H
#define MESHGROW_FIELD_FILES_H

#include <ostream>
#include <string>

#include "field_cells.h"

namespace meshgrow {

// Size fields as files of other programs. Numbers are binary, in the byte order of the machine,
// which the files tell. Thread-safe.

/// VTK's XML format of unstructured grids, for ParaView: hexahedra that share nodes; at the nodes
/// "size", in the cells "depth", "exact" (0 or 1) and "group" (from 1).
void write_vtu(const FieldCells& cells, std::ostream& file);

/// Gmsh's format 1.4 of post-processing views: hexahedra, each with sizes of its own. Merged into
/// any model, it can be its background field.
void write_pos(const FieldCells& cells, const std::string& name, std::ostream& file);

/// Gmsh's format 4.1 of meshes: hexahedra that share nodes, and a view of the sizes of each at
/// them. To be opened by itself: merged into a model, it would add a mesh to it.
void write_msh(const FieldCells& cells, const std::string& name, std::ostream& file);

}  // namespace meshgrow

#endif
