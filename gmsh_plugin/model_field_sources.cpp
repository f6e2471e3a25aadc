// How a ModelField reads its sources out of the model.

#include <algorithm>

#include "error.h"
#include "geometry_sampler.h"
#include "gmsh_api.h"
#include "gmsh_state.h"
#include "mesh_fingerprint.h"
#include "model_field.h"
#include "model_reader.h"
#include "number_text.h"

namespace meshgrow {

namespace {

/// Whether a function takes the sizes of a source's mesh itself.
bool is_read_as_meshed(const SizeFunction& function, const Entity& source) {
  return function.kind == Kind::mesh && (source.dim == 1 || source.dim == 2);
}

}  // namespace

void ModelField::keep_meshed_sources(std::size_t first_function) {
  try {
    const CurrentModel current(model_);
    for (std::size_t i = first_function; i < field_.functions().size(); ++i) {
      for (const Entity& source : field_.functions()[i].sources) {
        if (is_read_as_meshed(field_.functions()[i], source) && kept_.count(source) == 0 &&
            gmsh::has_elements(source) && !gmsh::is_discrete(source)) {
          kept_[source] =
              read_entity_mesh(source, NodeCoordinates(field_.topology().closure({source})));
        }
      }
    }
    is_keeping_ = true;
  } catch (const Error&) {
    // Whoever reads the sources in earnest tells what is wrong with them.
  }
}

void ModelField::forget_kept_sources() {
  kept_.clear();
  is_keeping_ = false;
}

std::vector<FacetedSource> ModelField::read_meshed(std::size_t function,
                                                   const NodeCoordinates& nodes) const {
  std::vector<FacetedSource> result;
  for (const Entity& source : field_.functions()[function].sources) {
    if (source.dim != 1 && source.dim != 2) {
      continue;
    }
    if (gmsh::has_elements(source)) {
      result.push_back(read_entity_mesh(source, nodes));
    } else if (const auto kept = kept_.find(source); kept != kept_.end()) {
      result.push_back(kept->second);
    }
  }
  return result;
}

void ModelField::set_sources(std::size_t function, const std::vector<FacetedSource>& sources) {
  const DroppedFacets dropped = field_.set_sources(function, sources, size_factor_);
  if (dropped.zero_size + dropped.not_finite > 0) {
    gmsh::log(field_.function_name(function) + ": " +
                  grouped_digits(dropped.zero_size + dropped.not_finite) +
                  " elements of its sources have no size or no finite coordinates and are left "
                  "out: check the mesh of " +
                  entity_names(field_.functions()[function].sources) + ".",
              "warning");
  }
}

void ModelField::read_sources(const std::vector<std::size_t>& functions) {
  if (functions.empty()) {
    return;
  }
  size_factor_ = gmsh::option("Mesh.MeshSizeFactor");
  const NodeCoordinates nodes;
  SourceFacets facets(field_.topology(), nodes);
  MeshFingerprints fingerprints;
  for (const std::size_t index : functions) {
    // Until it is read to the end it counts as not read.
    read_as_.erase(index);
    std::map<Entity, std::uint64_t> read_as;
    for (const Entity& entity : watched(index)) {
      read_as[entity] = fingerprints.of(entity);
    }
    switch (field_.functions()[index].kind) {
      case Kind::mesh:
        set_sources(index, read_meshed(index, nodes));
        break;
      case Kind::fixed:
        set_sources(index, read_fixed(index, nodes));
        break;
      case Kind::curvature:
        read_curvature(index, facets);
        break;
      case Kind::proximity:
        read_proximity(index, facets);
        break;
    }
    read_as_[index] = std::move(read_as);
  }
}

std::set<Entity> ModelField::watched(std::size_t function) const {
  const SizeFunction& definition = field_.functions()[function];
  const Topology& topology = field_.topology();
  std::vector<Entity> made_from = definition.sources;
  if (definition.kind == Kind::curvature) {
    const std::set<Entity> sources = curvature_sources(definition, topology);
    made_from.assign(sources.begin(), sources.end());
  } else if (definition.kind == Kind::proximity) {
    made_from.clear();
    for (const GapRegion& gaps : gap_regions(definition, topology)) {
      made_from.push_back(gaps.region);
    }
  }
  const int highest_read =
      definition.kind == Kind::proximity ? highest_dimension(made_from) - 1 : 2;
  std::set<Entity> result;
  for (const Entity& entity : topology.closure(made_from)) {
    if (entity.dim >= 1 && entity.dim <= highest_read) {
      result.insert(entity);
    }
  }
  return result;
}

std::vector<std::size_t> ModelField::unread_functions(bool within_run) const {
  std::vector<std::size_t> unread;
  MeshFingerprints fingerprints;
  for (std::size_t i = 0; i < field_.functions().size(); ++i) {
    const auto read_as = read_as_.find(i);
    if (read_as == read_as_.end()) {
      unread.push_back(i);
      continue;
    }
    bool is_changed = false;
    bool is_lost = false;
    for (const auto& [entity, before] : read_as->second) {
      // Other kinds do without a mesh: one that came later is no reason to read them again.
      if (before == 0 && field_.functions()[i].kind != Kind::mesh) {
        continue;
      }
      const std::uint64_t now = fingerprints.of(entity);
      (within_run && now == 0 ? is_lost : is_changed) |= now != before;
    }
    if (is_changed && !is_lost) {
      unread.push_back(i);
    }
  }
  return unread;
}

std::vector<FacetedSource> ModelField::read_fixed(std::size_t function,
                                                  const NodeCoordinates& nodes) const {
  const SizeFunction& definition = field_.functions()[function];
  const Topology& topology = field_.topology();
  std::vector<FacetedSource> sources;
  for (const Entity& source : definition.sources) {
    // A volume stands for its faces, and for what is embedded in it.
    for (const Entity& part :
         source.dim == 3 ? topology.lower(source) : std::vector<Entity>{source}) {
      sources.push_back(part.dim > 0 && gmsh::has_elements(part)
                            ? read_entity_mesh(part, nodes)
                            : sample_geometry(part, topology, definition.start_size));
    }
  }
  return sources;
}

void ModelField::read_curvature(std::size_t function, SourceFacets& facets) {
  const SizeFunction& definition = field_.functions()[function];
  std::vector<FacetedSource> sources;
  for (const Entity& source : curvature_sources(definition, field_.topology())) {
    sources.push_back(facets.with_curvature(source, definition));
  }
  set_sources(function, sources);
}

void ModelField::read_proximity(std::size_t function, SourceFacets& facets) {
  std::vector<WalledRegion> regions;
  for (GapRegion& gaps : gap_regions(field_.functions()[function], field_.topology())) {
    std::vector<Wall> walls = facets.walls(gaps.region);
    regions.push_back({std::move(gaps), std::move(walls)});
  }
  field_.set_regions(function, regions);
}

std::vector<Entity> ModelField::unmeshed_sources(std::size_t function) const {
  std::vector<Entity> unmeshed;
  if (field_.functions()[function].kind == Kind::mesh) {
    for (const Entity& source : field_.functions()[function].sources) {
      if (!gmsh::has_elements(source) && kept_.count(source) == 0) {
        unmeshed.push_back(source);
      }
    }
  }
  return unmeshed;
}

void ModelField::report_unmeshed(std::size_t function) {
  const std::vector<Entity> unmeshed = unmeshed_sources(function);
  if (unmeshed.empty()) {
    return;
  }
  const std::string sentence = field_.function_name(function) + ": " + entity_names(unmeshed) +
                               (unmeshed.size() == 1 ? " has no mesh" : " have no mesh") +
                               (field_.is_effective(function) ? ", so only its other sources act"
                                                              : ", so the function has no effect") +
                               ": mesh the source before what grows from it.";
  if (strict_) {
    throw Error(sentence);
  }
  if (reported_.insert(function).second) {
    gmsh::log(sentence, "warning");
  }
}

}  // namespace meshgrow
