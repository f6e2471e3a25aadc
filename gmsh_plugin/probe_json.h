#ifndef MESHGROW_PROBE_JSON_H
#define MESHGROW_PROBE_JSON_H

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "size_field.h"

namespace meshgrow {

/// Tag of the element in the mesh of a curve or surface of the current model that has all corners
/// of the facet, to the bit; nothing if there is none, as where a facet was made from the geometry.
std::optional<std::size_t> element_of_facet(const Entity& entity, const Facet& facet);

/// What decides the size at p (probe.h):
///
///     {"entity": [3, 2], "point": [x, y, z], "size": 0.2, "exact_size": 0.2,
///      "interpolated_size": null, "rule": "facet",
///      "function": {"index": 0, "name": "Mesh size function 1", "kind": "mesh", "text": "mesh …"},
///      "facet": {"entity": [2, 7], "element": 123, "corners": [[x, y, z], …], "start_size": 0.1,
///                "growth_rate": 1.2, "slope": 0.1667, "distance": 0.6}}
///
/// "rule" is "facet", "limit", "inside source" or "nothing"; what is not known or does not apply is
/// null. With `in_model`, elements are looked up in the current model.
nlohmann::json probe_json(const SizeField& field, const Probe& probe, const Vec3& p, bool in_model);

/// The same for people, some lines, from this JSON.
std::string probe_text(const nlohmann::json& probe);

}  // namespace meshgrow

#endif
