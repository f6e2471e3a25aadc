// Memory that runs out while `meshgrow serve` answers: Gmsh waits for every answer.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <vector>

#include "failing_allocations.h"
#include "size_server.h"

namespace meshgrow::cli {
namespace {

TEST(OutOfMemoryInServe, EveryRequestIsAnsweredWithoutAny) {
  std::vector<Vec3> points;
  for (int i = 0; i < 10000; ++i) {
    points.emplace_back(i, 0.5, i % 7 == 0 ? HUGE_VAL : 0.0);
  }
  const std::size_t bytes = points.size() * sizeof(Vec3);
  std::vector<double> answers;
  answers.reserve(points.size());
  std::size_t sent = 0;
  std::unique_ptr<test::FailingAllocations> failing;
  const ServeEnd end = serve_sizes(
      [&](void* buffer, std::size_t room) {
        if (!failing) {
          failing = std::make_unique<test::FailingAllocations>(1, true);
        }
        // First a single request, then as many as there is room for.
        const std::size_t count = std::min({sent == 0 ? sizeof(Vec3) : room, bytes - sent});
        std::memcpy(buffer, reinterpret_cast<const char*>(points.data()) + sent, count);
        sent += count;
        return count;
      },
      [&](const void* data, std::size_t size) {
        const auto* values = static_cast<const double*>(data);
        answers.insert(answers.end(), values, values + size / sizeof(double));
        return true;
      },
      [](const Vec3* at, std::size_t count, double* sizes) {
        std::transform(at, at + count, sizes, [](const Vec3& p) { return 1.0 + p.x(); });
      });
  failing.reset();
  EXPECT_EQ(end, ServeEnd::end_of_input);
  ASSERT_EQ(answers.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(answers[i], i % 7 == 0 ? served_no_size : 1.0 + static_cast<double>(i)) << i;
  }
}

}  // namespace
}  // namespace meshgrow::cli
