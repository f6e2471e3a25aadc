#ifndef MESHGROW_TESTS_AT_ONCE_H
#define MESHGROW_TESTS_AT_ONCE_H

#include <atomic>
#include <thread>
#include <vector>

namespace meshgrow::test {

/// As many as the tests let work at once, however many processors there are.
constexpr int thread_count = 4;

/// Runs body(0) to body(thread_count - 1), each on a thread of its own, none before all are there.
/// Bodies must not throw.
template <typename Body>
void at_once(Body body) {
  std::atomic<int> waiting{thread_count};
  std::vector<std::thread> threads;
  for (int i = 0; i < thread_count; ++i) {
    threads.emplace_back([&waiting, &body, i] {
      --waiting;
      while (waiting > 0) {
        std::this_thread::yield();
      }
      body(i);
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
}

}  // namespace meshgrow::test

#endif
