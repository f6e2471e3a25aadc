#ifndef MESHGROW_SIZE_FUNCTION_TEXT_H
#define MESHGROW_SIZE_FUNCTION_TEXT_H

#include <string>
#include <vector>

#include "size_function.h"
#include "topology.h"

namespace meshgrow {

/// Reads the one-line text of a size function (DESIGN.md, section 4), for example
///
///     mesh  source Surface{7}   attach Volume{2}                 growth 1.2 limit 2
///     fixed source Curve{1,4:6} attach Physical Surface{"inlet"} size 0.1 growth 1.2 limit 2
///     curvature source Surface{:} attach Volume{1} angle 18 growth 1.2 limit 2 min 0.01
///     proximity source Volume{1}  attach Volume{1} cells 3 between both growth 1.2 limit 2
///
/// Besides `quad_size triangles` or `sides` (mesh), `angle` in degrees (curvature, default 18),
/// `cells` per gap (proximity, default 3), `between faces`, `edges` or `both` (proximity) and `min`
/// (curvature, proximity) may be left out. `name inner` or `name "inner wall"` names the function.
///
/// Entities are written as in .geo: Point, Curve (or Line), Surface, Volume with tags, ranges a:b,
/// or : for all; Physical before them takes physical tags and names (quotes may be left out). After
/// `source` and `attach` several such selections may stand, separated by commas.
///
/// Throws Error that tells the position (counted from 1) and what was expected there, and for
/// entities or physical groups that are not in the model. Thread-safe.
SizeFunction parse_size_function(const std::string& text, const Topology& topology);

/// The line of text that reads as this function, in the same numbers to the bit; without the name
/// if the field gave it. Entities are sorted, each once, so that what is read is written the same.
/// Thread-safe.
std::string size_function_text(const SizeFunction& function);

/// Reads entities alone, such as `Volume{2}, Physical Surface{"inlet"}`; sorted, each once.
std::vector<Entity> parse_entities(const std::string& text, const Topology& topology);

}  // namespace meshgrow

#endif
