#ifndef MESHGROW_TESTS_PROPERTY_ROUNDS_H
#define MESHGROW_TESTS_PROPERTY_ROUNDS_H

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <string>

#include "random_facets.h"

namespace meshgrow::test {

inline std::uint64_t number_in_environment(const char* name, std::uint64_t otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

/// Calls `check(random)` with one seed after another: the same few in each run of the test, so many
/// as MESHGROW_ROUNDS says from the seed MESHGROW_SEED on if these are set in the environment. A
/// failure tells its seed, which is enough to repeat it alone.
template <typename Check>
void for_random_rounds(std::uint64_t rounds, Check check) {
  constexpr int failures_wanted = 10;
  const std::uint64_t first = number_in_environment("MESHGROW_SEED", 1);
  rounds = number_in_environment("MESHGROW_ROUNDS", rounds);
  int failures = 0;
  for (std::uint64_t seed = first; seed < first + rounds && failures < failures_wanted; ++seed) {
    SCOPED_TRACE("MESHGROW_SEED=" + std::to_string(seed) + " MESHGROW_ROUNDS=1");
    const int before =
        testing::UnitTest::GetInstance()->current_test_info()->result()->total_part_count();
    Random random(seed);
    check(random);
    const int after =
        testing::UnitTest::GetInstance()->current_test_info()->result()->total_part_count();
    failures += after > before ? 1 : 0;
  }
}

}  // namespace meshgrow::test

#endif
