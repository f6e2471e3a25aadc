// How long a saved field takes to open, to give its first size, and to answer, beside the field
// that was saved. Argument: number of facets (default 1,000,000).

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "field_file.h"
#include "random_facets.h"
#include "sphere_field.h"

using namespace meshgrow;

namespace {

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double seconds_for(const SizeField& field, const std::vector<Vec3>& points,
                   std::vector<double>& sizes) {
  const double start = now();
  field.sizes({3, 1}, points.data(), points.size(), sizes.data());
  return now() - start;
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t facets = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1000000;
  const SizeField field = test::sphere_field(facets);

  const std::string path =
      (std::filesystem::temp_directory_path() / "field_file_times.mgf").string();
  double start = now();
  save_field(field, path);
  std::printf("saved %.0f MB in %.2f s\n", std::filesystem::file_size(path) / 1e6, now() - start);

  start = now();
  const SizeField loaded = load_field(path);
  const double opened = now();
  const double size = loaded.size({3, 1}, {0.3, 0.2, 1.4});
  std::printf("opened in %.2f ms, first size (%g) after %.2f ms more\n", 1e3 * (opened - start),
              size, 1e3 * (now() - opened));

  test::Random random(1);
  std::vector<Vec3> points(1000000);
  for (Vec3& p : points) {
    p = test::random_in_box(random, Box(Vec3(-2, -2, -2), Vec3(2, 2, 2)));
  }
  std::vector<double> sizes(points.size());
  std::vector<double> loaded_sizes(points.size());
  const double first = seconds_for(loaded, points, loaded_sizes);
  seconds_for(field, points, sizes);
  const double in_memory = seconds_for(field, points, sizes);
  const double mapped = seconds_for(loaded, points, loaded_sizes);
  std::printf("a size: %.0f ns in memory, %.0f ns mapped, %.0f ns while blocks are checked; %s\n",
              1e3 * in_memory, 1e3 * mapped, 1e3 * first,
              sizes == loaded_sizes ? "the same to the bit" : "DIFFERENT");
  std::filesystem::remove(path);
  return sizes == loaded_sizes ? 0 : 1;
}
