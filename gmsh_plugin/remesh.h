#ifndef MESHGROW_REMESH_H
#define MESHGROW_REMESH_H

#include <set>

#include "size_field.h"

namespace meshgrow {

/// What has a mesh in the current model and keeps it when all else is to be meshed again: sources
/// of mesh size functions, with what bounds them and, of periodic copies, their masters; discrete
/// entities, which would be nothing without.
std::set<Entity> kept_when_meshing_again(const SizeField& field);

/// Takes away the mesh of all other entities.
void clear_all_but(const std::set<Entity>& kept, const SizeField& field);

}  // namespace meshgrow

#endif
