#ifndef MESHGROW_MODEL_FIELD_H
#define MESHGROW_MODEL_FIELD_H

#include <chrono>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "size_callback.h"
#include "size_field.h"

namespace meshgrow {

/// The size field of a Gmsh model: defines size functions, reads their sources out of the model,
/// and gives Gmsh the sizes. Not thread-safe, as Gmsh is not; only `SizeField`'s own queries are.
class ModelField {
 public:
  /// Of the current model. Throws Error without libgmsh, before gmsh.initialize(), with a Gmsh
  /// older than 4.8 and for a model without entities.
  ModelField();
  ModelField(const ModelField&) = delete;
  ModelField& operator=(const ModelField&) = delete;

  std::size_t add(SizeFunction function);
  /// Adds a function by its one-line text (size_function_text.h).
  std::size_t add(const std::string& text);

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

  /// Reads all sources as they are now and builds trees and grids. Warns of (with `strict`: throws
  /// for) mesh size functions without a meshed source.
  void refresh();

  /// `refresh` unless sources were read since the last function was added; builds what is not
  /// built.
  void refresh_if_needed();

  /// Registers the field as Gmsh's size callback, sources read as they are now.
  void register_callback();
  void unregister_callback() { callback_.reset(); }
  bool is_registered() const { return callback_ != nullptr; }

  /// Meshes the model up to `dim` with Gmsh, sources first; whatever has a mesh keeps it. See
  /// ordered_mesher.h.
  void generate(int dim);

 private:
  friend class OrderedMesher;

  /// Throws Error if entities came or went since the field was made.
  void check_model() const;

  /// Gives these functions their sources as they are in the model now.
  void read_sources(const std::vector<std::size_t>& functions);

  /// Warns once of (with `strict`: throws for) a mesh size function with unmeshed sources.
  void report_unmeshed(std::size_t function);

  void tell_grid(const std::string& what, double done);

  std::string model_;
  SizeField field_;
  bool strict_ = false;
  bool sources_read_ = false;
  bool generating_ = false;
  std::set<std::size_t> reported_;
  ProgressListener listener_;
  std::string grid_told_of_;
  std::chrono::steady_clock::time_point grid_told_at_;
  std::unique_ptr<SizeCallback> callback_;
};

}  // namespace meshgrow

#endif
