#include "gmsh_api.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <utility>

#include "gmsh_library.h"
#include "restore.h"
#include "temporary_directory.h"

namespace meshgrow::gmsh {

namespace {

GmshLibrary& library() { return GmshLibrary::instance(); }

/// An array that Gmsh allocates and the caller frees.
template <typename T>
class GmshArray {
 public:
  GmshArray() = default;
  GmshArray(const GmshArray&) = delete;
  GmshArray& operator=(const GmshArray&) = delete;
  ~GmshArray() { library().free(data_); }

  T** data() { return &data_; }
  std::size_t* size() { return &size_; }
  std::vector<T> copy() const { return std::vector<T>(data_, data_ + size_); }

 private:
  T* data_ = nullptr;
  std::size_t size_ = 0;
};

/// An array of arrays that Gmsh allocates.
template <typename T>
class GmshArrays {
 public:
  GmshArrays() = default;
  GmshArrays(const GmshArrays&) = delete;
  GmshArrays& operator=(const GmshArrays&) = delete;
  ~GmshArrays() {
    for (std::size_t i = 0; i < count_; ++i) {
      library().free(data_[i]);
    }
    library().free(data_);
    library().free(sizes_);
  }

  T*** data() { return &data_; }
  std::size_t** sizes() { return &sizes_; }
  std::size_t* count() { return &count_; }
  std::vector<T> copy(std::size_t i) const {
    return std::vector<T>(data_[i], data_[i] + sizes_[i]);
  }

 private:
  T** data_ = nullptr;
  std::size_t* sizes_ = nullptr;
  std::size_t count_ = 0;
};

/// A text that Gmsh allocates.
class GmshString {
 public:
  GmshString() = default;
  GmshString(const GmshString&) = delete;
  GmshString& operator=(const GmshString&) = delete;
  ~GmshString() { library().free(text_); }

  char** data() { return &text_; }
  std::string copy() const { return text_ == nullptr ? "" : text_; }

 private:
  char* text_ = nullptr;
};

/// Texts that Gmsh allocates, and the array of them.
class GmshStrings {
 public:
  GmshStrings() = default;
  GmshStrings(const GmshStrings&) = delete;
  GmshStrings& operator=(const GmshStrings&) = delete;
  ~GmshStrings() {
    for (std::size_t i = 0; i < size_; ++i) {
      library().free(data_[i]);
    }
    library().free(data_);
  }

  char*** data() { return &data_; }
  std::size_t* size() { return &size_; }
  std::vector<std::string> copy() const { return std::vector<std::string>(data_, data_ + size_); }

 private:
  char** data_ = nullptr;
  std::size_t size_ = 0;
};

/// Changes an option for the life of this object.
class ChangedOption {
 public:
  ChangedOption(const char* name, double value) : name_(name), before_(option(name)) {
    set_option(name_, value);
  }
  ~ChangedOption() {
    restore([this] { set_option(name_, before_); });
  }
  ChangedOption(const ChangedOption&) = delete;
  ChangedOption& operator=(const ChangedOption&) = delete;

 private:
  const char* name_;
  double before_;
};

/// Keeps what Gmsh says out of the user's log.
class Silence : ChangedOption {
 public:
  Silence() : ChangedOption("General.Verbosity", 0.0) {}
};

std::vector<Entity> to_entities(const std::vector<int>& dim_tags) {
  std::vector<Entity> result;
  for (std::size_t i = 0; i + 1 < dim_tags.size(); i += 2) {
    result.push_back({dim_tags[i], dim_tags[i + 1]});
  }
  return result;
}

std::vector<int> to_dim_tags(const std::vector<Entity>& entities) {
  std::vector<int> result;
  for (const Entity& entity : entities) {
    result.push_back(entity.dim);
    result.push_back(entity.tag);
  }
  return result;
}

std::vector<Vec3> to_vectors(const std::vector<double>& flat) {
  std::vector<Vec3> result;
  result.reserve(flat.size() / 3);
  for (std::size_t i = 0; i + 2 < flat.size(); i += 3) {
    result.emplace_back(flat[i], flat[i + 1], flat[i + 2]);
  }
  return result;
}

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

Version require_gmsh() {
  // Resolved first, so that a missing library is told as such.
  GmshLibrary& gmsh = library();
  std::string told;
  try {
    told = version_text();
  } catch (const Error&) {
    told.clear();
  }
  if (told.empty()) {  // depending on how it was built, Gmsh fails or says nothing
    throw Error("Gmsh is not initialized: call gmsh.initialize() first.");
  }
  Version version;
  if (std::sscanf(told.c_str(), "%d.%d", &version.major, &version.minor) != 2) {
    throw Error("The libgmsh in use (" + gmsh.path() +
                ") tells no version: install Gmsh 4.8 or "
                "later.");
  }
  if (std::make_pair(version.major, version.minor) < std::make_pair(4, 8)) {
    throw Error("The libgmsh in use (" + gmsh.path() + ") is version " + told +
                ": install Gmsh 4.8 or later.");
  }
  return version;
}

bool is_4_8() {
  const Version version = require_gmsh();
  return version.major == 4 && version.minor == 8;
}

void initialize(const std::vector<std::string>& arguments) {
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  for (const std::string& argument : arguments) {
    argv.push_back(const_cast<char*>(argument.c_str()));
  }
  const auto argc = static_cast<int>(argv.size());
  argv.push_back(nullptr);
  // Gmsh 4.9 added both this function and the argument `run`.
  if (library().has("gmshModelMeshGetMaxNodeTag")) {
    library().call("gmshInitialize", argc, argv.data(), 1, 0);
  } else {
    library().call("gmshInitialize", argc, argv.data(), 1);
  }
  require_gmsh();
}

void finalize() { library().call("gmshFinalize"); }

std::string version_text() {
  GmshString text;
  library().call("gmshOptionGetString", static_cast<const char*>("General.Version"), text.data());
  return text.copy();
}

std::string library_path() { return library().path(); }
void open(const std::string& file) { library().call("gmshOpen", file.c_str()); }
void merge(const std::string& file) { library().call("gmshMerge", file.c_str()); }
void write(const std::string& file) { library().call("gmshWrite", file.c_str()); }

double option(const std::string& name) {
  double value = 0.0;
  library().call("gmshOptionGetNumber", name.c_str(), &value);
  return value;
}

double option_or(const std::string& name, double otherwise) {
  const Silence silence;  // or the missing option would be an error in the user's log
  try {
    return option(name);
  } catch (const Error&) {
    return otherwise;  // this version has no such option
  }
}

void set_option(const std::string& name, double value) {
  library().call("gmshOptionSetNumber", name.c_str(), value);
}

std::vector<std::string> onelab_names(const std::string& expression) {
  GmshStrings names;
  library().call("gmshOnelabGetNames", names.data(), names.size(), expression.c_str());
  return names.copy();
}

std::string onelab_string(const std::string& name) {
  GmshStrings values;
  library().call("gmshOnelabGetString", name.c_str(), values.data(), values.size());
  const std::vector<std::string> all = values.copy();
  return all.empty() ? "" : all.front();
}

bool is_onelab_number(const std::string& name) {
  GmshArray<double> values;
  library().call("gmshOnelabGetNumber", name.c_str(), values.data(), values.size());
  return *values.size() > 0;
}

void remove_onelab(const std::string& name) { library().call("gmshOnelabClear", name.c_str()); }

void set_onelab_string(const std::string& name, const std::string& value) {
  const char* values[] = {value.c_str()};
  library().call("gmshOnelabSetString", name.c_str(), static_cast<const char* const*>(values),
                 std::size_t{1});
}

std::string current_model() {
  GmshString name;
  library().call("gmshModelGetCurrent", name.data());
  return name.copy();
}

void set_current_model(const std::string& name) {
  library().call("gmshModelSetCurrent", name.c_str());
}

std::vector<std::string> models() {
  GmshStrings names;
  library().call("gmshModelList", names.data(), names.size());
  return names.copy();
}

void log(const std::string& message, const std::string& level) {
  library().call("gmshLoggerWrite", message.c_str(), level.c_str());
}

std::vector<Entity> entities() {
  GmshArray<int> dim_tags;
  library().call("gmshModelGetEntities", dim_tags.data(), dim_tags.size(), -1);
  return to_entities(dim_tags.copy());
}

std::vector<Entity> boundary(const Entity& entity) {
  std::array<int, 2> dim_tag = {entity.dim, entity.tag};
  GmshArray<int> result;
  // Not combined, or seams would cancel out; not oriented, or tags would be signed.
  library().call("gmshModelGetBoundary", dim_tag.data(), dim_tag.size(), result.data(),
                 result.size(), 0, 0, 0);
  return to_entities(result.copy());
}

std::vector<Entity> embedded(const Entity& entity) {
  GmshArray<int> result;
  library().call("gmshModelMeshGetEmbedded", entity.dim, entity.tag, result.data(), result.size());
  return to_entities(result.copy());
}

Box bounding_box(const Entity& entity) {
  Vec3 low;
  Vec3 high;
  const Silence silence;  // or a box that is empty would be an error in the user's log
  try {
    library().call("gmshModelGetBoundingBox", entity.dim, entity.tag, &low.x(), &low.y(), &low.z(),
                   &high.x(), &high.y(), &high.z());
  } catch (const Error&) {
    // A discrete entity without a mesh of its own, as when only some physical groups were saved.
    return Box();
  }
  return (low.array() <= high.array()).all() ? Box(low, high) : Box();
}

std::string entity_type(const Entity& entity) {
  GmshString type;
  library().call("gmshModelGetType", entity.dim, entity.tag, type.data());
  return type.copy();
}

bool is_discrete(const Entity& entity) {
  return entity_type(entity).find("Discrete") != std::string::npos;
}

Entity add_discrete_point() {
  const int* no_boundary = nullptr;
  return {0, library().call_int("gmshModelAddDiscreteEntity", 0, -1, no_boundary, std::size_t{0})};
}

void remove_entity(const Entity& entity) {
  std::array<int, 2> dim_tag = {entity.dim, entity.tag};
  library().call("gmshModelRemoveEntities", dim_tag.data(), dim_tag.size(), 0);
  // Gmsh's own kernel keeps a discrete point otherwise, and makes it again when it synchronizes.
  library().call("gmshModelGeoRemove", dim_tag.data(), dim_tag.size(), 0);
}

std::vector<Entity> physical_groups() {
  GmshArray<int> dim_tags;
  library().call("gmshModelGetPhysicalGroups", dim_tags.data(), dim_tags.size(), -1);
  return to_entities(dim_tags.copy());
}

std::string physical_name(const Entity& group) {
  GmshString name;
  library().call("gmshModelGetPhysicalName", group.dim, group.tag, name.data());
  return name.copy();
}

std::vector<Entity> entities_of_physical_group(const Entity& group) {
  GmshArray<int> tags;
  library().call("gmshModelGetEntitiesForPhysicalGroup", group.dim, group.tag, tags.data(),
                 tags.size());
  std::vector<Entity> result;
  for (const int tag : tags.copy()) {
    result.push_back({group.dim, tag});
  }
  return result;
}

bool visible(const Entity& entity) {
  int value = 0;
  library().call("gmshModelGetVisibility", entity.dim, entity.tag, &value);
  return value != 0;
}

void set_visible(const Entity& entity, bool visible) {
  std::array<int, 2> dim_tag = {entity.dim, entity.tag};
  library().call("gmshModelSetVisibility", dim_tag.data(), dim_tag.size(), visible ? 1 : 0, 0);
}

void set_visible(const std::vector<Entity>& entities, bool visible) {
  std::vector<int> dim_tags = to_dim_tags(entities);
  library().call("gmshModelSetVisibility", dim_tags.data(), dim_tags.size(), visible ? 1 : 0, 0);
}

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

void generate(int dim) {
  constexpr const char* abort_on_error = "General.AbortOnError";
  const double users = option(abort_on_error);
  const std::string told_before = last_error();
  {
    // Where an error is thrown (2, the default), Gmsh stays locked and meshes nothing more in the
    // session, and 4.8 throws it out of parallel loops, which ends the process. With 1 it stops
    // meshing and returns.
    const ChangedOption no_throw(abort_on_error, std::min(users, 1.0));
    library().call("gmshModelMeshGenerate", dim);
  }
  const std::string error = last_error();
  if (users > 0.0 && !error.empty()) {
    throw Error("Gmsh: " + error +
                (error == told_before
                     ? " (as before this pass; if that error has left Gmsh locked, call "
                       "gmsh.finalize() and gmsh.initialize())"
                     : ""));
  }
}

void set_order(int order) { library().call("gmshModelMeshSetOrder", order); }

std::string last_error() {
  GmshString message;
  library().call("gmshLoggerGetLastError", message.data());
  return message.copy();
}

void optimize(const std::string& method) {
  const int* everything = nullptr;
  library().call("gmshModelMeshOptimize", method.c_str(), 0, 1, everything, std::size_t{0});
}

void partition(int count) {
  // Newer versions take prescribed partitions of elements as well.
  if (is_4_8()) {
    library().call("gmshModelMeshPartition", count);
  } else {
    const std::size_t* no_elements = nullptr;
    const int* no_partitions = nullptr;
    library().call("gmshModelMeshPartition", count, no_elements, std::size_t{0}, no_partitions,
                   std::size_t{0});
  }
}

std::vector<std::array<double, 2>> parameter_bounds(const Entity& entity) {
  GmshArray<double> low;
  GmshArray<double> high;
  library().call("gmshModelGetParametrizationBounds", entity.dim, entity.tag, low.data(),
                 low.size(), high.data(), high.size());
  const std::vector<double> lows = low.copy();
  const std::vector<double> highs = high.copy();
  std::vector<std::array<double, 2>> result;
  for (std::size_t i = 0; i < lows.size() && i < highs.size(); ++i) {
    result.push_back({lows[i], highs[i]});
  }
  return result;
}

std::vector<Vec3> points_at(const Entity& entity, const std::vector<double>& parameters) {
  GmshArray<double> coordinates;
  library().call("gmshModelGetValue", entity.dim, entity.tag, parameters.data(), parameters.size(),
                 coordinates.data(), coordinates.size());
  return to_vectors(coordinates.copy());
}

std::vector<Vec3> derivatives_at(const Entity& curve, const std::vector<double>& parameters) {
  GmshArray<double> derivatives;
  library().call("gmshModelGetDerivative", curve.dim, curve.tag, parameters.data(),
                 parameters.size(), derivatives.data(), derivatives.size());
  return to_vectors(derivatives.copy());
}

std::vector<double> parameters_on_surface(const Entity& curve,
                                          const std::vector<double>& parameters,
                                          const Entity& surface, bool other_side) {
  GmshArray<double> result;
  library().call("gmshModelReparametrizeOnSurface", curve.dim, curve.tag, parameters.data(),
                 parameters.size(), surface.tag, result.data(), result.size(), other_side ? 1 : 0);
  return result.copy();
}

std::vector<double> parameters_at(const Entity& entity, const std::vector<double>& coordinates) {
  GmshArray<double> parameters;
  library().call("gmshModelGetParametrization", entity.dim, entity.tag, coordinates.data(),
                 coordinates.size(), parameters.data(), parameters.size());
  return parameters.copy();
}

std::vector<Vec3> normals_at(const Entity& surface, const std::vector<double>& parameters) {
  GmshArray<double> normals;
  library().call("gmshModelGetNormal", surface.tag, parameters.data(), parameters.size(),
                 normals.data(), normals.size());
  return to_vectors(normals.copy());
}

bool is_inside(const Entity& surface, double u, double v) {
  std::array<double, 2> parameters = {u, v};
  // Gmsh 4.9 added the argument that tells parametric coordinates from points in space.
  if (library().has("gmshModelMeshGetMaxNodeTag")) {
    return library().call_int("gmshModelIsInside", surface.dim, surface.tag, parameters.data(),
                              parameters.size(), 1) > 0;
  }
  return library().call_int("gmshModelIsInside", surface.dim, surface.tag, parameters.data(),
                            parameters.size()) > 0;
}

void set_size_callback(SizeCallback48 until_48, SizeCallback49 since_49, void* data) {
  if (is_4_8()) {
    library().call("gmshModelMeshSetSizeCallback", until_48, data);
  } else {
    library().call("gmshModelMeshSetSizeCallback", since_49, data);
  }
}

void remove_size_callback() { library().call("gmshModelMeshRemoveSizeCallback"); }

}  // namespace meshgrow::gmsh
