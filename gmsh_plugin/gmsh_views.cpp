#include "gmsh_views.h"

#include "gmsh_library.h"

namespace meshgrow::gmsh {

namespace {

/// Versions differ in `const` alone.
void add_model_data(int view, const std::string& model, const char* kind,
                    const std::vector<std::size_t>& tags, const std::vector<const double*>& values,
                    const std::vector<std::size_t>& counts) {
  constexpr int step = 0;
  constexpr double time = 0.0;
  constexpr int components = 1;
  constexpr int partition = 0;
  GmshLibrary::instance().call("gmshViewAddModelData", view, step, model.c_str(), kind, tags.data(),
                               tags.size(), values.data(), counts.data(), values.size(), time,
                               components, partition);
}

}  // namespace

int add_view(const std::string& name) {
  constexpr int next_tag = -1;
  return GmshLibrary::instance().call_int("gmshViewAdd", name.c_str(), next_tag);
}

void remove_view(int view) { GmshLibrary::instance().call("gmshViewRemove", view); }

void add_list_data(int view, const std::string& type, std::size_t elements,
                   const std::vector<double>& data) {
  GmshLibrary::instance().call("gmshViewAddListData", view, type.c_str(),
                               static_cast<int>(elements), data.data(), data.size());
}

void add_node_data(int view, const std::string& model, const std::vector<std::size_t>& nodes,
                   const std::vector<double>& values) {
  std::vector<const double*> of_node;
  of_node.reserve(nodes.size());
  for (const double& value : values) {
    of_node.push_back(&value);
  }
  add_model_data(view, model, "NodeData", nodes, of_node,
                 std::vector<std::size_t>(nodes.size(), 1));
}

void add_element_node_data(int view, const std::string& model,
                           const std::vector<std::size_t>& elements,
                           const std::vector<std::vector<double>>& values) {
  std::vector<const double*> of_element;
  std::vector<std::size_t> counts;
  for (const std::vector<double>& own : values) {
    of_element.push_back(own.data());
    counts.push_back(own.size());
  }
  add_model_data(view, model, "ElementNodeData", elements, of_element, counts);
}

}  // namespace meshgrow::gmsh
