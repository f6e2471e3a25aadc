#ifndef MESHGROW_TESTS_FAILING_STEPS_H
#define MESHGROW_TESTS_FAILING_STEPS_H

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <new>
#include <random>
#include <set>
#include <string>

#include "error.h"
#include "failing_allocations.h"

namespace meshgrow::test {

/// Which of so many allocations fail: all, or the first ones and a random choice of the others.
inline std::set<std::size_t> steps_to_fail(std::size_t count, std::size_t most, unsigned seed) {
  std::set<std::size_t> steps;
  for (std::size_t n = 1; n <= std::min(count, most / 2); ++n) {
    steps.insert(n);
  }
  std::mt19937 random(seed);
  while (steps.size() < std::min(count, most)) {
    steps.insert(std::uniform_int_distribution<std::size_t>(1, count)(random));
  }
  return steps;
}

/// Makes a state, lets `act` on it run out of memory at each of its allocations (at most at so many
/// of them), alone or with all that follow, and asks `check` about the state after that. What the
/// act throws must be std::bad_alloc, or an Error with a sentence. Unless others than the test
/// allocate, nothing may be left over.
template <typename Make, typename Act, typename Check>
void fail_at_each_step(std::size_t most, Make make, Act act, Check check, bool others = false) {
  constexpr unsigned seed = 20261125;
  std::size_t count = 0;
  {
    auto state = make();
    const FailingAllocations none(0);
    act(state);
    count = FailingAllocations::seen();
  }
  ASSERT_GT(count, 0u);
  std::size_t failed = 0;
  for (const std::size_t step : steps_to_fail(count, most, seed)) {
    SCOPED_TRACE("allocation " + std::to_string(step) + " of " + std::to_string(count) + ", seed " +
                 std::to_string(seed));
    const bool and_all_later = step % 2 == 0;
    const std::size_t before = living_allocations();
    {
      auto state = make();
      bool has_failed = false;
      try {
        const FailingAllocations failing(step, and_all_later);
        act(state);
      } catch (const std::bad_alloc&) {
        has_failed = true;
      } catch (const Error& error) {
        has_failed = true;
        const FailingAllocations none(0);
        EXPECT_NE(std::string(error.what()), "");
      }
      failed += has_failed ? 1 : 0;
      if (has_failed) {
        check(state);
      }
    }
    EXPECT_TRUE(others || living_allocations() == before);
    if (testing::Test::HasFailure()) {
      return;
    }
  }
  EXPECT_GT(failed, 0u);
}

}  // namespace meshgrow::test

#endif
