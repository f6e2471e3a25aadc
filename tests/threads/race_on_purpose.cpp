// A race of two threads of OpenMP, for tests/sanitizers.sh to see that ThreadSanitizer tells it,
// and that it tells nothing (with an argument) where they take turns.

#include <cstdio>

int main(int argc, char**) {
  int sum = 0;
  if (argc > 1) {
#pragma omp parallel for num_threads(4)
    for (int i = 0; i < 1000; ++i) {
#pragma omp critical
      sum += i;
    }
  } else {
#pragma omp parallel for num_threads(4)
    for (int i = 0; i < 1000; ++i) {
      sum += i;
    }
  }
  std::printf("%d\n", sum);
}
