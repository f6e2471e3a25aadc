// Sizes of a million points by the C function beside the same by the core's C++ function, by turns,
// from a grid and from the tree. Arguments: number of facets (default 200,000), of points.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <vector>

#include "field_file.h"
#include "meshgrow.h"
#include "random_facets.h"
#include "sphere_field.h"

using namespace meshgrow;

namespace {

/// Of the processor, so that other programs do not count.
template <typename Work>
double seconds(Work work) {
  const std::clock_t start = std::clock();
  work();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t facets = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 200000;
  const std::size_t count = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1000000;
  const std::string path = (std::filesystem::temp_directory_path() / "c_api_overhead.mgf").string();
  save_field(test::sphere_field(facets), path);
  const SizeField field = load_field(path);
  meshgrow_field* c_field = meshgrow_field_load(path.c_str());

  test::Random random(1);
  std::vector<Vec3> points(count);
  for (Vec3& p : points) {
    p = test::random_in_box(random, Box(Vec3(-2, -2, -2), Vec3(2, 2, 2)));
  }
  std::vector<double> sizes(count);
  std::vector<double> c_sizes(count);
  bool same = c_field != nullptr;
  for (const bool exact : {false, true}) {
    std::vector<double> cpp_times;
    std::vector<double> c_times;
    for (int turn = 0; turn < 8 && same; ++turn) {
      cpp_times.push_back(seconds([&] {
        exact ? field.exact_sizes({3, 1}, points.data(), count, sizes.data())
              : field.sizes({3, 1}, points.data(), count, sizes.data());
      }));
      c_times.push_back(seconds([&] {
        (exact ? meshgrow_field_exact_size : meshgrow_field_size)(
            c_field, 3, 1, points.data()->data(), count, c_sizes.data());
      }));
      same = sizes == c_sizes;
    }
    std::printf("%zu points, %s: C++ %.1f ns a point, C %.3f times as long; %s\n", count,
                exact ? "exact" : "grid", 1e9 * median(cpp_times) / static_cast<double>(count),
                median(c_times) / median(cpp_times), same ? "the same to the bit" : "DIFFERENT");
  }
  meshgrow_field_destroy(c_field);
  std::filesystem::remove(path);
  return same ? 0 : 1;
}
