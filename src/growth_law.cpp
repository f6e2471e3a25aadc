#include "growth_law.h"

#include <algorithm>
#include <limits>

namespace meshgrow {

double growth_slope(double growth_rate) {
  constexpr double below_1 = 1.0 - 0.5 * std::numeric_limits<double>::epsilon();
  return std::min((growth_rate - 1.0) / growth_rate, below_1);  // of rates above 1e16, too
}

double grown_size(double start_size, double growth_rate, double distance) {
  return start_size + growth_slope(growth_rate) * distance;
}

}  // namespace meshgrow
