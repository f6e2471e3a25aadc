#ifndef MESHGROW_SIMD_REFUSED_KERNELS_H
#define MESHGROW_SIMD_REFUSED_KERNELS_H

#include <string>

namespace meshgrow::simd {

/// What the environment variable MESHGROW_SIMD asks for, if it is nothing that this processor runs;
/// else empty.
std::string refused_kernels();

}  // namespace meshgrow::simd

#endif
