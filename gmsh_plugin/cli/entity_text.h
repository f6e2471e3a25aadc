#ifndef MESHGROW_CLI_ENTITY_TEXT_H
#define MESHGROW_CLI_ENTITY_TEXT_H

#include <string>

#include "entity.h"
#include "geometry.h"
#include "topology.h"

namespace meshgrow::cli {

/// "3,2", as on the command line. Throws Error unless the entity is in the model.
Entity read_entity(const std::string& text, const Topology& topology);

/// "0.5,1,-2e-3". Throws Error unless these are three finite numbers.
Vec3 read_point(const std::string& text);

}  // namespace meshgrow::cli

#endif
