// The meshes of entities: nodes, elements and periodic nodes.

#include <fstream>

#include "changed_option.h"
#include "dim_tags.h"
#include "gmsh_api.h"
#include "gmsh_memory.h"
#include "temporary_directory.h"

namespace meshgrow::gmsh {

namespace {

Nodes get_nodes(int dim, int tag, bool with_boundary, bool parametric) {
  GmshArray<std::size_t> tags;
  GmshArray<double> coordinates;
  GmshArray<double> parameters;
  library().call("gmshModelMeshGetNodes", tags.data(), tags.size(), coordinates.data(),
                 coordinates.size(), parameters.data(), parameters.size(), dim, tag,
                 with_boundary ? 1 : 0, parametric ? 1 : 0);
  return {tags.copy(), coordinates.copy(), parameters.copy()};
}

}  // namespace

Nodes nodes(const Entity& entity) { return get_nodes(entity.dim, entity.tag, false, true); }
Nodes nodes_without_parameters(const Entity& entity) {
  return get_nodes(entity.dim, entity.tag, false, false);
}
Nodes nodes_with_boundary(const Entity& entity) {
  const Silence silence;  // 4.8 warns of each node on a seam, though it gives parameters for it
  return get_nodes(entity.dim, entity.tag, true, true);
}
Nodes all_nodes() { return get_nodes(-1, -1, false, false); }

void add_nodes(const Entity& entity, const Nodes& nodes) {
  library().call("gmshModelMeshAddNodes", entity.dim, entity.tag, nodes.tags.data(),
                 nodes.tags.size(), nodes.coordinates.data(), nodes.coordinates.size(),
                 nodes.parametric_coordinates.data(), nodes.parametric_coordinates.size());
}

std::vector<Elements> elements(const Entity& entity) {
  GmshArray<int> types;
  GmshArrays<std::size_t> tags;
  GmshArrays<std::size_t> node_tags;
  library().call("gmshModelMeshGetElements", types.data(), types.size(), tags.data(), tags.sizes(),
                 tags.count(), node_tags.data(), node_tags.sizes(), node_tags.count(), entity.dim,
                 entity.tag);
  std::vector<Elements> result;
  const std::vector<int> type_list = types.copy();
  for (std::size_t i = 0; i < type_list.size(); ++i) {
    result.push_back({type_list[i], tags.copy(i), node_tags.copy(i)});
  }
  return result;
}

std::vector<int> element_types(const Entity& entity) {
  GmshArray<int> types;
  library().call("gmshModelMeshGetElementTypes", types.data(), types.size(), entity.dim,
                 entity.tag);
  return types.copy();
}

bool has_elements(const Entity& entity) { return !element_types(entity).empty(); }

void add_elements(const Entity& entity, const std::vector<Elements>& elements) {
  for (const Elements& block : elements) {
    library().call("gmshModelMeshAddElementsByType", entity.tag, block.type, block.tags.data(),
                   block.tags.size(), block.node_tags.data(), block.node_tags.size());
  }
}

ElementType element_type(int type) {
  GmshString name;
  int order = 0;
  ElementType result;
  GmshArray<double> local;
  library().call("gmshModelMeshGetElementProperties", type, name.data(), &result.dim, &order,
                 &result.node_count, local.data(), local.size(), &result.corner_count);
  result.name = name.copy();
  return result;
}

int linear_type(const ElementType& type) {
  std::string family = type.name.substr(0, type.name.find(' '));
  if (family == "Quadrilateral") {
    family = "Quadrangle";  // Gmsh's two words for it
  }
  return family == "Point"
             ? 15
             : library().call_int("gmshModelMeshGetElementType", family.c_str(), 1, 0);
}

void clear_mesh(const std::vector<Entity>& entities) {
  std::vector<int> dim_tags = to_dim_tags(entities);
  library().call("gmshModelMeshClear", dim_tags.data(), dim_tags.size());
}

PeriodicNodes periodic_nodes(const Entity& entity) {
  PeriodicNodes result;
  GmshArray<std::size_t> nodes;
  GmshArray<std::size_t> master_nodes;
  GmshArray<double> transformation;
  library().call("gmshModelMeshGetPeriodicNodes", entity.dim, entity.tag, &result.master,
                 nodes.data(), nodes.size(), master_nodes.data(), master_nodes.size(),
                 transformation.data(), transformation.size(), 0);
  result.nodes = nodes.copy();
  result.master_nodes = master_nodes.copy();
  result.transformation = transformation.copy();
  return result;
}

void set_periodic_nodes(const std::vector<std::pair<Entity, PeriodicNodes>>& periodic) {
  // The only way in is a file, and only one without transformations moves no nodes.
  const TemporaryDirectory directory;
  const std::string path = (directory.path() / "periodic.msh").string();
  {
    std::ofstream file(path);
    file << "$MeshFormat\n4.1 0 " << sizeof(std::size_t) << "\n$EndMeshFormat\n$Periodic\n"
         << periodic.size() << '\n';
    for (const auto& [entity, pairs] : periodic) {
      file << entity.dim << ' ' << entity.tag << ' ' << pairs.master << "\n0\n"
           << pairs.nodes.size() << '\n';
      for (std::size_t i = 0; i < pairs.nodes.size(); ++i) {
        file << pairs.nodes[i] << ' ' << pairs.master_nodes[i] << '\n';
      }
    }
    file << "$EndPeriodic\n";
    file.close();
    if (!file) {
      throw Error("The temporary file " + path +
                  " could not be written, which is needed to tell Gmsh of periodic nodes: make "
                  "room or set TMPDIR to another directory.");
    }
  }
  merge(path);
}

}  // namespace meshgrow::gmsh
