// Saved fields (.mgf): whatever the bytes are, they are a field that can be asked or an Error.

#include "field_file.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <string>
#include <vector>

#include "error.h"
#include "field_writer.h"
#include "fuzz_target.h"
#include "size_function_text.h"

namespace meshgrow::fuzz {
namespace {

constexpr std::size_t most_groups = 3;

/// A file in memory that has the bytes of the input.
class InputFile {
 public:
  InputFile() : descriptor_(memfd_create("field", 0)) {
    require(descriptor_ >= 0, "there are files in memory");
  }

  std::string path_of(const std::uint8_t* data, std::size_t size) const {
    require(ftruncate(descriptor_, 0) == 0 &&
                pwrite(descriptor_, data, size, 0) == static_cast<ssize_t>(size),
            "the input can be written");
    return "/proc/self/fd/" + std::to_string(descriptor_);
  }

 private:
  int descriptor_;
};

/// Some in the cube of the grid, some of the tree's facets, some anywhere.
std::vector<Vec3> points_in(const SizeField::Part& group) {
  std::vector<Vec3> points = {Vec3::Zero(), Vec3(1e30, 0, -1e300), Vec3(0.3, 0.7, -0.1)};
  const StoredTree& tree = group.tree->stored();
  points.push_back(tree.centre);
  points.emplace_back(tree.centre + Vec3(0.1, -0.2, 0.3) * tree.unit);
  for (std::size_t i = 0; i < tree.facets.size(); i += 1 + tree.facets.size() / 2) {
    points.push_back(tree.facets.data()[i].facet.corners[1]);
  }
  if (group.grid) {
    const GridCube& cube = group.grid->grid_cube();
    for (const double step : {0.0, 0.03, 0.26, 0.51, 0.999}) {
      points.emplace_back(cube.origin + cube.edge * Vec3(step, 1.0 - step, 0.5 * step));
    }
  }
  return points;
}

template <typename Ask>
void ask(Ask question) {
  try {
    question();
  } catch (const Error& error) {
    require(error.what()[0] != '\0', "an error has a sentence");
  }
}

void ask_group(const SizeField& field, const SizeField::Part& group) {
  const std::vector<Vec3> points = points_in(group);
  std::vector<double> sizes(points.size());
  const Entity& entity = group.entities.back();
  ask([&] { field.sizes(entity, points.data(), points.size(), sizes.data()); });
  ask([&] { field.exact_sizes(entity, points.data(), points.size(), sizes.data()); });
  for (std::size_t i = 0; i < points.size(); i += 3) {
    ask([&] { field.probe(entity, points[i]); });
  }
  ask([&] { field.smallest_sizes(points.data(), points.size(), sizes.data()); });
  ask([&] { field.probe(points.back()); });
  if (group.grid) {
    ask([&] { group.grid->for_each_leaf([](const GridLeaf&) {}); });
  }
}

void check(const std::uint8_t* data, std::size_t size) {
  static const InputFile file;
  const std::string path = file.path_of(data, size);
  ask([&] {
    const SizeField field = load_field(path);
    field.summary();
    for (const SizeFunction& function : field.functions()) {
      size_function_text(function);
    }
    const SizeField::Parts parts = field.parts();
    const std::size_t groups = std::min(parts.groups.size(), most_groups);
    for (std::size_t i = 0; i < groups; ++i) {
      ask_group(field, parts.groups[i]);
    }
    write_field(parts, "/dev/null");
  });
}

}  // namespace
}  // namespace meshgrow::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  meshgrow::fuzz::check(data, size);
  return 0;
}
