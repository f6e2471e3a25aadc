#ifndef MESHGROW_GMSH_VIEWS_H
#define MESHGROW_GMSH_VIEWS_H

#include <string>
#include <vector>

/// Gmsh's post-processing views, over the C API found at run time. As gmsh_api.h: every function
/// throws meshgrow::Error with Gmsh's message; not thread-safe.
namespace meshgrow::gmsh {

/// A new, empty view; returns its tag.
int add_view(const std::string& name);
void remove_view(int view);

/// Elements of their own for the view. `type`: "SH" for hexahedra, "SQ" for quadrangles. `data`: of
/// each element the x, then the y, the z and the values of its nodes.
void add_list_data(int view, const std::string& type, std::size_t elements,
                   const std::vector<double>& data);

/// Values at nodes of the model's mesh.
void add_node_data(int view, const std::string& model, const std::vector<std::size_t>& nodes,
                   const std::vector<double>& values);

/// Values at the nodes of elements of the model's mesh, each element's own.
void add_element_node_data(int view, const std::string& model,
                           const std::vector<std::size_t>& elements,
                           const std::vector<std::vector<double>>& values);

}  // namespace meshgrow::gmsh

#endif
