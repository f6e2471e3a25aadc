#ifndef MESHGROW_GMSH_API_H
#define MESHGROW_GMSH_API_H

#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "entity.h"
#include "geometry.h"

/// The part of Gmsh that meshgrow uses, as C++ values over the C API found at run time. Every
/// function throws meshgrow::Error with Gmsh's message when Gmsh reports a failure. Not
/// thread-safe, as Gmsh is not, unless said otherwise.
namespace meshgrow::gmsh {

struct Version {
  int major = 0;
  int minor = 0;
};

/// Throws Error unless Gmsh is initialized and at least 4.8.
Version require_gmsh();

/// Whether this is the old generation: one size callback for all models, no proposal passed to it.
bool is_4_8();

/// Starts Gmsh with a command line of its own; reads its configuration files as the program does.
void initialize(const std::vector<std::string>& arguments);
void finalize();
/// Such as "4.15.2". Gmsh must be initialized.
std::string version_text();
/// The file of the libgmsh in use.
std::string library_path();
void open(const std::string& file);
/// Adds what is in the file to the current model.
void merge(const std::string& file);
void write(const std::string& file);

double option(const std::string& name);
/// The same, or `otherwise` if this version of Gmsh has no such option.
double option_or(const std::string& name, double otherwise);
void set_option(const std::string& name, double value);

/// Names of the parameters in Gmsh's ONELAB database that match the regular expression, by name.
std::vector<std::string> onelab_names(const std::string& expression);
/// The value of a string parameter; empty if there is none of this name.
std::string onelab_string(const std::string& name);
/// Whether there is a number of this name.
bool is_onelab_number(const std::string& name);
void remove_onelab(const std::string& name);

/// Sets a string parameter of ONELAB, which a .geo reads in place of its own value.
void set_onelab_string(const std::string& name, const std::string& value);

std::string current_model();
void set_current_model(const std::string& name);
std::vector<std::string> models();

/// Gmsh's log: `level` is "info", "warning" or "error".
void log(const std::string& message, const std::string& level = "info");

std::vector<Entity> entities();
/// Entities one dimension below on the boundary, seams included.
std::vector<Entity> boundary(const Entity& entity);
std::vector<Entity> embedded(const Entity& entity);
/// Empty for a discrete entity without a mesh.
Box bounding_box(const Entity& entity);

/// Such as "Plane", "Discrete surface".
std::string entity_type(const Entity& entity);
/// Whether the entity is a mesh without geometry of a CAD kernel.
bool is_discrete(const Entity& entity);
/// What Gmsh makes of a compound (several entities that it meshes as one) while it meshes them: a
/// discrete entity whose tag is this much above that of the first part.
constexpr int compound_offset = 100000;
/// A point without geometry, with a tag of its own.
Entity add_discrete_point();
void remove_entity(const Entity& entity);

std::vector<Entity> physical_groups();
std::string physical_name(const Entity& group);
std::vector<Entity> entities_of_physical_group(const Entity& group);

bool visible(const Entity& entity);
void set_visible(const std::vector<Entity>& entities, bool visible);
/// The same for one; needs no memory.
void set_visible(const Entity& entity, bool visible);

struct Nodes {
  std::vector<std::size_t> tags;
  std::vector<double> coordinates;             ///< three a node
  std::vector<double> parametric_coordinates;  ///< one a node on curves, two on surfaces, or none
};

/// Nodes classified on the entity, those of its boundary not included.
Nodes nodes(const Entity& entity);
Nodes nodes_without_parameters(const Entity& entity);
/// The same with those of its boundary, all with parametric coordinates on the entity: on one side
/// of a seam only.
Nodes nodes_with_boundary(const Entity& entity);
/// All nodes of the model, without parametric coordinates.
Nodes all_nodes();
void add_nodes(const Entity& entity, const Nodes& nodes);

/// Elements of one type.
struct Elements {
  int type = 0;
  std::vector<std::size_t> tags;
  std::vector<std::size_t> node_tags;  ///< all nodes of the first element, then of the next
};

std::vector<Elements> elements(const Entity& entity);
std::vector<int> element_types(const Entity& entity);
bool has_elements(const Entity& entity);
void add_elements(const Entity& entity, const std::vector<Elements>& elements);

constexpr int tetrahedron_type = 4;

struct ElementType {
  std::string name;  ///< such as "Triangle 6"
  int dim = 0;
  int node_count = 0;
  int corner_count = 0;
};
ElementType element_type(int type);
/// The type of first order with the same corners.
int linear_type(const ElementType& type);

/// Corner nodes of a periodic curve or surface and those of the entity that it is a copy of.
struct PeriodicNodes {
  int master = 0;  ///< tag of the other entity, of the same dimension; its own if it is no copy
  std::vector<std::size_t> nodes;
  std::vector<std::size_t> master_nodes;
  std::vector<double> transformation;  ///< affine, from the master: 4 × 4 by rows, or none
};
PeriodicNodes periodic_nodes(const Entity& entity);
/// Tells Gmsh which nodes correspond, without moving any. The nodes must exist.
void set_periodic_nodes(const std::vector<std::pair<Entity, PeriodicNodes>>& periodic);

/// Deletes the meshes of these entities.
void clear_mesh(const std::vector<Entity>& entities);
/// Throws Error if Gmsh logged an error meanwhile, unless the user's General.AbortOnError is 0.
void generate(int dim);
/// Makes all elements of this order.
void set_order(int order);
std::string last_error();
/// Optimizes the mesh by one of Gmsh's methods, such as "HighOrder".
void optimize(const std::string& method);
/// Cuts the mesh into so many partitions.
void partition(int count);

/// Parameter ranges of a curve (one) or surface (two): {min, max} each.
std::vector<std::array<double, 2>> parameter_bounds(const Entity& entity);
/// Points at parameters: none for a point, one a curve point, two a surface point.
std::vector<Vec3> points_at(const Entity& entity, const std::vector<double>& parameters);
/// Parameters of points (three coordinates each) on a curve (one each) or surface (two each).
std::vector<double> parameters_at(const Entity& entity, const std::vector<double>& coordinates);
/// Derivatives by the parameter of a curve at parameters.
std::vector<Vec3> derivatives_at(const Entity& curve, const std::vector<double>& parameters);
/// Parameters on a surface (two each) of a curve on its boundary at parameters; on the other side
/// of a seam with `other_side`.
std::vector<double> parameters_on_surface(const Entity& curve,
                                          const std::vector<double>& parameters,
                                          const Entity& surface, bool other_side);
/// Unit normals of a surface at parameters, two each.
std::vector<Vec3> normals_at(const Entity& surface, const std::vector<double>& parameters);
/// Whether the surface's trimming curves enclose the parameters (u, v).
bool is_inside(const Entity& surface, double u, double v);

/// Gmsh's size callback until 4.8, and since 4.9.
using SizeCallback48 = double (*)(int dim, int tag, double x, double y, double z, void* data);
using SizeCallback49 = double (*)(int dim, int tag, double x, double y, double z, double lc,
                                  void* data);

/// Registers the callback that fits the running Gmsh with the current model (with all, in 4.8).
void set_size_callback(SizeCallback48 until_48, SizeCallback49 since_49, void* data);
void remove_size_callback();

}  // namespace meshgrow::gmsh

#endif
