#include "calibration.h"

namespace meshgrow {

double calibration_factor(int dim, int algorithm) {
  return dim == 3 && algorithm == 10 ? 0.73 : dim == 3 ? 0.78 : 1.0;
}

}  // namespace meshgrow
