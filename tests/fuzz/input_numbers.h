#ifndef MESHGROW_TESTS_FUZZ_INPUT_NUMBERS_H
#define MESHGROW_TESTS_FUZZ_INPUT_NUMBERS_H

#include <array>
#include <cfloat>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include "geometry.h"

namespace meshgrow::fuzz {

/// Takes numbers off the bytes of an input; zeros when they have come to their end.
class InputNumbers {
 public:
  InputNumbers(const std::uint8_t* data, std::size_t size) : next_(data), left_(size) {}

  bool at_end() const { return left_ == 0; }

  std::uint8_t byte() {
    if (left_ == 0) {
      return 0;
    }
    --left_;
    return *next_++;
  }

  /// Any double at all, where a byte of 192 or more stands before it. Other bytes stand for numbers
  /// that are likely to matter: those at the ends of what there is, and the steps of a lattice, on
  /// which facets meet and coincide.
  double number() {
    static constexpr std::array<double, 32> extremes = {0.0,
                                                        -0.0,
                                                        1.0,
                                                        -1.0,
                                                        std::numeric_limits<double>::quiet_NaN(),
                                                        std::numeric_limits<double>::infinity(),
                                                        -std::numeric_limits<double>::infinity(),
                                                        DBL_MAX,
                                                        -DBL_MAX,
                                                        DBL_MIN,
                                                        std::numeric_limits<double>::denorm_min(),
                                                        -DBL_TRUE_MIN,
                                                        1e300,
                                                        -1e300,
                                                        1e-300,
                                                        1e155,
                                                        -1e155,
                                                        1e-155,
                                                        1e100,
                                                        1e-100,
                                                        FLT_MAX,
                                                        FLT_MIN,
                                                        1e30,
                                                        -1e30,
                                                        1e-30,
                                                        1e22,
                                                        1e15,
                                                        -1e15,
                                                        1e8,
                                                        1e-9,
                                                        1.0 + DBL_EPSILON,
                                                        1.0 - DBL_EPSILON};
    const std::uint8_t code = byte();
    if (code < extremes.size()) {
      return extremes[code];
    }
    if (code < 192) {
      return (code - 112) / 16.0;
    }
    if (left_ < sizeof(double)) {
      left_ = 0;
      return 0.0;
    }
    double result;
    std::memcpy(&result, next_, sizeof(result));
    next_ += sizeof(result);
    left_ -= sizeof(result);
    return result;
  }

  Vec3 point() {
    const double x = number();
    const double y = number();
    return {x, y, number()};
  }

 private:
  const std::uint8_t* next_;
  std::size_t left_;
};

}  // namespace meshgrow::fuzz

#endif
