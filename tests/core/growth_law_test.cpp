#include "growth_law.h"

#include <gtest/gtest.h>

#include <cmath>

namespace meshgrow {
namespace {

/// `grown_size` by the paper's marching sum: adds one layer at a time until the distance is reached
/// and interpolates linearly in the last layer. Its cost is the number of layers.
double marched_size(double start_size, double growth_rate, double distance) {
  if (growth_rate == 1.0) {
    return start_size;
  }
  // Extended precision: up to a million layers are added.
  long double layer_begin = 0.0L;
  long double size_at_begin = start_size;
  for (;;) {
    const long double size_at_end = size_at_begin * growth_rate;
    const long double layer_end = layer_begin + size_at_end;
    if (distance <= layer_end) {
      const long double fraction = (distance - layer_begin) / (layer_end - layer_begin);
      return static_cast<double>((1.0L - fraction) * size_at_begin + fraction * size_at_end);
    }
    layer_begin = layer_end;
    size_at_begin = size_at_end;
  }
}

TEST(GrowthLaw, ClosedFormEqualsThePapersMarchingSum) {
  for (const double growth_rate : {1.0, 1.0 + 1e-9, 1.0001, 1.05, 1.2, 1.5, 2.0, 3.7, 5.0}) {
    for (double start_size = 1e-6; start_size < 2e6; start_size *= 10.0) {
      for (double ratio = 1e-6; ratio < 2e6; ratio *= 3.1) {
        const double distance = ratio * start_size;
        const double marched = marched_size(start_size, growth_rate, distance);
        EXPECT_NEAR(grown_size(start_size, growth_rate, distance), marched, 1e-12 * marched)
            << "g " << growth_rate << ", S0 " << start_size << ", R " << distance;
      }
    }
  }
}

TEST(GrowthLaw, LayersGrowByTheRate) {
  const double growth_rate = 1.3;
  double distance = 0.0;
  double layer = 0.2;
  for (int n = 0; n < 40; ++n) {
    EXPECT_NEAR(grown_size(0.2, growth_rate, distance), layer, 1e-12 * layer);
    layer *= growth_rate;
    distance += layer;
  }
}

TEST(GrowthLaw, SlopesAreBelowOneWhateverTheRate) {
  for (const double rate : {1.0, 1.2, 1e9, 1e16, 1e17, 1e300}) {
    EXPECT_GE(growth_slope(rate), 0.0) << rate;
    EXPECT_LT(growth_slope(rate), 1.0) << rate;
  }
}

TEST(GrowthLaw, RateOneKeepsTheSize) {
  EXPECT_EQ(growth_slope(1.0), 0.0);
  EXPECT_EQ(grown_size(0.7, 1.0, 1e9), 0.7);
}

}  // namespace
}  // namespace meshgrow
