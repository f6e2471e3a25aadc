#ifndef MESHGROW_HPP
#define MESHGROW_HPP

#include <cstddef>
#include <exception>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "meshgrow.h"

/// The C++ interface of meshgrow: mesh sizes for Gmsh that grow from what is meshed already. Only
/// this header and C++17 are needed, over the C interface of the library (meshgrow.h), so any
/// compiler will do.
///
///     gmsh::initialize();
///     gmsh::open("model.step");
///     meshgrow::SizeField field;                       // of Gmsh's current model
///     field.add_mesh({{2, 7}}, {{3, 2}}, 1.2, 2.0);    // sources, attachments, growth, limit
///     field.generate(3);                               // Gmsh's own 1D/2D/3D, sources first
///
/// A size function grows the sizes S0 on its sources into what it is attached to, and all that
/// bounds that: at the distance R, min(L, S0 + (1 - 1/g) R), with the growth rate g >= 1 (1.1 is
/// slow, 1.2 usual, 1.5 fast) and the limit L > 0; the smallest over all facets and functions wins.
///
/// Entities are pairs of dimension and tag, as in gmsh.h. Coordinates and sizes are in model units,
/// angles in degrees. What goes wrong is thrown as `meshgrow::Error`: one sentence that names the
/// entity and the remedy. What throws changes nothing, but for `generate`. Thread safety is said at
/// each function where it is more than Gmsh's: one thread at a time.
namespace meshgrow {

// What is declared here has names of its own for the linker, apart from the library's inner
// classes.
inline namespace api {

/// Pairs of dimension (0 to 3) and tag; the same type as gmsh::vectorpair.
using DimTags = std::vector<std::pair<int, int>>;

/// What this interface throws.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

namespace detail {

inline void check(int failed) {
  if (failed != 0) {
    throw Error(meshgrow_last_error());
  }
}

/// A text of the library as a string, its memory freed; throws the last error if there is none.
inline std::string take_text(char* text) {
  if (text == nullptr) {
    throw Error(meshgrow_last_error());
  }
  const std::unique_ptr<char, void (*)(char*)> owner(text, meshgrow_free);
  return text;
}

inline std::vector<int> flat(const DimTags& entities) {
  std::vector<int> result;
  result.reserve(2 * entities.size());
  for (const auto& [dim, tag] : entities) {
    result.push_back(dim);
    result.push_back(tag);
  }
  return result;
}

inline std::string json_text(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      result += '\\';
    }
    result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return result + '"';
}

}  // namespace detail

/// Version of the library, such as "0.1.0".
inline std::string version() { return meshgrow_version(); }

/// Who answers sizes.
enum class Evaluator {
  automatic = 0,  ///< the tree of facets, until so many sizes are expected that a grid pays
  grid = 1,       ///< background grids
  exact = 2       ///< the tree: slower a size, nothing to build
};

/// By what `SizeField::add_mesh` sizes a quadrilateral: its two triangles, diagonal included, or
/// its sides.
enum class QuadSize { triangles = 0, sides = 1 };

/// Gaps that `SizeField::add_proximity` measures: between faces of attached volumes, edges of
/// surfaces (attached, or bounding an attached volume) or both; `automatic` takes faces if a volume
/// is attached and not all sources are curves.
enum class Between {
  automatic = MESHGROW_BETWEEN_AUTOMATIC,
  faces = MESHGROW_BETWEEN_FACES,
  edges = MESHGROW_BETWEEN_EDGES,
  both = MESHGROW_BETWEEN_BOTH
};

/// Of a size field, for its constructor.
struct Options {
  /// Relative tolerance of the background grids: a size is at most 1 + tolerance times the exact
  /// one.
  double tolerance = 0.05;
  Evaluator evaluator = Evaluator::automatic;
  /// A mesh size function whose source has no mesh is an error instead of a warning.
  bool strict = false;
  /// That build grids; 0 takes all.
  int threads = 0;
  /// Most cells of a background grid, 40 bytes each; 0: as many as half of the available memory
  /// holds while they are built. A grid that needs more is coarser, with a warning in Gmsh's log.
  std::size_t max_cells = 0;
  /// Corrects what Gmsh is told by measured factors, so that its edges get the length asked for:
  /// without, they are 1.3 times as long in volumes.
  bool calibrate = false;
  /// Told each line of progress, in place of Gmsh's log. What it throws stops the work and comes
  /// out of the function that worked; what was meshed is kept.
  std::function<void(const std::string&)> progress;
};

/// The mesh sizes of a Gmsh model, from its size functions. May be moved, not copied. A field that
/// was moved from may only be destroyed or assigned to.
class SizeField {
 public:
  /// The size that Gmsh takes for none.
  static constexpr double gmsh_no_size = 1e22;

  /// Of Gmsh's current model. Throws Error without libgmsh, before gmsh::initialize() and for a
  /// model without entities.
  explicit SizeField(const Options& options = {}) : SizeField(meshgrow_field_create()) {
    set_option("tolerance", options.tolerance);
    set_option("evaluator", static_cast<double>(options.evaluator));
    set_option("strict", options.strict ? 1.0 : 0.0);
    set_option("threads", options.threads);
    set_option("max_cells", static_cast<double>(options.max_cells));
    set_option("calibrate", options.calibrate ? 1.0 : 0.0);
    if (options.progress) {
      state_->progress = options.progress;
      detail::check(meshgrow_field_set_progress(c_field(), &State::tell, state_.get()));
    }
  }

  /// The mesh on the sources (curves, surfaces) grows into the attachments, each layer of elements
  /// `growth_rate` >= 1 times the one before, up to `size_limit` > 0. Acts on all that bounds or is
  /// embedded in the attachments as well. Returns the function's name: `name`, or a number in the
  /// order of adding if that is empty.
  std::string add_mesh(const DimTags& sources, const DimTags& attach, double growth_rate,
                       double size_limit, QuadSize quad_size = QuadSize::triangles,
                       const std::string& name = {}) {
    const std::vector<int> from = detail::flat(sources);
    const std::vector<int> to = detail::flat(attach);
    detail::check(meshgrow_field_add_mesh(c_field(), from.data(), from.size(), to.data(), to.size(),
                                          growth_rate, size_limit, static_cast<int>(quad_size)));
    return named(name);
  }

  /// The size `size` > 0 on the sources (points to volumes) grows likewise.
  std::string add_fixed(const DimTags& sources, const DimTags& attach, double size,
                        double growth_rate, double size_limit, const std::string& name = {}) {
    const std::vector<int> from = detail::flat(sources);
    const std::vector<int> to = detail::flat(attach);
    detail::check(meshgrow_field_add_fixed(c_field(), from.data(), from.size(), to.data(),
                                           to.size(), size, growth_rate, size_limit));
    return named(name);
  }

  /// The curvature of the sources (curves, surfaces; a volume stands for its faces) grows likewise:
  /// an edge of an element may turn by `angle` degrees. Sizes below `min_size` become `min_size`.
  std::string add_curvature(const DimTags& sources, const DimTags& attach, double angle,
                            double growth_rate, double size_limit, double min_size = 0.0,
                            const std::string& name = {}) {
    const std::vector<int> from = detail::flat(sources);
    const std::vector<int> to = detail::flat(attach);
    detail::check(meshgrow_field_add_curvature(c_field(), from.data(), from.size(), to.data(),
                                               to.size(), angle, growth_rate, size_limit,
                                               min_size));
    return named(name);
  }

  /// The gaps between the sources (a volume stands for its faces) and what is opposite grow
  /// likewise: `cells_per_gap` > 0 elements, not necessarily whole, fit into each. Gaps that ask
  /// for less than `min_size` are ignored.
  std::string add_proximity(const DimTags& sources, const DimTags& attach, double cells_per_gap,
                            double growth_rate, double size_limit, double min_size = 0.0,
                            Between between = Between::automatic, const std::string& name = {}) {
    const std::vector<int> from = detail::flat(sources);
    const std::vector<int> to = detail::flat(attach);
    detail::check(meshgrow_field_add_proximity(c_field(), from.data(), from.size(), to.data(),
                                               to.size(), cells_per_gap, growth_rate, size_limit,
                                               min_size, static_cast<int>(between)));
    return named(name);
  }

  /// What suits most models: curvature (18 degrees) and proximity (3 cells per gap, between faces
  /// and edges) of the attachments themselves; of all entities of the model's highest dimension if
  /// there are none.
  void create_defaults(double size_limit, double growth_rate = 1.2, double min_size = 0.0,
                       const DimTags& attach = {}) {
    const std::vector<int> to = detail::flat(attach);
    detail::check(meshgrow_field_create_defaults(c_field(), to.data(), to.size(), growth_rate,
                                                 size_limit, min_size));
  }

  /// A size function by its line of text, the same as on the command line:
  /// "mesh source Surface{7} attach Volume{2} growth 1.2 limit 2". It may hold `name inner`.
  /// Returns the name.
  std::string add(const std::string& text) {
    detail::check(meshgrow_field_add(c_field(), text.c_str()));
    return named("");
  }

  /// The size functions in the order of adding: names and lines of text.
  std::vector<std::pair<std::string, std::string>> functions() const {
    std::vector<std::pair<std::string, std::string>> result;
    for (std::size_t i = 0; i < meshgrow_field_function_count(c_field()); ++i) {
      result.emplace_back(detail::take_text(meshgrow_field_function_name(c_field(), i)),
                          detail::take_text(meshgrow_field_function_text(c_field(), i)));
    }
    return result;
  }
  /// Puts another definition, a line of text, in the place of a function. Only what it acts on is
  /// built anew; a registered field acts as changed at once.
  void modify(const std::string& name, const std::string& text) {
    check(meshgrow_field_modify(c_field(), name.c_str(), text.c_str()));
  }
  /// Takes a function away.
  void remove(const std::string& name) { check(meshgrow_field_remove(c_field(), name.c_str())); }
  /// Gives a function another name, which must be free and no number.
  void rename(const std::string& name, const std::string& new_name) {
    detail::check(meshgrow_field_rename(c_field(), name.c_str(), new_name.c_str()));
  }

  /// Saves the field, with grids unless the evaluator is exact, to a file (.mgf) that is complete
  /// or not there.
  void save(const std::string& path) { check(meshgrow_field_save(c_field(), path.c_str())); }
  /// A saved field, mapped into memory. It answers as the saved one did, to the bit, and can be
  /// asked, shown and registered (with a model that has the entities it acts on), but not changed.
  /// Needs no Gmsh unless registered.
  static SizeField load(const std::string& path) {
    return SizeField(meshgrow_field_load(path.c_str()));
  }

  /// Meshes the model up to dimension `dim` with Gmsh's own algorithms, sources first. What had a
  /// mesh before keeps it: node tags, coordinates to the bit, connectivity. With `remesh`, all that
  /// is no source of a mesh size function loses its mesh first. On errors, what was meshed before
  /// is kept (see meshgrow_field_generate), and the next call goes on.
  void generate(int dim = 3, bool remesh = false) {
    state_->raise_again();
    check(meshgrow_field_generate(c_field(), dim, remesh ? 1 : 0));
  }

  /// The passes that this would make, as text.
  std::string plan(int dim = 3) const {
    return detail::take_text(meshgrow_field_plan(c_field(), dim));
  }
  /// The same as JSON: [{"dim": …, "attached": …, "entities": …, "functions": …, "sources": …}, …].
  std::string plan_json(int dim = 3) const {
    return detail::take_text(meshgrow_field_plan_json(c_field(), dim));
  }

  /// A size callback of the user's own: (dim, tag, x, y, z, size so far) -> size.
  using UserSizes = std::function<double(int, int, double, double, double, double)>;

  /// Sizes of your own beside the field: Gmsh is told the smaller one, in the whole model; a result
  /// that is not positive and finite counts as none, an empty function ends that. Gmsh keeps one
  /// callback only and does not tell it: give the one of your setSizeCallback here. Called from
  /// several threads when Gmsh uses several. What it throws comes out of `generate`.
  void combine(UserSizes sizes) {
    state_->forget();
    detail::check(meshgrow_field_combine(c_field(), nullptr, nullptr));
    state_->sizes = std::move(sizes);
    if (state_->sizes) {
      detail::check(meshgrow_field_combine(c_field(), &State::user_size, state_.get()));
    }
  }

  /// Reads the sources as they are meshed now and becomes Gmsh's size callback; you mesh, with
  /// gmsh::model::mesh::generate. (`register` is a word of C++.)
  void register_callback() { check(meshgrow_field_register(c_field())); }
  /// Is Gmsh's size callback no more.
  void unregister_callback() { detail::check(meshgrow_field_unregister(c_field())); }

  /// Reads the sources as they are meshed now and builds trees, and grids where they pay. If it
  /// throws, the field answers as before.
  void refresh() { check(meshgrow_field_refresh(c_field())); }

  /// The field as a size callback of Gmsh: the smaller one of `proposed` and the size asked for on
  /// the entity at the point. Both of these compile with either version of Gmsh:
  ///
  ///     gmsh::model::mesh::setSizeCallback(std::ref(field));
  ///     gmsh::model::mesh::setSizeCallback([&](int dim, int tag, double x, double y, double z,
  ///                                            double proposed) {  // not in 4.8: `proposed`
  ///       return std::min(my_size(x, y, z), field(dim, tag, x, y, z, proposed));
  ///     });
  ///
  /// The field must live as long as Gmsh may call it. See meshgrow_field_callback for when sources
  /// are read. Thread safety: may be called from any thread while no other function of this field
  /// runs; throws nothing.
  double operator()(int dim, int tag, double x, double y, double z,
                    double proposed = gmsh_no_size) const noexcept {
    return meshgrow_field_callback(dim, tag, x, y, z, proposed, c_field());
  }

  /// Sizes asked for on an entity at points, three coordinates each; infinite where no function
  /// acts; before Gmsh applies its Mesh.MeshSizeMin, Max and Factor. Throws Error if the entity is
  /// not in the model. Thread safety: as the operator above.
  std::vector<double> size(int dim, int tag, const std::vector<double>& points) const {
    std::vector<double> sizes(points.size() / 3);
    check_points(points);
    size(dim, tag, points.data(), sizes.size(), sizes.data());
    return sizes;
  }
  /// The same without copies: `count` points, three coordinates each, into `count` sizes.
  void size(int dim, int tag, const double* points, std::size_t count, double* sizes) const {
    check(meshgrow_field_size(c_field(), dim, tag, points, count, sizes));
  }
  /// The same without the grid: the minimum over all facets of the sources.
  std::vector<double> exact_size(int dim, int tag, const std::vector<double>& points) const {
    std::vector<double> sizes(points.size() / 3);
    check_points(points);
    exact_size(dim, tag, points.data(), sizes.size(), sizes.data());
    return sizes;
  }
  void exact_size(int dim, int tag, const double* points, std::size_t count, double* sizes) const {
    check(meshgrow_field_exact_size(c_field(), dim, tag, points, count, sizes));
  }

  /// The same for who knows no entity: the smallest size that any function asks for.
  std::vector<double> smallest_size(const std::vector<double>& points) const {
    std::vector<double> sizes(points.size() / 3);
    check_points(points);
    check(meshgrow_field_smallest_size(c_field(), points.data(), sizes.size(), sizes.data()));
    return sizes;
  }

  /// What decides the size on an entity at a point, as JSON: see meshgrow_field_probe_json.
  std::string probe_json(int dim, int tag, double x, double y, double z) const {
    const double point[3] = {x, y, z};
    return detail::take_text(meshgrow_field_probe_json(c_field(), dim, tag, point));
  }

  /// Stands for no entity in the two functions below: the smallest size that any function asks for.
  static constexpr std::pair<int, int> no_entity = {-1, 0};

  /// Puts the field of an entity into Gmsh as a post-processing view and returns the view's tag.
  /// `kind`: "cells" (of the background grid), "plane" (a cut) or "mesh" (at the nodes of the
  /// mesh). `plane`: a point and a normal, six numbers; if empty, through the middle of the
  /// entity's box. `resolution`: squares along the longer side of the cut; 0 for 32.
  int add_view(const std::string& name = "sizes", const std::string& kind = "cells",
               std::pair<int, int> entity = no_entity, const std::vector<double>& plane = {},
               int resolution = 0) const {
    if (!plane.empty() && plane.size() != 6) {
      throw Error("A plane is a point and a normal: give six numbers.");
    }
    int view = 0;
    check(meshgrow_field_add_view(c_field(), name.c_str(), kind.c_str(), entity.first,
                                  entity.second, plane.empty() ? nullptr : plane.data(), resolution,
                                  &view));
    return view;
  }

  /// Writes the field of an entity into a file: .vtu (ParaView), .pos (a view that any Gmsh can
  /// take for a background field) or .msh. Returns the number of cells.
  std::size_t write_view(const std::string& path, std::pair<int, int> entity = no_entity) const {
    std::size_t cells = 0;
    check(meshgrow_field_write_view(c_field(), path.c_str(), entity.first, entity.second, &cells));
    return cells;
  }

  /// Functions, groups and grids as text for people.
  std::string summary() const { return detail::take_text(meshgrow_field_summary(c_field())); }
  /// The same as JSON: {"functions": […], "groups": […], "seconds": {"gmsh": …, "meshgrow": …}},
  /// the last being the wall time of the last `generate`.
  std::string statistics() const {
    return detail::take_text(meshgrow_field_summary_json(c_field()));
  }

  /// The field of the C interface, for what is not here; owned by this object.
  meshgrow_field* c_field() const noexcept { return state_->field.get(); }

 private:
  struct Destroy {
    void operator()(meshgrow_field* field) const noexcept { meshgrow_field_destroy(field); }
  };

  /// What the library holds pointers to: stays where it is when the field moves.
  struct State {
    std::function<void(const std::string&)> progress;
    UserSizes sizes;
    std::mutex mutex;
    std::exception_ptr thrown;
    std::unique_ptr<meshgrow_field, Destroy> field;  // last, so that it goes first

    /// The first exception counts.
    void keep() noexcept {
      const std::lock_guard<std::mutex> lock(mutex);
      if (!thrown) {
        thrown = std::current_exception();
      }
    }
    bool has_thrown() {
      const std::lock_guard<std::mutex> lock(mutex);
      return thrown != nullptr;
    }
    void forget() {
      const std::lock_guard<std::mutex> lock(mutex);
      thrown = nullptr;
    }
    void raise_again() {
      std::exception_ptr raised;
      {
        const std::lock_guard<std::mutex> lock(mutex);
        std::swap(raised, thrown);
      }
      if (raised) {
        std::rethrow_exception(raised);
      }
    }

    static int tell(const char* line, void* data) noexcept {
      State& state = *static_cast<State*>(data);
      try {
        if (!state.has_thrown()) {
          state.progress(line);
        }
      } catch (...) {
        state.keep();
      }
      return state.has_thrown() ? 1 : 0;
    }

    static double user_size(int dim, int tag, double x, double y, double z, double so_far,
                            void* data) noexcept {
      State& state = *static_cast<State*>(data);
      try {
        return state.sizes(dim, tag, x, y, z, so_far);
      } catch (...) {
        state.keep();
        return -1.0;  // no size
      }
    }
  };

  explicit SizeField(meshgrow_field* field) : state_(std::make_unique<State>()) {
    if (field == nullptr) {
      throw Error(meshgrow_last_error());
    }
    state_->field.reset(field);
  }

  /// Names the function that was added last, if `name` is not empty; if it cannot have this name,
  /// there is none. Returns its name.
  std::string named(const std::string& name) {
    const std::size_t last = meshgrow_field_function_count(c_field()) - 1;
    std::string number = detail::take_text(meshgrow_field_function_name(c_field(), last));
    if (name.empty()) {
      return number;
    }
    try {
      rename(number, name);
    } catch (...) {
      meshgrow_field_remove(c_field(), number.c_str());
      throw;
    }
    return name;
  }

  void check(int failed) const {
    state_->raise_again();
    detail::check(failed);
  }
  static void check_points(const std::vector<double>& points) {
    if (points.size() % 3 != 0) {
      throw Error("Points have three coordinates each: give a multiple of three numbers.");
    }
  }
  void set_option(const char* name, double value) {
    detail::check(meshgrow_field_set_option(c_field(), name, value));
  }

  std::unique_ptr<State> state_;
};

/// Gradation and quality of a mesh, as `report` measures them.
class Report {
 public:
  explicit Report(std::string json) : json_(std::move(json)) {}

  /// One of "elements", "smallest_size", "largest_size", "ratio_max", "ratio_99" (larger over
  /// smaller size of neighbours; size: mean edge length), "length_median", "length_share_good",
  /// "length_share_over_2" (edge length over the size asked for), "gamma_min", "gamma_mean",
  /// "sicn_min" and "sicn_mean". Not a number if it could not be measured. Throws Error for other
  /// names.
  double value(const std::string& name) const {
    double result = 0.0;
    detail::check(meshgrow_report_value(json_.c_str(), name.c_str(), &result));
    return result;
  }
  /// The report itself.
  const std::string& json() const { return json_; }

 private:
  std::string json_;
};

/// Measures the current model's mesh of dimension `dim` (2 or 3), restricted to `entities` unless
/// there are none, without sizes to compare with.
inline Report report(int dim = 3, const DimTags& entities = {}) {
  const std::vector<int> only = detail::flat(entities);
  return Report(detail::take_text(meshgrow_report_json(dim, only.data(), only.size(), nullptr)));
}
/// The same against the sizes that the field asks for, at the middle of each edge.
inline Report report(int dim, const DimTags& entities, const SizeField& field) {
  const std::vector<int> only = detail::flat(entities);
  return Report(
      detail::take_text(meshgrow_report_json(dim, only.data(), only.size(), field.c_field())));
}

/// Several reports with their names as a table for people.
inline std::string report_table(const std::vector<std::pair<std::string, Report>>& reports) {
  std::string json;
  for (const auto& [name, report] : reports) {
    json += (json.empty() ? "[" : ",") + ("{\"name\":" + detail::json_text(name)) +
            ",\"report\":" + report.json() + "}";
  }
  return detail::take_text(meshgrow_report_table((json.empty() ? "[]" : json + "]").c_str()));
}

}  // namespace api
}  // namespace meshgrow

#endif
