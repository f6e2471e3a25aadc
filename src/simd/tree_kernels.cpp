#include "tree_kernels.h"

#include <cstdlib>
#include <cstring>
#include <initializer_list>

#include "refused_kernels.h"

namespace meshgrow::simd {

namespace plain {
extern const TreeKernels kernels;
}
#ifdef MESHGROW_X86_KERNELS
namespace avx2 {
extern const TreeKernels kernels;
}
namespace avx512 {
extern const TreeKernels kernels;
}
#endif

namespace {

const TreeKernels& fastest() {
  for (const char* name : {"avx512", "avx2"}) {
    if (const TreeKernels* kernels = tree_kernels(name)) {
      return *kernels;
    }
  }
  return plain::kernels;
}

const TreeKernels& chosen() {
  const char* wanted = std::getenv("MESHGROW_SIMD");
  const TreeKernels* kernels = wanted == nullptr ? nullptr : tree_kernels(wanted);
  return kernels == nullptr ? fastest() : *kernels;
}

}  // namespace

std::string refused_kernels() {
  const char* wanted = std::getenv("MESHGROW_SIMD");
  return wanted == nullptr || *wanted == '\0' || tree_kernels(wanted) != nullptr ? "" : wanted;
}

const TreeKernels* tree_kernels(const char* name) {
  if (std::strcmp(name, "plain") == 0) {
    return &plain::kernels;
  }
#ifdef MESHGROW_X86_KERNELS
  const bool has_avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (std::strcmp(name, "avx2") == 0 && has_avx2) {
    return &avx2::kernels;
  }
  if (std::strcmp(name, "avx512") == 0 && has_avx2 && __builtin_cpu_supports("avx512f") &&
      __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512bw")) {
    return &avx512::kernels;
  }
#endif
  return nullptr;
}

const TreeKernels& tree_kernels() {
  static const TreeKernels& kernels = chosen();
  return kernels;
}

}  // namespace meshgrow::simd
