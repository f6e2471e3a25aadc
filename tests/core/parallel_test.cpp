#include "parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

#include "error.h"

namespace meshgrow {
namespace {

TEST(ParallelFor, RunsEveryBodyOnce) {
  for (const int threads : {0, 1, 2, 5}) {
    for (const std::size_t count : {0, 1, 3, 1000}) {
      std::vector<std::atomic<int>> runs(count);
      parallel_for(count, threads, [&](std::size_t i) { ++runs[i]; });
      for (const std::atomic<int>& run : runs) {
        ASSERT_EQ(run, 1) << threads << " threads, " << count << " bodies";
      }
    }
  }
}

TEST(ParallelFor, UsesAsManyThreadsAsAsked) {
  for (const int threads : {1, 2, 5}) {
    std::atomic<int> in_team = 0;
    parallel_for(10, threads, [&](std::size_t) { in_team = omp_get_num_threads(); });
    EXPECT_EQ(in_team, threads);
  }
}

TEST(ParallelFor, ThrowsTheExceptionOfABodyAgain) {
  for (const int threads : {1, 3}) {
    std::atomic<int> runs = 0;
    try {
      parallel_for(1000, threads, [&](std::size_t i) {
        ++runs;
        if (i % 10 == 3) {
          throw Error("Body failed.");
        }
      });
      FAIL() << "no exception with " << threads << " threads";
    } catch (const Error& error) {
      EXPECT_STREQ(error.what(), "Body failed.");
    }
    EXPECT_LT(runs, 1000) << "the rest is still run after a failure";
  }
}

TEST(ParallelFor, TellsTheCallingThreadWhatIsDone) {
  for (const int threads : {1, 2, 4}) {
    const std::thread::id caller = std::this_thread::get_id();
    std::vector<std::size_t> told;
    parallel_for(
        500, threads, [](std::size_t) { std::this_thread::yield(); },
        [&](std::size_t done) {
          EXPECT_EQ(std::this_thread::get_id(), caller);
          told.push_back(done);
        });
    EXPECT_TRUE(std::is_sorted(told.begin(), told.end())) << threads << " threads";
    for (const std::size_t done : told) {
      EXPECT_LE(done, 500u);
      EXPECT_GE(done, 1u);
    }
    if (threads == 1) {
      EXPECT_EQ(told.size(), 500u);
    }
  }
}

TEST(ParallelFor, ExceptionOfTheListenerIsThrownAgain) {
  const auto listener = [](std::size_t) { throw Error("stop"); };
  EXPECT_THROW(parallel_for(
                   10, 1, [](std::size_t) {}, listener),
               Error);
}

}  // namespace
}  // namespace meshgrow
