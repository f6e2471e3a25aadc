#ifndef MESHGROW_CLI_PROGRESS_H
#define MESHGROW_CLI_PROGRESS_H

#include <string>

#include "meshgrow.h"

namespace meshgrow::cli {

/// Shows lines of progress on standard output: on a terminal with a bar below them that stays in
/// the last line, else the lines alone.
class Progress {
 public:
  Progress();
  /// Takes the bar away.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Also reads from the library's lines how far passes ("Meshing, pass 2 of 7 …") and grids
  /// ("Background grid …: 40 %") are.
  void tell(const std::string& line);

 private:
  void take_bar_away();
  void draw_bar();

  bool on_terminal_;
  int pass_ = 0;
  int passes_ = 0;
  std::string grid_;  ///< how far the grid is that is being built, or nothing
};

/// The field's lines of progress go there, until it has another listener.
void show_progress(meshgrow_field* field, Progress& progress);

}  // namespace meshgrow::cli

#endif
