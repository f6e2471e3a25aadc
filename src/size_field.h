#ifndef MESHGROW_SIZE_FIELD_H
#define MESHGROW_SIZE_FIELD_H

#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "answer_count.h"
#include "background_grid.h"
#include "facet_origins.h"
#include "probe.h"
#include "region_walls.h"
#include "size_function.h"
#include "topology.h"

namespace meshgrow {

/// Who answers `SizeField::size`.
enum class Evaluator {
  automatic,  ///< the tree, until so many sizes are expected that a grid pays
  grid,       ///< the background grid of the entity's group
  exact       ///< the tree: slower a size, nothing to build
};

struct FieldOptions {
  double tolerance = 0.05;  ///< of the background grids, relative
  Evaluator evaluator = Evaluator::automatic;
  int threads = 0;            ///< that build grids; 0: OMP_NUM_THREADS, else all processors
  std::size_t max_cells = 0;  ///< of each grid; see GridOptions
  /// The triangles of the boundary meshes of volumes, those of a face that two of them share twice;
  /// empty if a face has no mesh. Asked, where there is such a function, when a grid is built, and
  /// spares the cells outside.
  std::function<std::vector<std::array<Vec3, 3>>(const std::vector<Entity>&)> boundary;
  /// Called while a grid is built, from the building thread only: what is built, finished fraction.
  std::function<void(const std::string&, double)> progress;
  /// Told in a sentence, from the building thread, of a grid that max_cells kept from refinement.
  std::function<void(const std::string&)> warn;
};

/// The walls of a region in which a proximity size function measures gaps.
struct WalledRegion {
  GapRegion gaps;
  std::vector<Wall> walls;
};

/// The size field of a model: all size functions, the groups of entities on which they act, a tree
/// and a background grid for each group (paper, section 4.3; DESIGN.md, section 2).
///
/// Copies are cheap: they share what is large.
///
/// A member function that throws changes nothing, but for `build`, `build_trees` and `build_grids`:
/// groups that they did not come to answer as before.
///
/// Thread safety: `size`, `exact_size` and the other const functions may be called from any thread
/// while no other member function runs.
class SizeField {
 public:
  /// What `size` answers where no size function acts.
  static constexpr double no_size = std::numeric_limits<double>::infinity();

  explicit SizeField(Topology topology, FieldOptions options = {});

  /// Checks and adds a function; returns its index. One without a name gets the next number. Throws
  /// Error and adds nothing if it is unusable or another one has its name.
  std::size_t add(SizeFunction function);

  /// Puts another definition in the place of a function, under its name unless it brings one. It
  /// has no sources until it is given them. Groups on which it does not act keep what is built.
  /// Throws Error and changes nothing if the definition is unusable.
  void modify(std::size_t function, SizeFunction definition);

  /// The functions behind it move up by one index. Groups on which it did not act keep what is
  /// built.
  void remove(std::size_t function);

  /// Throws Error if another function has the name, or it is a number.
  void rename(std::size_t function, const std::string& name);

  /// The index of the function with this name. Throws Error, listing the names, if there is none.
  std::size_t find(const std::string& name) const;

  const std::vector<SizeFunction>& functions() const { return functions_; }
  const Topology& topology() const { return *topology_; }
  FieldOptions& options() { return options_; }
  const FieldOptions& options() const { return options_; }

  /// "Mesh size function 1", as messages name it.
  std::string function_name(std::size_t function) const;

  /// Gives a mesh, fixed or curvature size function the pieces of its sources and computes their
  /// start sizes. Without any, a mesh or fixed size function has no effect. Takes effect with the
  /// next `build`. Start sizes that are read from a mesh are divided by `unit`: who multiplies all
  /// sizes afterwards gets those of the mesh back.
  DroppedFacets set_sources(std::size_t function, const std::vector<FacetedSource>& sources,
                            double unit = 1.0);

  /// Gives a proximity size function the walls of its gap_regions and computes the start sizes of
  /// its sources.
  void set_regions(std::size_t function, const std::vector<WalledRegion>& regions);

  /// False while the function has been given no source. A mesh or fixed size function needs a facet
  /// as well; for the other kinds, no facet means that only their size limit acts.
  bool is_effective(std::size_t function) const { return effective_[function]; }

  /// Brings trees and grids of the groups of these entities up to date (of all groups, if
  /// `entities` is empty). Groups not built since a change answer as before it; never built ones,
  /// `no_size`. An automatic evaluator builds a grid only where volumes among the entities are
  /// expected to be asked for so many sizes that it pays: `sizes_per_tetrahedron` is how many
  /// sizes the mesher asks for; 0, the default, if nobody is about to mesh. `entities` of lower
  /// dimension are never asked for so many.
  void build(const std::vector<Entity>& entities = {}, double sizes_per_tetrahedron = 0.0);

  /// Brings the trees of all groups up to date and, unless the evaluator is exact, builds all
  /// grids.
  void build_grids();

  /// Brings the trees of all groups up to date, and no grids: changed groups answer exactly until
  /// the next `build`.
  void build_trees();

  /// True if some function acts on the entity: attached itself, or below an attachment.
  bool acts_on(const Entity& entity) const { return group_of_.count(entity) > 0; }

  /// Indices of the functions that act on the entity.
  std::vector<std::size_t> functions_on(const Entity& entity) const;

  /// Size asked for on the entity at p, model units; `no_size` where no function acts or p is not
  /// finite. At most (1 + tolerance) times the exact size.
  double size(const Entity& entity, const Vec3& p) const;

  /// The same without the grid: the minimum over all facets.
  double exact_size(const Entity& entity, const Vec3& p) const;

  /// Both for many points of an entity, in less time each.
  void sizes(const Entity& entity, const Vec3* points, std::size_t count, double* sizes) const;
  void exact_sizes(const Entity& entity, const Vec3* points, std::size_t count,
                   double* sizes) const;

  /// The smallest size that any group asks for at the points, for who knows no entity: what a view
  /// or a server answers. From grids where there are any. What is inside a source volume of a fixed
  /// function asks only within its box. `groups`, unless null, gets the index into groups() of the
  /// one that decides (the first of equal ones).
  void smallest_sizes(const Vec3* points, std::size_t count, double* sizes,
                      std::size_t* groups = nullptr) const;

  /// All that answers sizes of one group, or of all groups together.
  struct Answering {
    std::shared_ptr<const FacetTree> tree;  ///< null if nothing is built
    double size_limit = no_size;
    Box box;                                     ///< of the entities
    std::shared_ptr<const BackgroundGrid> grid;  ///< null if there is none
    std::size_t group = 0;                       ///< index into groups(); 0 of all together
    std::vector<std::pair<Box, double>> inside;  ///< no size is above this one in this box
  };
  /// The group of an entity; nothing if no function acts on it.
  Answering answering(const Entity& entity) const;
  /// A tree of the facets of all groups: the smallest size that any group asks for, in the box of
  /// the whole model. Made anew at each call if there are several groups, and without a grid then.
  Answering answering_together() const;

  /// Which function and which facet decides the size on the entity at p. As `size`, it is about
  /// what was built last.
  Probe probe(const Entity& entity, const Vec3& p) const;

  /// The same for the group that asks for the smallest size at p, by one of its entities.
  Probe probe(const Vec3& p) const;

  struct GroupSummary {
    std::vector<Entity> entities;
    std::vector<std::size_t> functions;
    std::size_t facets = 0;
    double size_limit = no_size;
    bool has_grid = false;
    BackgroundGrid::Statistics grid;
    std::size_t tree_bytes = 0;
    double tree_seconds = 0.0;        ///< wall time of building
    std::uint64_t answers = 0;        ///< of `size` and `sizes`, since the group was first built
    std::uint64_t exact_answers = 0;  ///< those that were searched for in the tree
  };
  std::vector<GroupSummary> groups() const;

  /// How many facets the function's sources have.
  std::size_t facet_count(std::size_t function) const { return facet_counts_[function]; }

  /// A function as a group sees it. Inside a source volume a fixed function has its start size
  /// everywhere, since the distance to the source is zero there.
  struct Action {
    std::size_t function = 0;
    bool inside_source = false;
    friend bool operator<(const Action& a, const Action& b) {
      return std::tie(a.function, a.inside_source) < std::tie(b.function, b.inside_source);
    }
  };

  /// Where a stretch of the facets that a tree was made from comes from.
  struct Origin {
    std::size_t first_facet = 0;
    std::size_t function = 0;
    FacetOrigins entities;  ///< counted from the first facet
  };

  /// All that a built field answers from, for a file (field_file.h).
  struct Part {
    std::vector<Action> actions;
    std::vector<Entity> entities;
    double size_limit = no_size;
    Action limit;                 ///< whose size limit that is, or start size inside a source
    std::vector<Origin> origins;  ///< of the facets of the tree
    std::shared_ptr<const FacetTree> tree;
    std::shared_ptr<const BackgroundGrid> grid;  ///< null if there is none
  };
  struct Parts {
    double tolerance = 0.0;
    Topology topology;
    std::vector<SizeFunction> functions;
    std::vector<bool> effective;
    std::vector<std::size_t> facet_counts;  ///< of the functions
    std::vector<Part> groups;
  };
  /// Throws Error if a group was not built since its last change.
  Parts parts() const;
  /// A field that answers as the one did whose parts they are. Its functions have no sources to
  /// build anything from.
  explicit SizeField(Parts parts);

  /// Tables for people: see field_summary.h.
  std::string summary() const;

 private:
  struct EntityHash {
    std::size_t operator()(const Entity& entity) const {
      return std::hash<long long>()(static_cast<long long>(entity.tag) * 4 + entity.dim);
    }
  };

  struct Group {
    std::vector<Action> actions;
    std::vector<Entity> entities;
    bool changed = true;
    double size_limit = no_size;
    Action limit;                 ///< whose size limit that is, or start size inside a source
    std::vector<Origin> origins;  ///< of the facets of the tree
    std::shared_ptr<const FacetTree> tree;
    double tree_seconds = 0.0;
    std::shared_ptr<AnswerCount> answers = std::make_shared<AnswerCount>();
    std::shared_ptr<const BackgroundGrid> grid;
  };

  /// Runs the body; if it throws, all is as it was.
  template <typename Body>
  void all_or_nothing(Body body);
  void regroup();
  void check_name(const std::string& name, std::size_t but_for) const;
  void mark_changed(std::size_t function);
  void set_facets(std::size_t function, SizedFacets facets, FacetOrigins origins);
  void build_tree(Group& group) const;
  void build_grid(std::size_t index, Group& group) const;
  int threads_for(std::size_t facets) const;
  Box box_of(const Group& group) const;
  std::shared_ptr<const AttachedRegion> region_of(const Group& group) const;
  bool wants_grid(const Group& group, const std::vector<Entity>& entities,
                  double sizes_per_tetrahedron) const;
  template <typename Ask>
  void ask_at_finite(const Entity& entity, const Vec3* points, std::size_t count, double* sizes,
                     Ask ask) const;
  const Group* group(const Entity& entity) const;
  Box reach_of(const Group& group) const;

  std::shared_ptr<const Topology> topology_;
  FieldOptions options_;
  std::vector<SizeFunction> functions_;
  std::size_t numbers_given_ = 0;
  std::vector<std::shared_ptr<const SizedFacets>> facets_;  ///< null for none
  std::vector<std::size_t> facet_counts_;
  std::vector<FacetOrigins> origins_;  ///< of the facets of each function
  std::vector<bool> effective_;
  std::vector<Group> groups_;
  std::unordered_map<Entity, std::size_t, EntityHash> group_of_;
};

}  // namespace meshgrow

#endif
