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

}  // namespace meshgrow
