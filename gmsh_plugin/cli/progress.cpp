#include "progress.h"

#include <unistd.h>

#include <cstdio>
#include <iostream>

#include "c_results.h"

namespace meshgrow::cli {

Progress::Progress() : on_terminal_(isatty(STDOUT_FILENO) != 0) {}

Progress::~Progress() {
  take_bar_away();
  std::cout.flush();
}

void Progress::take_bar_away() {
  if (on_terminal_) {
    std::cout << "\r\033[K";
  }
}

void Progress::tell(const std::string& line) {
  const bool is_grid = line.rfind("Background grid", 0) == 0;
  int pass = 0;
  int passes = 0;
  if (std::sscanf(line.c_str(), "Meshing, pass %d of %d", &pass, &passes) == 2) {
    pass_ = pass;
    passes_ = passes;
  }
  const bool is_share = is_grid && line.back() == '%';
  grid_ = is_share ? line.substr(line.rfind(": ") + 2) : "";
  take_bar_away();
  if (!on_terminal_ || !is_share) {
    std::cout << line << '\n';
  }
  draw_bar();
  std::cout.flush();
}

void Progress::draw_bar() {
  constexpr int width = 30;
  if (!on_terminal_ || passes_ == 0) {
    return;
  }
  // The pass itself is not done yet.
  const int filled = width * (pass_ - 1) / passes_;
  std::cout << '[' << std::string(static_cast<std::size_t>(filled), '#')
            << std::string(static_cast<std::size_t>(width - filled), '.') << "] " << pass_ - 1
            << " of " << passes_ << " passes done";
  if (!grid_.empty()) {
    std::cout << ", background grid " << grid_;
  }
}

void show_progress(meshgrow_field* field, Progress& progress) {
  check(meshgrow_field_set_progress(
      field,
      [](const char* line, void* data) {
        static_cast<Progress*>(data)->tell(line);
        return 0;
      },
      &progress));
}

}  // namespace meshgrow::cli
