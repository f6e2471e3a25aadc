#ifndef MESHGROW_SIZE_FUNCTION_H
#define MESHGROW_SIZE_FUNCTION_H

#include <string>
#include <vector>

#include "entity.h"
#include "sized_facets.h"
#include "topology.h"

namespace meshgrow {

/// What the start sizes on the sources come from (paper, sections 2 and 3). Curvature and proximity
/// will join here: the kinds differ in nothing but their start sizes.
enum class Kind {
  mesh,  ///< the mesh that is already on the sources
  fixed  ///< one given size
};

/// "mesh", "fixed".
std::string kind_name(Kind kind);

/// One definition of a size function (paper, section 2).
struct SizeFunction {
  Kind kind = Kind::mesh;
  std::vector<Entity> sources;      ///< mesh: curves, surfaces; fixed: also points and volumes
  std::vector<Entity> attachments;  ///< curves, surfaces, volumes; acts on their boundaries as well
  double growth_rate = 1.2;  ///< each layer of elements is so many times the one before, ≥ 1
  double size_limit = 0.0;   ///< largest size asked for, model units, > 0
  double start_size = 0.0;   ///< fixed: size on the sources, model units, > 0
  QuadSize quad_size = QuadSize::triangles;  ///< mesh: how quadrilaterals are sized
};

/// "Mesh size function 1", as messages name the function with this index.
std::string function_name(const SizeFunction& function, std::size_t index);

/// Throws Error with one sentence, beginning with `name`, unless the parameters are usable, all
/// entities are in the model, and no source of a mesh size function is its own attachment.
void validate(const SizeFunction& function, const std::string& name, const Topology& topology);

}  // namespace meshgrow

#endif
