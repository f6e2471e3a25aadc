#ifndef MESHGROW_ORDERED_MESHER_H
#define MESHGROW_ORDERED_MESHER_H

#include <set>
#include <string>
#include <vector>

#include "gmsh_state.h"
#include "model_field.h"
#include "premeshed_store.h"

namespace meshgrow {

/// Drives Gmsh's 1D, 2D and 3D algorithms over a model so that the sources of mesh size functions
/// are meshed before what grows from them (paper, sections 4.3 and 5.1).
///
/// First all sources with their boundaries, then everything else, each dimension by dimension; a
/// pass of Gmsh holds only entities on which an effective function acts, with Gmsh's own growth
/// from the boundary switched off, or only others, with the user's setting. What had a mesh at the
/// beginning is left out of all passes and is unchanged at the end. Gmsh's options and visibility
/// are restored, also on errors; what was meshed before an error is kept.
class OrderedMesher {
 public:
  /// The field's model must be the current one.
  explicit OrderedMesher(ModelField& model_field);

  /// Up to dimension 1, 2 or 3. Throws Error naming entity and pass if Gmsh fails.
  void generate(int dim);

 private:
  void mesh(const std::set<Entity>& entities, int dim);
  void pass(const std::vector<Entity>& entities, bool attached);
  void read_new_sources();
  bool acts_effectively(const Entity& entity) const;
  void check_options() const;
  void check_faces_stayed(const std::vector<Entity>& entities, const std::string& pass_name) const;
  void check_result(const std::vector<Entity>& entities, const std::string& pass_name) const;
  void report_unmeshed_sources(const std::vector<Entity>& entities);

  ModelField& model_field_;
  SizeField& field_;
  std::vector<Entity> all_;
  GmshState state_;
  PremeshedStore premeshed_;
  std::set<Entity> done_;
  std::set<std::size_t> stale_;  ///< functions with a source meshed since they were read
  int pass_count_ = 0;
  bool curves_follow_ = false;  ///< later passes will throw surface meshes away
};

}  // namespace meshgrow

#endif
