#ifndef MESHGROW_ORDERED_MESHER_H
#define MESHGROW_ORDERED_MESHER_H

#include <set>
#include <string>
#include <vector>

#include "curve_adjuster.h"
#include "gmsh_state.h"
#include "model_field.h"
#include "premeshed_store.h"

namespace meshgrow {

/// Drives Gmsh's 1D, 2D and 3D algorithms over a model so that the sources of mesh size functions
/// are meshed before what grows from them (paper, sections 4.3 and 5.1), pass by pass as planned
/// (meshing_plan.h).
///
/// A pass of Gmsh holds only entities on which an effective function acts, with Gmsh's own growth
/// from the boundary switched off, or only others, with the user's setting. Opposite sides of
/// mapped surfaces are brought to the same number of intervals. What had a mesh at the beginning is
/// left out of all passes and is unchanged at the end. Gmsh's options and visibility are restored,
/// also on errors; what was meshed before an error is kept, but for curves of mapped surfaces that
/// were not adjusted yet.
class OrderedMesher {
 public:
  /// The field's model must be the current one.
  explicit OrderedMesher(ModelField& model_field);

  /// Up to dimension 1, 2 or 3. Throws Error naming entity and pass if Gmsh fails.
  void generate(int dim);

  /// The passes that `generate` would make if these entities had a mesh. Of the current model.
  static std::vector<MeshingPass> plan(const SizeField& field, std::set<Entity> meshed, int dim);

  /// Throws Error if an option of Gmsh is set with which premeshed entities could not stay.
  static void check_options();

 private:
  /// Entities without a mesh after a pass in which Gmsh told of no error.
  struct LeftEmpty {
    std::vector<Entity> entities;
    std::string pass_name;
  };
  /// Curves meshed in this run that Gmsh has split under surfaces, while others stand on them.
  struct SplitCurves {
    std::vector<Entity> curves;
  };
  std::vector<MeshingPass> plan(int dim) const;
  void run(const std::vector<MeshingPass>& plan);
  void start_with_companions(const LeftEmpty& left);
  void start_with_split_curves(const SplitCurves& split);
  void clear_meshed();
  void run_pass(const MeshingPass& pass, bool curves_follow);
  std::vector<Entity> without_copies(const std::vector<Entity>& entities);
  std::vector<Entity> take_meshed(const std::vector<Entity>& entities,
                                  const std::string& pass_name);
  void mesh(const std::vector<Entity>& entities, bool attached, const std::string& name);
  void protect_discrete_faces(const std::vector<Entity>& volumes) const;
  void remove_protection(const Entity& volume) const;
  void adjust_curves(const std::vector<Entity>& stage);
  /// After an error: curves of mapped surfaces that the run came not to adjust would be taken for
  /// meshed beforehand by the next run, and not be adjusted any more.
  void clear_unadjusted_curves() const;
  void keep_from_curve_passes(const std::vector<Entity>& surfaces);
  void keep_split_curves(const std::vector<Entity>& surfaces);
  void check_split_curves(const std::vector<Entity>& surfaces, const std::vector<Entity>& kept);
  void mesh_lost_faces();
  void read_new_sources();
  void mark_stale(const std::vector<Entity>& meshed);
  bool acts_effectively(const Entity& entity) const;
  void check_premeshed(const std::vector<MeshingPass>& passes) const;
  void check_faces_stayed(const std::vector<Entity>& entities, const std::string& pass_name) const;
  [[noreturn]] void refuse_empty(const LeftEmpty& left) const;
  void report_unmeshed_sources(const std::vector<Entity>& entities);

  ModelField& model_field_;
  SizeField& field_;
  std::vector<Entity> all_;
  GmshState state_;
  PremeshedStore premeshed_;
  MeshConstraints constraints_;
  std::set<Entity> structured_faces_;  ///< mapped faces of mapped volumes
  CurveAdjuster adjuster_;
  std::set<Entity> user_premeshed_;   ///< what had a mesh at the beginning
  std::map<Entity, Entity> masters_;  ///< of periodic entities
  std::set<Entity> companions_;       ///< found to be meshed by Gmsh only along with others
  std::set<Entity> split_curves_;     ///< by Gmsh; the run was started again with them so
  std::set<Entity> waiting_;          ///< companions that were due and have no mesh yet
  std::vector<Entity> lost_faces_;    ///< structured ones that curve passes took the mesh from
  std::vector<Entity> unadjusted_;    ///< curves of the present stage
  std::set<std::size_t> stale_;       ///< functions with a source meshed since they were read
  int split_count_ = 0;
  int pass_count_ = 0;
  std::size_t planned_count_ = 0;
};

}  // namespace meshgrow

#endif
