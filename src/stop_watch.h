#ifndef MESHGROW_STOP_WATCH_H
#define MESHGROW_STOP_WATCH_H

#include <chrono>

namespace meshgrow {

/// Wall time since it was made.
class StopWatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace meshgrow

#endif
