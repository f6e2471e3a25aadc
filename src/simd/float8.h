// Eight floats at once. Included by the bodies of kernels, inside a namespace of each instruction
// set: the same names mean other instructions there. Needs <cstdint>, and <immintrin.h> on x86.

typedef float Float8 __attribute__((vector_size(32)));
typedef std::int32_t Int8 __attribute__((vector_size(32)));

inline Float8 all(float x) { return Float8{x, x, x, x, x, x, x, x}; }

inline Float8 load(const float* from) { return *reinterpret_cast<const Float8*>(from); }

inline Float8 min(Float8 a, Float8 b) {
#ifdef __AVX__
  return _mm256_min_ps(a, b);
#else
  return a < b ? a : b;
#endif
}

inline Float8 max(Float8 a, Float8 b) {
#ifdef __AVX__
  return _mm256_max_ps(a, b);
#else
  return a > b ? a : b;
#endif
}

inline Float8 absolute(Float8 x) { return max(x, -x); }

inline Float8 sqrt(Float8 x) {
#ifdef __AVX__
  return _mm256_sqrt_ps(x);
#else
  for (int i = 0; i < lanes; ++i) {
    x[i] = __builtin_sqrtf(x[i]);
  }
  return x;
#endif
}

/// One bit a lane where the condition holds.
inline unsigned bits(Int8 condition) {
#ifdef __AVX__
  return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(condition)));
#else
  unsigned result = 0;
  for (int i = 0; i < lanes; ++i) {
    result |= condition[i] ? 1u << i : 0u;
  }
  return result;
#endif
}
