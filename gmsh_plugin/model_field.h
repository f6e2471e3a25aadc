#ifndef MESHGROW_MODEL_FIELD_H
#define MESHGROW_MODEL_FIELD_H

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "meshing_plan.h"
#include "model_reader.h"
#include "size_answers.h"
#include "size_callback.h"
#include "size_field.h"
#include "source_facets.h"

namespace meshgrow {

/// The size field of a Gmsh model: defines size functions, reads their sources out of the model,
/// and gives Gmsh the sizes. Not thread-safe, as Gmsh is not; only `SizeField`'s own queries are.
class ModelField {
 public:
  /// Of the current model. Throws Error without libgmsh, before gmsh.initialize(), with a Gmsh
  /// older than 4.8 and for a model without entities.
  ModelField();
  /// A saved field (field_file.h): can be asked and registered, with any model that has the
  /// entities on which it acts, but not changed. Needs Gmsh only to be registered.
  explicit ModelField(const std::string& file);
  ModelField(const ModelField&) = delete;
  ModelField& operator=(const ModelField&) = delete;

  std::size_t add(SizeFunction function);
  /// Adds a function by its one-line text (size_function_text.h).
  std::size_t add(const std::string& text);

  /// See SizeField. A registered field acts as changed from then on. What throws changes nothing.
  void modify(const std::string& name, const std::string& text);
  void remove(const std::string& name);
  void rename(const std::string& name, const std::string& new_name);

  /// Saves the field with its grids, unless the evaluator is exact.
  void save(const std::string& file);

  /// Adds what suits most models: a curvature size function (18 degrees) and a proximity size
  /// function (3 cells per gap, between faces and edges) whose sources are the attachments
  /// themselves; all entities of the model's highest dimension if there are none. The second is
  /// left out where there is no gap to measure.
  void create_defaults(std::vector<Entity> attachments, double growth_rate, double size_limit,
                       double min_size = 0.0);

  bool is_from_file() const { return !file_.empty(); }
  const std::string& model() const { return model_; }
  SizeField& field() { return field_; }
  const SizeField& field() const { return field_; }

  /// Error instead of a warning when a mesh size function has no effect because a source has no
  /// mesh.
  void set_strict(bool strict) { strict_ = strict; }

  /// Who is told of progress, a line at a time: passes, and each second how far a grid is. Without
  /// a listener, Gmsh's log (level info).
  using ProgressListener = std::function<void(const std::string&)>;
  void set_progress_listener(ProgressListener listener) { listener_ = std::move(listener); }
  void tell(const std::string& line) const;

  /// Who is asked before each line, and often while a grid is built, whether the work shall stop;
  /// it then does, with an Error.
  void set_stop_request(std::function<bool()> wants_stop) { wants_stop_ = std::move(wants_stop); }

  /// A user's own sizes: the smaller one wins, everywhere in the model. None if empty. What they
  /// throw counts as no size.
  void combine(UserSizes sizes) { answers_.combine(std::move(sizes)); }

  /// Makes Gmsh's edges as long as asked for in the middle, by measured factors (calibration.h).
  void set_calibrate(bool calibrate) { calibrate_ = calibrate; }

  /// What Gmsh is told when it asks for a size; see SizeAnswers.
  const SizeAnswers& answers() const { return answers_; }

  /// The same for a caller that may be a user's own size callback: the first call does what
  /// `register_callback` does, but for registering. Gmsh throws away the meshes of surfaces as it
  /// begins, so that of a source that has none by then is taken as it was when its function was
  /// added. What goes wrong becomes a warning in Gmsh's log, and the answer is the proposal.
  /// Thread-safe as SizeAnswers::answer.
  double answer_call(int dim, int tag, double x, double y, double z, double proposed) noexcept;

  /// Reads all sources as they are now and builds trees and grids. Warns of (with `strict`: throws
  /// for) mesh size functions without a meshed source. If it throws, whatever the reason, the field
  /// answers as before.
  void refresh();

  /// Brings the field up to date, one thread at a time, and has it asked. Within the user's own
  /// sizes it is asked as it is, since others are being answered. May be called from any thread, at
  /// once with `answer_call` and `refresh`, between the calls of other functions.
  void ask(const std::function<void(const SizeField&)>& question);

  /// Reads the sources that were not read yet, or that were meshed anew since, and builds what is
  /// not built.
  void refresh_if_needed();
  /// The same, but leaves trees and grids that are out of date as they are if all was read before.
  void read_if_needed();

  /// How many sizes Gmsh asks for, a tetrahedron, with the algorithm that is set.
  static double sizes_per_tetrahedron();

  /// Registers the field as Gmsh's size callback, sources read as they are now. A source that gets
  /// its mesh in a lower dimension of a later run of Gmsh is read when sizes of a higher one are
  /// first asked for; those sizes are exact ones until `refresh` builds grids. Throws Error if
  /// another model's field has the only callback of Gmsh 4.8.
  void register_callback();
  void unregister_callback();
  bool is_registered() const { return callback_ != nullptr; }

  /// The passes of `generate(dim)`, from the meshes as they are now. Throws Error if the functions
  /// wait for each other.
  std::vector<MeshingPass> plan(int dim) const;

  /// Meshes the model up to `dim` with Gmsh, sources first; whatever has a mesh keeps it, with
  /// `remesh` only sources of mesh size functions. See ordered_mesher.h.
  void generate(int dim, bool remesh = false);

  /// Wall time of the last `generate`, in seconds; zeros before the first.
  struct RunTimes {
    double gmsh = 0.0;      ///< in Gmsh's meshers, the sizes that they ask for included
    double meshgrow = 0.0;  ///< the rest: reading, trees and grids, putting meshes back
  };
  const RunTimes& run_times() const { return run_times_; }

 private:
  friend class OrderedMesher;

  void check_changeable(const std::string& what) const;

  /// Runs the body; if it throws, the field answers as before, and knows of its sources what it
  /// knew.
  void all_or_nothing(const std::function<void()>& body);

  /// After a change of the definitions, of this function if it is there: a registered field acts at
  /// once.
  void apply_change(std::optional<std::size_t> function = std::nullopt);

  /// Runs `body` while nobody is answered. Throws Error where this would be waiting for oneself.
  void change(const std::function<void()>& body);
  void refresh_unlocked();

  /// Throws Error if the model lacks an entity on which a saved field acts.
  void check_acted_on() const;

  /// Throws Error if entities came or went since the field was made.
  void check_model() const;
  /// Throws Error if points are elsewhere: the same tags may be those of another geometry.
  void check_places() const;

  /// Gives these functions their sources as they are in the model now.
  void read_sources(const std::vector<std::size_t>& functions);
  std::vector<FacetedSource> read_meshed(std::size_t function, const NodeCoordinates& nodes) const;
  std::vector<FacetedSource> read_fixed(std::size_t function, const NodeCoordinates& nodes) const;
  void read_curvature(std::size_t function, SourceFacets& facets);
  void read_proximity(std::size_t function, SourceFacets& facets);
  void set_sources(std::size_t function, const std::vector<FacetedSource>& sources);

  /// The entities whose meshes the function was, or would be, made from.
  std::set<Entity> watched(std::size_t function) const;
  /// Functions not read yet, or made from meshes that are not as they were read. Within a run of
  /// Gmsh, those whose meshes the run has thrown away are left as they were read.
  std::vector<std::size_t> unread_functions(bool within_run) const;

  /// Remembers what a run of Gmsh may change about the sources of mesh size functions.
  /// `wait_for_meshes`: as for read_all.
  void expect_late_sources(bool wait_for_meshes);

  /// Within a run of Gmsh that has come to this dimension: reads the sources of lower ones that it
  /// has meshed, and forgets those of earlier runs.
  void read_late_sources(int dim);

  /// `refresh`; `wait_for_meshes`: sources without a mesh that a run of Gmsh will mesh in time are
  /// no reason to warn.
  void read_all(bool wait_for_meshes);

  std::vector<Entity> unmeshed_sources(std::size_t function) const;
  void set_reader();
  /// Whether a run of Gmsh will mesh the function's sources in time.
  bool waits_for_meshes(std::size_t function) const;
  void make_ready_for_calls();
  void try_to_make_ready_for_calls();
  void tell_of_other_model();
  /// Keeps the meshes of the sources of this function and those after it.
  void keep_meshed_sources(std::size_t first_function);
  void forget_kept_sources();
  /// Calibrates for the meshers chosen in Gmsh, and warns of those that ask for no sizes.
  void adapt_to_meshers();

  /// Warns once of (with `strict`: throws for) a mesh size function with unmeshed sources.
  void report_unmeshed(std::size_t function);

  void tell_grid(const std::string& what, double done);
  void stop_if_asked() const;
  /// In Gmsh's log; without Gmsh to the listener, or on standard error.
  void warn(const std::string& sentence) const;
  void warn_of_refused_kernels() const;

  std::string model_;
  std::map<Entity, Vec3> points_;  ///< places of the model's points when the field was made
  SizeField field_;
  SizeAnswers answers_;
  bool strict_ = false;
  bool calibrate_ = false;
  double size_factor_ = 1.0;  ///< Mesh.MeshSizeFactor when sources were read
  /// The sources of mesh size functions that a run of Gmsh may mesh, as they were before.
  struct LateSources {
    std::vector<FacetedSource> before;
    bool waits_for_meshes = false;  ///< some had none
    /// Gmsh had thrown away some before the first size was asked for: until all have a mesh again,
    /// the function stays as it was read last.
    bool has_lost = false;
  };
  std::map<std::size_t, LateSources> late_;
  std::map<std::size_t, std::map<Entity, std::uint64_t>> read_as_;  ///< mesh_fingerprint.h
  /// Meshes of sources, as they were when their functions were added, until sources are read.
  std::map<Entity, FacetedSource> kept_;
  bool is_keeping_ = false;
  std::atomic<bool> ready_for_calls_{false};
  std::atomic<bool> told_of_other_model_{false};
  std::string file_;  ///< that it was loaded from; empty for a field of the model
  bool generating_ = false;
  RunTimes run_times_;
  std::set<std::size_t> reported_;
  ProgressListener listener_;
  std::function<bool()> wants_stop_;
  std::string grid_told_of_;
  std::chrono::steady_clock::time_point grid_told_at_;
  std::unique_ptr<SizeCallback> callback_;
};

}  // namespace meshgrow

#endif
